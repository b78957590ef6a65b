#pragma once
// A first scenario of a machine of which only the geometry is known: facts from the geometry, and marked guesses for the
// rest.

#include <optional>
#include <string>
#include <vector>

#include "mesh/unnamed_geometry.hpp"

namespace driftwright::studies {

struct MachineDraft {
  struct Region {
    std::string name;
    std::string material;                     ///< from the library: a guess
    std::optional<Eigen::Vector3d> inside_m;  ///< a point in a solid that has no name in the file
    double mesh_size_m = 0.0;                 ///< 0: for a mesh, which has its nodes already
  };
  struct Plane {
    std::string surface, region;
    Eigen::Vector3d through_m, normal;
  };
  struct Joint {
    std::string name;
    std::string a, b;  ///< surfaces; empty if the file has the joint already
  };
  struct Foot {
    std::string surface;
    double share;  ///< share of the springs that carry the machine
  };
  struct Point {
    std::string region;
    Eigen::Vector3d at_m;
  };
  std::vector<Region> regions;
  std::vector<Plane> planes;
  std::vector<std::string> remaining;  ///< regions with outer faces on no surface: "<region>_rest"
  std::vector<Joint> joints;
  std::vector<Foot> feet;
  std::vector<std::string> films;  ///< surfaces exposed to air
  std::string spindle;             ///< heated region: a guess
  double heat_W = 0.0;             ///< heat that warms the whole machine by about 2 K
  Point tool;
  std::optional<Point> table;
  std::vector<Point> thermometers;   ///< one per region
  std::vector<std::string> remarks;  ///< what the geometry leaves open
};

/// @throws InputError  for a mesh without outer faces
[[nodiscard]] MachineDraft draft_of(const mesh::UnnamedGeometry& geometry);

/// A valid name of a surface or sensor: all characters except letters, digits, '_' and '-' become '_'.
[[nodiscard]] std::string plain_name(const std::string& name);

}  // namespace driftwright::studies
