#pragma once
// One picture of a machine: its coloured surface from two opposite sides, its deformation, and the positions of sensors
// and indicators. It is an <svg> element with the views as PNG inside.

#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::output {

/// A point on the machine with its name.
struct PictureMark {
  std::string name;
  Eigen::Vector3d at_m;
  bool is_indicator = false;  ///< drawn as a ring instead of a dot
};

/// A quantity on the nodes, shown as colour.
struct PictureField {
  std::string label;      ///< with its unit: "temperature [°C]"
  Eigen::VectorXd value;  ///< n_nodes; NaN is drawn grey. At least one node must have a value
  int surface = -1;       ///< index of the surface that alone has the quantity; other faces are grey. -1: all have it
};

struct MachinePicture {
  const mesh::Mesh* mesh = nullptr;
  /// None: each surface has its own colour, with its name.
  std::optional<PictureField> field = {};
  bool by_region = false;                ///< without a field: one colour per region instead of per surface
  Eigen::Matrix3Xd displacement_m = {};  ///< 3 x n_nodes, shown magnified; empty: none
  std::vector<PictureMark> marks = {};
};

/// The <svg> element, 1000 units wide, wider where names of marks are long.
/// @throws std::logic_error  for a mesh without cells, or a field of another size
[[nodiscard]] std::string draw_machine(const MachinePicture& picture);

}  // namespace driftwright::output
