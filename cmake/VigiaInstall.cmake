# Installs the modules, the headers, the program and a package that find_package(vigia) reads.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(_vigia_modules GLOBAL PROPERTY VIGIA_MODULES)
install(TARGETS ${_vigia_modules} EXPORT vigiaTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(TARGETS vigia RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(TARGETS vigia_media LIBRARY DESTINATION ${VIGIA_MODULE_DIR} COMPONENT runtime)
install(DIRECTORY include/vigia DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(DIRECTORY config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/vigia/config COMPONENT runtime)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/vigia RENAME copyright
        COMPONENT runtime)

# The program writes its manual page and its completion itself.
set(_vigia_words ${PROJECT_BINARY_DIR}/words)
install(CODE "
  file(MAKE_DIRECTORY \"${_vigia_words}\")
  execute_process(COMMAND \"$<TARGET_FILE:vigia>\" help man
                  OUTPUT_FILE \"${_vigia_words}/vigia.1\" COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND \"$<TARGET_FILE:vigia>\" help completion
                  OUTPUT_FILE \"${_vigia_words}/vigia\" COMMAND_ERROR_IS_FATAL ANY)"
        COMPONENT runtime)
install(FILES ${_vigia_words}/vigia.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
install(FILES ${_vigia_words}/vigia DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        COMPONENT runtime)

set(_vigia_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/vigia)
install(EXPORT vigiaTargets NAMESPACE vigia:: DESTINATION ${_vigia_package_dir}
        COMPONENT development)
configure_package_config_file(cmake/vigiaConfig.cmake.in
  ${PROJECT_BINARY_DIR}/vigiaConfig.cmake INSTALL_DESTINATION ${_vigia_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vigiaConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vigiaConfig.cmake ${PROJECT_BINARY_DIR}/vigiaConfigVersion.cmake
              cmake/VigiaDependencies.cmake
        DESTINATION ${_vigia_package_dir} COMPONENT development)
