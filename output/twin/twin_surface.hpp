#pragma once
// The outer surface of a machine with the fields of its small system's states, small enough for a page: fields as 16-bit
// numbers.

#include <cstdint>
#include <string>
#include <vector>

#include "machine/reduced_machine.hpp"

namespace driftwright::output {

/// Numbers in 16 bits: value = scale * integer.
struct Quantised {
  std::vector<double> scale = {};        ///< of each mode
  std::vector<std::int16_t> value = {};  ///< mode by mode
};
/// Each column is scaled by its own largest magnitude. @param modes  n x n_modes
[[nodiscard]] Quantised quantised(const Eigen::MatrixXf& modes);

struct TwinSurface {
  std::vector<int> node = {};                ///< nodes of the mesh on the skin, each once
  Eigen::Matrix3Xf coords_m = {};            ///< of these nodes
  std::vector<std::uint32_t> triangle = {};  ///< three indices of these each, counterclockwise from outside
  std::vector<std::uint32_t> edge = {};      ///< two indices of these each: where parts meet, or the skin bends sharply
  Quantised temperature = {};                ///< of these nodes over the reference, in each state [K]
  Quantised displacement_m = {};             ///< x, y, z of each node in turn, in each state; empty without fields
};
/// The edges to draw of its triangles: ends of one triangle alone, where regions meet, and sharp bends.
/// @param region  of each triangle
[[nodiscard]] std::vector<std::uint32_t> drawn_edges(const TwinSurface& surface, const std::vector<int>& region);
/// @throws std::logic_error  for a machine without temperature fields
[[nodiscard]] TwinSurface twin_surface(const scenarios::ReducedMachine& machine);

}  // namespace driftwright::output
