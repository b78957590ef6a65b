#pragma once
// Reads faces with values from VTK's files, as CFD programs write them.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace driftwright::mesh {

/// The plane faces of a file, their corners, and every scalar array of the file as one value a face.
struct SurfaceValues {
  std::vector<int> corner_from = {0};  ///< corners of face f: columns corner_from[f] to corner_from[f + 1] - 1 of `corner`
  Eigen::Matrix3Xd corner;             ///< in the unit of the file
  std::map<std::string, std::vector<double>> arrays;  ///< by name; of points: the mean over the corners of a face
};

/// Reads .vtp, .vtu or legacy .vtk. Volumes, lines and points are left out; faces of second order are read by their corners.
/// Where an array of cells and one of points have the same name, that of the cells counts.
/// @throws InputError  for a file that VTK cannot read, that has no faces, or whose cells name points that it does not have
[[nodiscard]] SurfaceValues read_surface_values(const std::string& path);

}  // namespace driftwright::mesh
