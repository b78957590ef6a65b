# driftwright_target(NAME [HEADERS <a> <b> ...] [HEADERS_OF target]): what every target of this project has: include paths from the top folder,
# warnings, OpenMP, and the precompiled headers that nearly every file needs (built once, with the target `base`). HEADERS: these
# too, built for this target; HEADERS_OF: those of a target that has its own.
add_library(driftwright_warnings INTERFACE)
target_compile_options(driftwright_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  $<$<BOOL:${DRIFTWRIGHT_WERROR}>:-Werror>)

function(driftwright_target name)
  cmake_parse_arguments(ARG "" "HEADERS_OF" "HEADERS" ${ARGN})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
  get_target_property(type ${name} TYPE)
  if(type STREQUAL EXECUTABLE)  # they share precompiled headers with libraries, which are made for a shared one
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(${name} PRIVATE -fPIC)
  endif()
  # Eigen's own threads would wait for each other in loops, and sums would depend on their number.
  target_compile_definitions(${name} PRIVATE EIGEN_DONT_PARALLELIZE)
  target_link_libraries(${name} PRIVATE driftwright_warnings OpenMP::OpenMP_CXX Eigen3::Eigen fmt::fmt)
  if(name STREQUAL driftwright_base OR ARG_HEADERS)
    target_precompile_headers(${name} PRIVATE <Eigen/Sparse> <fmt/format.h> <string> <vector> <memory> <functional> ${ARG_HEADERS})
  elseif(ARG_HEADERS_OF)
    target_precompile_headers(${name} REUSE_FROM ${ARG_HEADERS_OF})
  else()
    target_precompile_headers(${name} REUSE_FROM driftwright_base)
  endif()
endfunction()
