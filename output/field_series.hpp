#pragma once
// Writes fields on a mesh at a series of times, for ParaView.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/fields_format.hpp"
#include "mesh/mesh.hpp"
#include "output/results_folder.hpp"
#include "solver/stress.hpp"

namespace driftwright::output {

using solver::StressField;

/// Writer of one format; FieldSeries checks the arguments before. One source file per format: vtk_fields, xdmf_fields.
class FieldWriter {
 public:
  virtual ~FieldWriter() = default;
  /// The file that ParaView opens, in the folder of results.
  [[nodiscard]] virtual std::string file_to_open() const = 0;
  /// @param i  number of the time, from 0
  virtual void write(std::size_t i, double time_s, const Eigen::VectorXd& temperature_degC,
                     const Eigen::Matrix3Xd& displacement_um, const StressField* stress) = 0;
  virtual void finish(const std::vector<double>& times_s) = 0;
};

/// Temperature, displacement and, if given, stress of one mesh at a series of times.
///
/// Point arrays `temperature_degC` and `displacement_um` (3 components, X Y Z of the machine), with stresses also
/// `stress_MPa` (6 components: XX, YY, ZZ, XY, YZ, XZ) and `von_mises_MPa`; cell array `region` (index into the region
/// names); the region names and what made the file. Coordinates are in m with 64 bits; the point arrays have 32 bits,
/// seven digits. The same input gives the same bytes.
class FieldSeries {
 public:
  /// @param folder  folder for the files; must outlive the series
  /// @param mesh    its cells are written, its facets are not; it need not outlive the call
  /// @throws InputError  when a file cannot be written
  FieldSeries(ResultsFolder& folder, const mesh::Mesh& mesh, FieldsFormat format = FieldsFormat::kVtu);

  /// Writes the fields at one time.
  /// @param time_s            later than in the previous call [s]
  /// @param temperature_degC  n_nodes [degC]
  /// @param displacement_um   3 x n_nodes, one column per node [um]
  /// @param stress            of n_nodes, or nullptr; either always or never
  /// @throws std::logic_error  when a shape does not fit the mesh, time does not increase, or stress is given only
  /// sometimes
  /// @throws InputError        when a file cannot be written
  void write(double time_s, const Eigen::VectorXd& temperature_degC, const Eigen::Matrix3Xd& displacement_um,
             const StressField* stress = nullptr);

  /// Writes the file that lists the times. Call it last, and once. @throws InputError  when a file cannot be written
  void finish();

  /// The file that ParaView opens: fields.pvd or fields.xdmf.
  [[nodiscard]] std::string file_to_open() const { return writer_->file_to_open(); }
  [[nodiscard]] FieldsFormat format() const { return format_; }
  [[nodiscard]] std::size_t n_times() const { return times_s_.size(); }

 private:
  FieldsFormat format_;
  int n_nodes_;
  std::unique_ptr<FieldWriter> writer_;
  std::vector<double> times_s_;
  std::optional<bool> with_stress_;
};

}  // namespace driftwright::output
