# driftwright_target(NAME [NUMERIC] [HEADERS <a> <b> ...] [HEADERS_OF target]): what every target of this project has: include paths from the top folder,
# warnings, OpenMP, and the precompiled headers that nearly every file needs (built once, with the target `base`). HEADERS: these
# too, built for this target; HEADERS_OF: those of a target that has its own.
# NUMERIC, with HEADERS: this target, and each that takes its headers, is where the program spends its time (Eigen's kernels, the solver). The
# compiler optimises the others less and takes a third less time. GCC takes the level from the precompiled header, whatever the command says; so both are decided here.
#
# The compiler spends most of its time on headers and templates, so files of a target are compiled in batches of some 120 kB of source, each
# one translation unit; a name in an anonymous namespace is therefore one in its room. -DDRIFTWRIGHT_BATCHED=OFF, which the
# preset dev has, compiles each file alone and shows which include is missing.
option(DRIFTWRIGHT_BATCHED "Compile files of a target in batches" ON)
set(DRIFTWRIGHT_BATCH_BYTES 120000)

function(driftwright_batches name)
  get_target_property(sources ${name} SOURCES)
  get_target_property(folder ${name} SOURCE_DIR)
  set(batch 1)
  set(bytes 0)
  foreach(source ${sources})
    get_filename_component(path ${source} ABSOLUTE BASE_DIR ${folder})
    if(NOT source MATCHES "\\.cpp$" OR NOT EXISTS ${path})
      continue()
    endif()
    file(SIZE ${path} size)
    if(bytes GREATER 0)
      math(EXPR with "${bytes} + ${size}")
      if(with GREATER DRIFTWRIGHT_BATCH_BYTES)
        math(EXPR batch "${batch} + 1")
        set(bytes 0)
      endif()
    endif()
    math(EXPR bytes "${bytes} + ${size}")
    set_source_files_properties(${path} PROPERTIES UNITY_GROUP ${batch})
  endforeach()
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  target_compile_options(${name} PRIVATE -Wno-subobject-linkage)  # a class of one file may hold what is anonymous in it
endfunction()

add_library(driftwright_warnings INTERFACE)
target_compile_options(driftwright_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  $<$<BOOL:${DRIFTWRIGHT_WERROR}>:-Werror>
  # GCC 12 gives these warnings for templates of libraries where nothing is wrong.
  -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict)

function(driftwright_target name)
  cmake_parse_arguments(ARG "NUMERIC" "HEADERS_OF" "HEADERS" ${ARGN})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
  get_target_property(type ${name} TYPE)
  if(type STREQUAL EXECUTABLE)  # they share precompiled headers with libraries, which are made for a shared one
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(${name} PRIVATE -fPIC)
  endif()
  if(DRIFTWRIGHT_BATCHED)
    driftwright_batches(${name})
  endif()
  if(ARG_HEADERS_OF)
    get_target_property(ARG_NUMERIC ${ARG_HEADERS_OF} DRIFTWRIGHT_NUMERIC)
  endif()
  if(ARG_NUMERIC)
    set_target_properties(${name} PROPERTIES DRIFTWRIGHT_NUMERIC ON)
  else()
    # With -fexpensive-optimizations products and sums are contracted as with -O3: `run` of the FP3 writes the same bytes.
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CONFIG:Release>:-fexpensive-optimizations>)
  endif()
  # Eigen's own threads would wait for each other in loops, and sums would depend on their number.
  target_compile_definitions(${name} PRIVATE EIGEN_DONT_PARALLELIZE)
  target_link_libraries(${name} PRIVATE driftwright_warnings OpenMP::OpenMP_CXX Eigen3::Eigen fmt::fmt)
  if(name STREQUAL driftwright_base OR ARG_HEADERS OR ARG_NUMERIC AND NOT ARG_HEADERS_OF)
    target_precompile_headers(${name} PRIVATE <Eigen/Sparse> ${PROJECT_SOURCE_DIR}/base/eigen_kernels.hpp <fmt/format.h> <fmt/ranges.h> <algorithm> <functional> <map> <memory>
      <optional> <set> <string> <vector> ${ARG_HEADERS})
  elseif(ARG_HEADERS_OF)
    target_precompile_headers(${name} REUSE_FROM ${ARG_HEADERS_OF})
  else()
    target_precompile_headers(${name} REUSE_FROM driftwright_base)
  endif()
endfunction()
