# Finds what vigia stands on and wraps the libraries that bring no imported target. Used by the
# build and by the installed package alike.

# Inside the installed package a missing library is find_package(vigia)'s to report; in the build it
# is an error.
if(DEFINED CMAKE_FIND_PACKAGE_NAME)
  include(CMakeFindDependencyMacro)
  macro(vigia_find)
    find_dependency(${ARGN})
  endmacro()
else()
  macro(vigia_find)
    find_package(${ARGN} REQUIRED)
  endmacro()
endif()

vigia_find(Eigen3 3.4 NO_MODULE)
vigia_find(yaml-cpp 0.7)
vigia_find(OpenCV 4.6 COMPONENTS core imgproc imgcodecs videoio calib3d)
vigia_find(Threads)

# ViSP's package resets the C++ standard and appends flags for the whole project: undo both.
set(_vigia_cxx_flags "${CMAKE_CXX_FLAGS}")
if(DEFINED CMAKE_CXX_STANDARD)
  set(_vigia_cxx_standard "${CMAKE_CXX_STANDARD}")
endif()
vigia_find(VISP 3.5)
set(CMAKE_CXX_FLAGS "${_vigia_cxx_flags}")
unset(CMAKE_CXX_STANDARD)
if(DEFINED _vigia_cxx_standard)
  set(CMAKE_CXX_STANDARD "${_vigia_cxx_standard}")
endif()

if(NOT TARGET vigia::visp)
  add_library(vigia::visp INTERFACE IMPORTED)
  target_include_directories(vigia::visp SYSTEM INTERFACE ${VISP_INCLUDE_DIRS})
  target_link_libraries(vigia::visp INTERFACE visp_core visp_blob visp_me visp_vs visp_visual_features)
endif()

if(NOT TARGET vigia::opencv)
  add_library(vigia::opencv INTERFACE IMPORTED)
  target_include_directories(vigia::opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
  target_link_libraries(vigia::opencv INTERFACE opencv_core opencv_imgproc opencv_calib3d)
endif()

vigia_find(ompl 1.5)
if(NOT TARGET vigia::ompl)
  add_library(vigia::ompl INTERFACE IMPORTED)
  target_include_directories(vigia::ompl SYSTEM INTERFACE ${OMPL_INCLUDE_DIRS})
  target_link_libraries(vigia::ompl INTERFACE ${OMPL_LIBRARIES})
endif()

# fuzzylite brings no package of its own.
find_path(FUZZYLITE_INCLUDE_DIR fl/Headers.h)
find_library(FUZZYLITE_LIBRARY fuzzylite)
if(NOT FUZZYLITE_INCLUDE_DIR OR NOT FUZZYLITE_LIBRARY)
  message(FATAL_ERROR "vigia needs fuzzylite 6 (Debian: libfuzzylite-dev)")
endif()
if(NOT TARGET vigia::fuzzylite)
  add_library(vigia::fuzzylite INTERFACE IMPORTED)
  target_include_directories(vigia::fuzzylite SYSTEM INTERFACE ${FUZZYLITE_INCLUDE_DIR})
  target_link_libraries(vigia::fuzzylite INTERFACE ${FUZZYLITE_LIBRARY})
endif()

vigia_find(PkgConfig)
if(NOT TARGET PkgConfig::vigia_cairo)
  pkg_check_modules(vigia_cairo REQUIRED IMPORTED_TARGET GLOBAL cairo)
endif()

vigia_find(apriltag)
vigia_find(nlohmann_json 3.11)
vigia_find(fmt)
vigia_find(spdlog 1.10)
vigia_find(SQLite3 3.40)
