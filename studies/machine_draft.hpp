#pragma once
// A first scenario of a machine of which only the geometry is known: what the geometry tells, and guesses for the rest, which are marked as such.

#include <optional>
#include <string>
#include <vector>

#include "mesh/unnamed_geometry.hpp"

namespace driftwright::studies {

struct MachineDraft {
  struct Region {
    std::string name;
    std::string material;                     ///< of the library: a guess
    std::optional<Eigen::Vector3d> inside_m;  ///< a point in a solid that the file does not name
    double mesh_size_m = 0.0;                 ///< 0: of a mesh, whose nodes are there
  };
  struct Plane {
    std::string surface, region;
    Eigen::Vector3d through_m, normal;
  };
  struct Joint {
    std::string name;
    std::string a, b;  ///< surfaces; empty where the file has the joint already
  };
  struct Foot {
    std::string surface;
    double share;  ///< of the springs that carry the machine
  };
  struct Point {
    std::string region;
    Eigen::Vector3d at_m;
  };
  std::vector<Region> regions;
  std::vector<Plane> planes;
  std::vector<std::string> remaining;  ///< regions that have outer faces on no surface: "<region>_rest"
  std::vector<Joint> joints;
  std::vector<Foot> feet;
  std::vector<std::string> films;  ///< surfaces in the air
  std::string spindle;             ///< the region that is heated: a guess
  double heat_W = 0.0;             ///< that warms the whole machine by about 2 K
  Point tool;
  std::optional<Point> table;
  std::vector<Point> thermometers;   ///< one a region
  std::vector<std::string> remarks;  ///< what the geometry leaves open
};

/// @throws InputError  for a mesh without outer faces
[[nodiscard]] MachineDraft draft_of(const mesh::UnnamedGeometry& geometry);

/// A name as a surface or sensor may have it: what is neither letter, digit, '_' nor '-' becomes '_'.
[[nodiscard]] std::string plain_name(const std::string& name);

}  // namespace driftwright::studies
