#pragma once
// Sums over a program, and its blocks by line, for tests of NC programs.

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

#include "nc/program.hpp"

namespace driftwright::fixtures {

inline std::array<double, 3> travel_mm(const NcProgram& program) {
  std::array<double, 3> sum = {0, 0, 0};
  for (const NcMove& m : program.moves) {
    for (int axis = 0; axis < 3; ++axis) sum[axis] += 1e3 * m.travel_m[axis];
  }
  return sum;
}

inline double revolutions(const NcProgram& program) {
  double sum = 0.0;
  for (const NcMove& m : program.moves) sum += m.speed_rpm / 60.0 * m.duration_s;
  return sum;
}

/// Index of the step on a line.
inline std::size_t on_line(const NcProgram& program, int line) {
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    if (program.steps[i].where.line == line) return i;
  }
  ADD_FAILURE() << "no block on line " << line;
  return 0;
}

}  // namespace driftwright::fixtures
