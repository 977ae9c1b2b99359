# Everything comes from the system; nothing is downloaded. SnareInstall.cmake repeats this list for users
# of the installed package (cmake/snareConfig.cmake.in).

# What scripts/setup.sh has unpacked there in place of a package that is not installed.
list(APPEND CMAKE_PREFIX_PATH "${PROJECT_SOURCE_DIR}/build/debian/usr")

# snare_required_unless_auto(<variable> <options>...): how find_package looks for what parts of the build need: REQUIRED where one of
# their options is ON, QUIET otherwise.
function(snare_required_unless_auto variable)
  set(${variable} QUIET PARENT_SCOPE)
  foreach(option IN LISTS ARGN)
    if(${option} AND NOT ${option} STREQUAL "AUTO")
      set(${variable} REQUIRED PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(KLU REQUIRED)
find_package(SUNDIALS 6.4 REQUIRED COMPONENTS idas nvecserial sunmatrixsparse)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Ceres 2.1 REQUIRED)
find_package(NLopt 2.7 REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(urdfdom REQUIRED)
# Headers of one source file (results/hdf5_file.cpp); the library itself is opened by name, so users of the installed package need no more.
set(HDF5_PREFER_PARALLEL OFF)
find_package(HDF5 1.10.7 REQUIRED COMPONENTS C)
# Headers of one source file (coupling/contact/mesh_shape.cpp); users of the installed package need GMP and MPFR only.
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL 5.5 REQUIRED)
