# driftwright_target(NAME): what every target of this project has: include paths from the top folder, warnings,
# OpenMP, and the precompiled headers that nearly every file needs (built once, with the target `base`).
add_library(driftwright_warnings INTERFACE)
target_compile_options(driftwright_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  $<$<BOOL:${DRIFTWRIGHT_WERROR}>:-Werror>)

function(driftwright_target name)
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  # Eigen's own threads would wait for each other in loops, and sums would depend on their number.
  target_compile_definitions(${name} PRIVATE EIGEN_DONT_PARALLELIZE)
  target_link_libraries(${name} PRIVATE driftwright_warnings OpenMP::OpenMP_CXX Eigen3::Eigen fmt::fmt)
  if(name STREQUAL driftwright_base)
    target_precompile_headers(${name} PRIVATE <Eigen/Sparse> <fmt/format.h> <string> <vector> <memory> <functional>)
  else()
    target_precompile_headers(${name} REUSE_FROM driftwright_base)
  endif()
endfunction()
