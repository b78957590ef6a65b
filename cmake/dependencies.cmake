include(cmake/on_demand.cmake)
# Everything Driftwright takes from Debian 12, with the lowest version known to work. Packages: packages.txt; what tests alone need: packages-tests.txt.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(date 3.0 REQUIRED)
find_package(Protobuf 3.21 REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(SUNDIALS 6.4 REQUIRED COMPONENTS arkode nvecserial)
find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel IOLegacy IOXML IOImage)
# HDF5 also comes as a parallel library; this is the plain one.
pkg_check_modules(hdf5 REQUIRED IMPORTED_TARGET hdf5-serial>=1.10)
pkg_check_modules(mosquitto REQUIRED IMPORTED_TARGET libmosquitto>=2.0)
pkg_check_modules(curl REQUIRED IMPORTED_TARGET libcurl>=7.85)
pkg_check_modules(xml2 REQUIRED IMPORTED_TARGET libxml-2.0)
pkg_check_modules(minizip REQUIRED IMPORTED_TARGET minizip)
pkg_check_modules(muparser REQUIRED IMPORTED_TARGET muparser>=2.3)
pkg_check_modules(udunits REQUIRED IMPORTED_TARGET udunits)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash>=0.8)

# Spectra is header-only; its package's own CMake file asks for nothing more than Eigen.
find_path(SPECTRA_INCLUDE_DIR Spectra/SymGEigsShiftSolver.h REQUIRED)

# Debian's SuiteSparse 5 and Gmsh come without CMake files.
function(driftwright_import name library header suffixes)
  find_library(${name}_LIBRARY ${library} REQUIRED)
  find_path(${name}_INCLUDE_DIR ${header} PATH_SUFFIXES ${suffixes} REQUIRED)
  add_library(${name} UNKNOWN IMPORTED)
  set_target_properties(${name} PROPERTIES IMPORTED_LOCATION ${${name}_LIBRARY}
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${${name}_INCLUDE_DIR} INTERFACE_INCLUDE_DIRECTORIES ${${name}_INCLUDE_DIR})
endfunction()
driftwright_import(SuiteSparse::CHOLMOD cholmod cholmod.h suitesparse)
driftwright_import(Gmsh::Whole gmsh gmsh.h "")
driftwright_on_demand(Gmsh::Gmsh Gmsh::Whole _ZN4gmsh gmsh)
# Its own CMake files would link the first BLAS they find (ATLAS) before the one CHOLMOD is meant to run on.
driftwright_import(Ceres::ceres ceres ceres/ceres.h "")
find_library(GLOG_LIBRARY glog REQUIRED)  # its headers call it
set_target_properties(Ceres::ceres PROPERTIES INTERFACE_LINK_LIBRARIES "${GLOG_LIBRARY}")

# Finite elements over several processes (packages-mpi.txt).
option(DRIFTWRIGHT_MPI "simulate --distributed, by MPI and PETSc" OFF)
if(DRIFTWRIGHT_MPI)
  find_package(MPI REQUIRED COMPONENTS CXX)
  pkg_check_modules(petsc REQUIRED IMPORTED_TARGET PETSc>=3.18)
  # Debian's flags of its own build (_FORTIFY_SOURCE) would not fit the precompiled headers.
  set_target_properties(PkgConfig::petsc PROPERTIES INTERFACE_COMPILE_OPTIONS "")
  find_package(SUNDIALS 6.4 REQUIRED COMPONENTS arkode nvecserial nvecparallel)
endif()

# GoogleTest compiles the tests; the program does without.
find_package(GTest 1.12)
if(NOT TARGET GTest::gmock)
  message(STATUS "Tests are not built: GoogleTest (libgtest-dev, libgmock-dev) is not installed; ./test installs it")
endif()
