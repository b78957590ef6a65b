#pragma once
// A machine of a scenario: its drift ahead of a run, its fields, its readings row by row, and what measurements say about it.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driftwright/api.hpp"
#include "driftwright/cyclogram.hpp"
#include "driftwright/diagnosis.hpp"
#include "driftwright/errors.hpp"
#include "driftwright/listener.hpp"
#include "driftwright/record.hpp"

namespace driftwright {

/// What was before a predicted job; as options of `driftwright predict`.
struct PredictOptions {
  std::string start = {};        ///< a record CSV, or a cyclogram of the scenario; empty: the scenario's start
  std::string after_pause = {};  ///< at rest behind it, such as "30 min"; empty: none
  std::string model = {};        ///< "reduced", "full"; empty: reduced wherever there is one
};

/// The mesh as VTK has it: cell i has the nodes node[offset[i]] to node[offset[i + 1] - 1], in VTK's order.
struct Mesh {
  std::vector<double> points_m;  ///< x, y, z of the first node, of the second, ...
  std::vector<int> offset, node;
  std::vector<int> vtk_type;  ///< of each cell, such as 24 for a quadratic tetrahedron
  std::vector<int> region;    ///< of each cell: index of its name
  std::vector<std::string> region_name;
};

/// Temperature and displacement of all nodes at one time.
struct Field {
  double time_s = 0.0;
  std::vector<double> temperature_degC;  ///< one a node
  std::vector<double> displacement_um;   ///< x, y, z of the first node, of the second, ...
};

/// What drives the machine from one row to the next.
struct Row {
  double time_s = 0.0;                      ///< increasing; of the first row, when the run begins
  Drive drive = {};                         ///< holds from the row before until this one
  std::optional<double> ambient_degC = {};  ///< at this row, linear in between; none: the scenario's
};

/// A machine on its way through a run that is not known ahead.
class DRIFTWRIGHT_API Run {
 public:
  Run(Run&&) noexcept;
  Run& operator=(Run&&) noexcept;
  ~Run();

  /// Goes on to a row. @return the readings there, in the order of channels()
  /// @throws InputError  for time that does not increase
  std::vector<double> step(const Row& row);
  /// Temperatures, displacements and tilts of the scenario, without values.
  [[nodiscard]] const std::vector<Channel>& channels() const;

 private:
  friend class Machine;
  struct State;
  explicit Run(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// A scenario's machine. Models are made where they are first needed, reduced ones kept on disk as the program keeps them; const members may be
/// called from several threads at once.
class DRIFTWRIGHT_API Machine {
 public:
  /// @throws InputError  for a scenario that cannot be read or has no machine
  explicit Machine(const std::string& scenario_file, Listener listener = {});
  Machine(Machine&&) noexcept;
  Machine& operator=(Machine&&) noexcept;
  ~Machine();

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] const std::string& scenario_file() const;
  [[nodiscard]] std::vector<std::string> cyclograms() const;
  [[nodiscard]] std::vector<std::string> sensors() const;
  [[nodiscard]] std::vector<std::string> displacements() const;
  [[nodiscard]] std::vector<std::string> tilts() const;

  /// A cyclogram of the scenario by its name, or the one that a record CSV tells.
  /// @throws InputError  for none of that name, and for one that the machine cannot run
  [[nodiscard]] Cyclogram cyclogram(const std::string& name_or_csv) const;
  /// What a record says drove the machine: speed, feeds, power and the columns that effects ask for.
  [[nodiscard]] Cyclogram cyclogram(const Record& record) const;

  /// The drift ahead of a run, as `driftwright predict` tells it.
  /// @throws InputError, SolveError
  [[nodiscard]] Record predict(const Cyclogram& cyclogram, const PredictOptions& options = {}) const;
  /// The same of several, side by side on all cores.
  [[nodiscard]] std::vector<Record> predict(const std::vector<Cyclogram>& cyclograms,
                                            const PredictOptions& options = {}) const;

  /// A run by the model that the scenario asks for (`solver: {model: ...}`), as `driftwright simulate` does it.
  [[nodiscard]] Record simulate(const Cyclogram& cyclogram) const;
  /// The fields of such a run. @param times_s  within the cyclogram; the start and the end come in any case
  /// @throws InputError  for a machine without mesh
  [[nodiscard]] std::vector<Field> fields(const Cyclogram& cyclogram, const std::vector<double>& times_s) const;
  /// Without nodes for a machine of lumped nodes.
  [[nodiscard]] Mesh mesh() const;

  /// A run row by row by the model that predictions run on, from the scenario's start at time_s = 0.
  /// @param ambient_degC  at that time; none: the scenario's
  /// @throws InputError  for a machine with thermostats, whose switches no row tells
  [[nodiscard]] Run start(std::optional<double> ambient_degC = {}, const std::string& run_name = "run") const;

  /// What the records say about the machine, as `driftwright diagnose`. @param measured  each with a `source` of its own
  [[nodiscard]] Diagnosis diagnose(const std::vector<Record>& measured, const DiagnoseOptions& options = {}) const;
  /// The scenario's uncertain numbers fitted to records, as `driftwright calibrate`: no cause is looked for.
  [[nodiscard]] Diagnosis calibrate(const std::vector<Record>& measured) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright
