#pragma once
// The outside of a machine with the fields of its small system's states, small enough for a page: modes as 16-bit numbers.

#include <cstdint>
#include <string>
#include <vector>

#include "machine/reduced_machine.hpp"

namespace driftwright::output {

/// Numbers as 16 bits: value = scale * integer.
struct Quantised {
  std::vector<double> scale = {};        ///< of each mode
  std::vector<std::int16_t> value = {};  ///< mode by mode
};
/// Each column by its own largest magnitude. @param modes  n x n_modes
[[nodiscard]] Quantised quantised(const Eigen::MatrixXf& modes);

struct TwinSurface {
  std::vector<int> node = {};                ///< of the mesh: those of the skin, each once
  Eigen::Matrix3Xf coords_m = {};            ///< of these
  std::vector<std::uint32_t> triangle = {};  ///< three of these each, counterclockwise from outside
  std::vector<std::uint32_t> edge = {};      ///< two of these each: where parts meet, or the skin bends sharply
  Quantised temperature = {};                ///< of these over the reference in each state [K]
  Quantised displacement_m = {};             ///< x, y, z of the first, then of the next, in each state; empty without fields
};
/// @throws std::logic_error  for a machine without fields of temperature
[[nodiscard]] TwinSurface twin_surface(const scenarios::ReducedMachine& machine);

}  // namespace driftwright::output
