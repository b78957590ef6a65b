#pragma once
// A machine of a scenario: its drift ahead of a run, its fields, its readings row by row, and what measurements say about
// it.

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

/// The state of the machine before a predicted job; the same options as of `driftwright predict`.
struct PredictOptions {
  std::string start = {};        ///< a record CSV, or a cyclogram of the scenario; empty: the scenario's start
  std::string after_pause = {};  ///< pause at rest after `start`, such as "30 min"; empty: none
  std::string model = {};        ///< "reduced", "full"; empty: reduced wherever there is one
};

/// The mesh in VTK's layout: cell i has the nodes node[offset[i]] to node[offset[i + 1] - 1], in VTK's order.
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
  std::vector<double> temperature_degC;  ///< one per node
  std::vector<double> displacement_um;   ///< x, y, z of the first node, of the second, ...
};

/// What drives the machine from one row to the next.
struct Row {
  double time_s = 0.0;                      ///< increasing; of the first row: the start of the run
  Drive drive = {};                         ///< applies from the previous row until this one
  std::optional<double> ambient_degC = {};  ///< at this row, linear in between; none: the scenario's ambient
};

/// A run that receives its drive row by row, as it happens; the future is not known.
class DRIFTWRIGHT_API Run {
 public:
  Run(Run&&) noexcept;
  Run& operator=(Run&&) noexcept;
  ~Run();

  /// Advances to the time of a row. @return the readings there, in the order of channels()
  /// @throws InputError  for time that does not increase
  std::vector<double> step(const Row& row);
  /// The channels that step() returns: temperatures, displacements and tilts of the scenario, without values.
  [[nodiscard]] const std::vector<Channel>& channels() const;

 private:
  friend class Machine;
  struct State;
  explicit Run(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// A scenario's machine. A model is built when it is first needed; reduced models are kept on disk in the same store as the
/// program's. Const members may be called from several threads at once.
class DRIFTWRIGHT_API Machine {
 public:
  /// @throws InputError  for a scenario that cannot be read or has no machine
  explicit Machine(const std::string& scenario_file, Listener listener = {});
  Machine(Machine&&) noexcept;
  Machine& operator=(Machine&&) noexcept;
  ~Machine();

  [[nodiscard]] const std::string& name() const;
  /// The path given to the constructor.
  [[nodiscard]] const std::string& scenario_file() const;
  /// Names of the scenario's cyclograms; the next three list its temperature, displacement and tilt sensors.
  [[nodiscard]] std::vector<std::string> cyclograms() const;
  [[nodiscard]] std::vector<std::string> sensors() const;
  [[nodiscard]] std::vector<std::string> displacements() const;
  [[nodiscard]] std::vector<std::string> tilts() const;

  /// The scenario's cyclogram of that name, or the cyclogram that is read from a record CSV.
  /// @throws InputError  if there is no cyclogram of that name, or the machine cannot run it
  [[nodiscard]] Cyclogram cyclogram(const std::string& name_or_csv) const;
  /// The cyclogram that a record contains: speed, feeds, power and the columns that effects ask for.
  [[nodiscard]] Cyclogram cyclogram(const Record& record) const;

  /// The drift ahead of a run, as `driftwright predict` computes it.
  /// @throws InputError, SolveError
  [[nodiscard]] Record predict(const Cyclogram& cyclogram, const PredictOptions& options = {}) const;
  /// The same for several cyclograms, in parallel on all cores.
  [[nodiscard]] std::vector<Record> predict(const std::vector<Cyclogram>& cyclograms,
                                            const PredictOptions& options = {}) const;

  /// A run of the model that the scenario asks for (`solver: {model: ...}`), as `driftwright simulate` does it.
  [[nodiscard]] Record simulate(const Cyclogram& cyclogram) const;
  /// The fields of such a run. @param times_s  within the cyclogram; the start and the end are always included
  /// @throws InputError  for a machine without mesh
  [[nodiscard]] std::vector<Field> fields(const Cyclogram& cyclogram, const std::vector<double>& times_s) const;
  /// The mesh of the machine; empty for a machine of lumped nodes.
  [[nodiscard]] Mesh mesh() const;

  /// Starts a run row by row, with the model used for predictions, from the scenario's start at time_s = 0.
  /// @param ambient_degC  at time 0; none: the scenario's ambient
  /// @throws InputError  for a machine with thermostats, because rows do not contain their switching
  [[nodiscard]] Run start(std::optional<double> ambient_degC = {}, const std::string& run_name = "run") const;

  /// What the records say about the machine, as `driftwright diagnose`. @param measured  each with its own `source`
  /// @throws InputError  for records that cannot be compared or have a blunder, and for a key in `without` that no candidate
  /// has
  /// @throws SolveError  where the machine with what was found has no solution
  [[nodiscard]] Diagnosis diagnose(const std::vector<Record>& measured, const DiagnoseOptions& options = {}) const;
  /// Fits the scenario's uncertain numbers to records, as `driftwright calibrate`; does not search for causes. Errors as
  /// diagnose(). @param as_recorded  as in DiagnoseOptions
  [[nodiscard]] Diagnosis calibrate(const std::vector<Record>& measured, bool as_recorded = false) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright
