# vigia_module(NAME SOURCES… [PUBLIC …] [PRIVATE …] [PIXEL_LOOPS]) makes the static library vigia::NAME.
# PIXEL_LOOPS: square roots set no errno and choices between values do not trap, so that a loop over
# pixels does eight at a time.
# vigia_test(MODULE SOURCES… [LINK …] [LABELS …] [STATISTICS FILTER] [COST N]) makes the GoogleTest
# program test_MODULE; the label slow keeps its tests out of an ordinary run. CTest runs each test as a
# process of its own, those of the greatest COST first. With VIGIA_TEST_SHARDS it runs the program in
# that many shards instead, whose tests share a process. The tests that FILTER (GoogleTest's patterns)
# names repeat for the sake of their figures what others do once; sharded, they are an entry of their own
# with the label statistics.

add_library(vigia_options INTERFACE)
target_compile_features(vigia_options INTERFACE cxx_std_17)
# No contraction of a*b+c: the same bytes whatever the vector width the compiler chooses.
target_compile_options(vigia_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off
  $<$<BOOL:${VIGIA_WERROR}>:-Werror>)

# The files of a target are compiled several at a time: the same headers and, what costs more, the same
# instances of Eigen's templates are then made once for all of them. Names in their anonymous namespaces
# must differ. `./dev lint --full` reads each file alone, so that one which lacks an include of its own
# is found.
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
  cmake_parse_arguments(ARG "" "STATISTICS;COST" "SOURCES;LINK;LABELS" ${ARGN})
  add_executable(test_${module} ${ARG_SOURCES})
  target_link_libraries(test_${module} PRIVATE vigia_options ${ARG_LINK} GTest::gmock GTest::gtest_main)
  add_dependencies(test_${module} vigia_media)
  target_include_directories(test_${module} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(test_${module} PRIVATE
    VIGIA_SOURCE_DIR="${PROJECT_SOURCE_DIR}" VIGIA_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  set(properties)
  if(ARG_COST)
    list(APPEND properties COST ${ARG_COST})
  endif()
  if(VIGIA_TEST_SHARDS)
    vigia_test_shards(${module} "${ARG_STATISTICS}" "${ARG_LABELS}" TIMEOUT 3600 ${properties})
    return()
  endif()
  if(ARG_LABELS)
    list(APPEND properties LABELS ${ARG_LABELS})
  endif()
  gtest_discover_tests(test_${module} TEST_PREFIX ${module}. DISCOVERY_TIMEOUT 120
                       PROPERTIES TIMEOUT 900 ${properties})
endfunction()

# Its remaining arguments are properties of each entry.
function(vigia_test_shards module statistics labels)
  math(EXPR last "${VIGIA_TEST_SHARDS} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME ${module}.shard${shard}
             COMMAND test_${module} --gtest_brief=1 "--gtest_filter=-${statistics}")
    set_tests_properties(${module}.shard${shard} PROPERTIES ${ARGN} LABELS "${labels}"
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${VIGIA_TEST_SHARDS};GTEST_SHARD_INDEX=${shard}")
  endforeach()
  if(statistics)
    add_test(NAME ${module}.statistics
             COMMAND test_${module} --gtest_brief=1 "--gtest_filter=${statistics}")
    set_tests_properties(${module}.statistics PROPERTIES ${ARGN} LABELS statistics)
  endif()
endfunction()
