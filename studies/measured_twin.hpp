#pragma once
// Opens a scenario's twin with measured records, for `diagnose` and `calibrate`.

#include <memory>
#include <optional>

#include "diagnosis/blunders.hpp"
#include "diagnosis/diagnosis.hpp"
#include "diagnosis/focus.hpp"
#include "machine/model.hpp"

namespace driftwright::studies {

/// The objects that a twin refers to; they must not move.
struct TwinParts {
  diagnosis::AugmentedModel augmented;
  scenarios::ReducedMachine machine;
};

struct MeasuredTwin {
  scenarios::Scenario scenario;
  mesh::Mesh mesh;
  std::vector<diagnosis::MeasuredRun> runs;
  std::unique_ptr<TwinParts> fine, other;
  std::unique_ptr<diagnosis::Focus> focus;  ///< the machine that the twin runs on
  std::optional<diagnosis::Twin> twin, on_other_mesh;
  std::string why_one_mesh;                    ///< reason if there is no other mesh
  diagnosis::DiagnosisOptions how;             ///< includes the errors of the mesh and of the reduced model
  std::vector<diagnosis::Blunder> blunders;    ///< of the records, if they are used as recorded; else there are none
  std::vector<diagnosis::Renaming> renamings;  ///< names that columns without one probably have
};

/// The lowest noise that readings of such a machine can have; it is higher for a machine that is integrated in steps, or
/// that switches.
[[nodiscard]] diagnosis::NoiseFloor floor_of(const solver::ReducedSystem& system);

/// Meshes and reduces the machine; a machine whose mesh has a size also on a second mesh.
/// @param as_recorded  go on with records that have a blunder (diagnosis/blunders.hpp)
/// @throws InputError  for records that cannot be read or compared, and for blunders, all of them in one message
[[nodiscard]] MeasuredTwin open_measured_twin(const scenarios::Scenario& scenario, const std::string& verb,
                                              const std::vector<ReadRecord>& measured, const Listener& listener,
                                              bool as_recorded = false);
/// The same with records from files. @param measured  record CSVs, or files as described by the scenario's `columns`
[[nodiscard]] MeasuredTwin open_measured_twin(const scenarios::Scenario& scenario, const std::string& verb,
                                              const std::vector<std::string>& measured, const Listener& listener,
                                              bool as_recorded = false);

/// The readings of a state of the twin at all rows of all runs.
/// @throws SolveError  if the state has no solution
[[nodiscard]] diagnosis::Prediction read_of(const MeasuredTwin& m, const diagnosis::TwinState& state);

/// A sentence, without its full stop, if the effect of the mesh could not be determined; otherwise empty.
[[nodiscard]] std::string one_mesh_text(const MeasuredTwin& m);

}  // namespace driftwright::studies
