# Debian packages by cpack: vigia, the program with the missions that it comes with, and
# libvigia-dev, modules and headers to build on. Shared libraries are found by dpkg-shlibdeps.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vigia)
set(CPACK_PACKAGE_VENDOR "the vigia developers")
set(CPACK_PACKAGE_CONTACT "the vigia developers <vigia@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "visual servoing and active perception for mobile robots")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)

set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME vigia)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS fonts-dejavu-core)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION
  "Simulated robots that keep themselves localized by looking at landmarks
 vigia renders what a robot's cameras see, tracks landmarks in the pixels, plans
 where to look, and localizes the robot beside the theoretical limit. The example
 missions lie in /usr/share/vigia/config.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libvigia-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libvisp-dev, libopencv-dev, libeigen3-dev, libyaml-cpp-dev, libompl-dev, libfuzzylite-dev, libapriltag-dev, libcairo2-dev, libspdlog-dev, libfmt-dev, libsqlite3-dev, nlohmann-json3-dev, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
  "Modules and headers of vigia
 Trackers, servos, planners, localizers and the simulator's loop as static
 libraries, with a package that find_package(vigia) reads.")

include(CPack)
