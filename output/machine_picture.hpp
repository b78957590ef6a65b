#pragma once
// A machine as one picture: its surface in colour from two opposite sides, how it bends, and where sensors and indicators sit. An <svg> element with the
// views as PNG inside it.

#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::output {

/// A point on the machine with its name.
struct PictureMark {
  std::string name;
  Eigen::Vector3d at_m;
  bool is_indicator = false;  ///< a ring in place of a dot
};

/// A quantity on the nodes, as colour.
struct PictureField {
  std::string label;      ///< with its unit: "temperature [°C]"
  Eigen::VectorXd value;  ///< n_nodes; NaN, grey: has none. One node at least has a value
};

struct MachinePicture {
  const mesh::Mesh* mesh = nullptr;
  /// None: surfaces in colours of their own, with their names.
  std::optional<PictureField> field = {};
  bool by_region = false;  ///< without a field: regions in colours of their own in place of surfaces
  Eigen::Matrix3Xd displacement_m = {};  ///< 3 x n_nodes, shown magnified; empty: none
  std::vector<PictureMark> marks = {};
};

/// The <svg> element, 1000 units wide, wider where names of marks are long.
/// @throws std::logic_error  for a mesh without cells, or a field of another size
[[nodiscard]] std::string draw_machine(const MachinePicture& picture);

}  // namespace driftwright::output
