# vigia_module(NAME SOURCES… [PUBLIC …] [PRIVATE …] [PIXEL_LOOPS]) makes the static library vigia::NAME.
# PIXEL_LOOPS: square roots set no errno and choices between values do not trap, so that a loop over
# pixels does eight at a time.
# vigia_test(MODULE SOURCES… [LINK …] [LABELS …]) makes the GoogleTest program test_MODULE; the label
# slow keeps its tests out of an ordinary run.

add_library(vigia_options INTERFACE)
target_compile_features(vigia_options INTERFACE cxx_std_17)
# No contraction of a*b+c: the same bytes whatever the vector width the compiler chooses.
target_compile_options(vigia_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off
  $<$<BOOL:${VIGIA_WERROR}>:-Werror>)

# The files of a target are compiled several at a time: the same headers and, what costs more, the same
# instances of Eigen's templates are then made once for all of them. Names in their anonymous namespaces
# must differ. `./dev lint` compiles each file alone, so that one which lacks an include of its own is
# found.
if(VIGIA_BATCH)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)
endif()

function(vigia_module name)
  cmake_parse_arguments(ARG "PIXEL_LOOPS" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(vigia_${name} STATIC ${ARG_SOURCES})
  add_library(vigia::${name} ALIAS vigia_${name})
  set_target_properties(vigia_${name} PROPERTIES EXPORT_NAME ${name} CXX_EXTENSIONS OFF
                                                 POSITION_INDEPENDENT_CODE ON)
  target_compile_features(vigia_${name} PUBLIC cxx_std_17)
  target_include_directories(vigia_${name}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(vigia_${name}
    PUBLIC ${ARG_PUBLIC}
    PRIVATE $<BUILD_INTERFACE:vigia_options> ${ARG_PRIVATE})
  if(ARG_PIXEL_LOOPS)
    target_compile_options(vigia_${name} PRIVATE -fno-math-errno -fno-trapping-math)
  endif()
  set_property(GLOBAL APPEND PROPERTY VIGIA_MODULES vigia_${name})
endfunction()

function(vigia_test module)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;LABELS" ${ARGN})
  set(properties TIMEOUT 900)
  if(ARG_LABELS)
    list(APPEND properties LABELS ${ARG_LABELS})
  endif()
  add_executable(test_${module} ${ARG_SOURCES})
  target_link_libraries(test_${module} PRIVATE vigia_options ${ARG_LINK} GTest::gmock GTest::gtest_main)
  target_include_directories(test_${module} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(test_${module} PRIVATE
    VIGIA_SOURCE_DIR="${PROJECT_SOURCE_DIR}" VIGIA_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  gtest_discover_tests(test_${module} TEST_PREFIX ${module}. DISCOVERY_TIMEOUT 120
                       PROPERTIES ${properties})
endfunction()
