# What the program is built for. Reduced models are dense algebra, which takes two thirds of the time with AVX2: where the processor that
# builds has it (x86-64-v3), the program is built for it and then runs on no older one. -DDRIFTWRIGHT_PROCESSOR=baseline
# is for every x86-64, and so is what packages are built with.
set(DRIFTWRIGHT_PROCESSOR "automatic" CACHE STRING "automatic: as this machine's (x86-64-v3 or baseline); baseline: any")
set_property(CACHE DRIFTWRIGHT_PROCESSOR PROPERTY STRINGS automatic baseline)
if(CMAKE_CXX_FLAGS MATCHES "-march=")
  message(STATUS "DRIFTWRIGHT_PROCESSOR: CMAKE_CXX_FLAGS say what to build for")
elseif(DRIFTWRIGHT_PROCESSOR STREQUAL "automatic")
  include(CheckCXXSourceRuns)
  check_cxx_source_runs("int main() { return !(__builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") &&
      __builtin_cpu_supports(\"bmi\") && __builtin_cpu_supports(\"bmi2\")); }" DRIFTWRIGHT_HAS_AVX2)
  if(DRIFTWRIGHT_HAS_AVX2)
    string(APPEND CMAKE_CXX_FLAGS " -march=x86-64-v3")
    set(DRIFTWRIGHT_NEEDS_AVX2 ON)  # app/processor_guard.cpp says so on others
  endif()
elseif(NOT DRIFTWRIGHT_PROCESSOR STREQUAL "baseline")
  message(FATAL_ERROR "DRIFTWRIGHT_PROCESSOR is '${DRIFTWRIGHT_PROCESSOR}'; automatic or baseline are possible")
endif()
# Libraries bring functions of Eigen of their own, built for other vectors and other alignments; theirs and ours must not stand in for each other.
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
