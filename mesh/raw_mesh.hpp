#pragma once
// A mesh as read from a file, before it is checked: with the file's numbers, in the file's unit of length.

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

struct RawMesh {
  std::string path;
  Eigen::Matrix3Xd coords;        ///< 3 x n_nodes, in the unit of the file
  std::vector<long> node_number;  ///< number of each node in the file
  Cells cells;                    ///< 3-D elements; group: index into regions
  std::vector<long> cell_number;  ///< number of each element in the file
  std::vector<std::string> regions;

  /// Named surfaces, in the forms that files use. A name may occur in several entries.
  struct FacetSurface {  ///< 2-D elements
    std::string name;
    std::vector<std::vector<int>> corners;  ///< corner nodes of each
    std::vector<long> number;               ///< number of each in the file
  };
  struct FaceSurface {  ///< faces of cells
    std::string name;
    std::vector<std::pair<int, int>> face;  ///< cell, index into faces_of()
  };
  struct NodeSurface {  ///< a set of nodes: the outer faces whose nodes are all in the set
    std::string name;
    std::vector<int> nodes;
    bool may_be_empty = false;  ///< true: a set without a whole face (points, edges) is not a surface, and no error
  };
  std::vector<FacetSurface> facet_surfaces;
  std::vector<FaceSurface> face_surfaces;
  std::vector<NodeSurface> node_surfaces;
  std::vector<std::string> notes;  ///< what the reader left out or changed, for the user
};

/// Checks a raw mesh and makes a mesh of it. Nodes that no cell uses are dropped, with a note. Facets must be faces of
/// cells; a surface may lie between two cells of one body. Side surfaces "<joint>@<side>" come in pairs and make joints.
///
/// @param unit_m  length of the file's unit [m]
/// @throws InputError  naming the file and the element or node in it: a coordinate that is not finite; a body larger than
///                     100 m or smaller than 1 mm; a cell that is inverted or occurs twice; neighbours that do not match
///                     (mid-side node against none, quad against triangles); a region without cells; a facet that is no face
///                     of a cell; a surface without faces
[[nodiscard]] Mesh check_and_build(const RawMesh& raw, double unit_m);

}  // namespace driftwright::mesh
