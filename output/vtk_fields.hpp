#pragma once
// Fields on a mesh as ParaView opens them: compressed .vtu files, and a .pvd that lists them with their
// times.

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "output/results_folder.hpp"

namespace driftwright::output {

/// Stresses at the nodes.
struct StressField {
  Eigen::Matrix<double, 6, Eigen::Dynamic> stress_MPa;  ///< rows xx, yy, zz, xy, yz, xz: VTK's order of a symmetric tensor
  Eigen::VectorXd von_mises_MPa;
};

/// Temperature, displacement and, if given, stress of one mesh at a series of times.
///
/// Each file fields/fields_<0000...>.vtu carries the point arrays `temperature_degC` and `displacement_um` (3
/// components, X Y Z of the machine), with stresses also `stress_MPa` (6 components, named XX, YY, ZZ, XY, YZ, XZ) and
/// `von_mises_MPa`, the cell array `region` (index into the region names), and the field
/// arrays `region_names`, `TimeValue` [s] and `made_by`. Coordinates are in m and 64 bits wide, the point
/// arrays 32 bits: seven digits. The same input gives the same bytes.
class FieldSeries {
 public:
  /// @param folder  where files go; must outlive the series
  /// @param mesh    its cells are written, its facets are not; copied, so it need not outlive the call
  FieldSeries(ResultsFolder& folder, const mesh::Mesh& mesh);
  ~FieldSeries();
  FieldSeries(const FieldSeries&) = delete;
  FieldSeries& operator=(const FieldSeries&) = delete;

  /// Writes the fields at one time.
  /// @param time_s            later than that of the call before [s]
  /// @param temperature_degC  n_nodes [degC]
  /// @param displacement_um   3 x n_nodes, one column per node [um]
  /// @param stress            of n_nodes, or nullptr; the same choice for all times
  /// @throws std::logic_error    when a shape does not fit the mesh, or time does not increase
  /// @throws InputError  when a file cannot be written
  void write(double time_s, const Eigen::VectorXd& temperature_degC, const Eigen::Matrix3Xd& displacement_um,
             const StressField* stress = nullptr);

  /// Writes fields.pvd, which lists what has been written. Call it last.
  void finish();

 private:
  struct Grid;  // keeps VTK's headers out of this one
  ResultsFolder& folder_;
  std::unique_ptr<Grid> grid_;
  std::vector<double> times_s_;
};

/// Writes a mesh without fields: cell arrays `region` and `quality` [-], field array `region_names`; then its facets as 2-D
/// cells with the cell array `surface` (-1 on cells) and the field array `surface_names`, sides of joints among them, so that
/// mesh::read_vtu() has the same mesh again. Facets have region -1 and quality NaN.
/// @param quality  one value per cell, or empty to leave the array out
/// @param file     a path from ResultsFolder::path()
/// @throws std::logic_error    when `quality` has another length
/// @throws InputError  when the file cannot be written
void write_mesh(const mesh::Mesh& mesh, std::span<const double> quality, const std::filesystem::path& file);

}  // namespace driftwright::output
