#pragma once
// What `diagnose` and `calibrate` begin with: a scenario's twin beside measured records.

#include <memory>
#include <optional>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/focus.hpp"
#include "machine/model.hpp"

namespace driftwright::studies {

/// A twin and what it refers to, which stays where it is.
struct TwinParts {
  diagnosis::AugmentedModel augmented;
  scenarios::ReducedMachine machine;
};

struct MeasuredTwin {
  scenarios::Scenario scenario;
  mesh::Mesh mesh;
  std::vector<diagnosis::MeasuredRun> runs;
  std::unique_ptr<TwinParts> fine, other;
  std::unique_ptr<diagnosis::Focus> focus;  ///< what the twin runs on
  std::optional<diagnosis::Twin> twin, on_other_mesh;
  std::string why_one_mesh;         ///< where there is no other mesh
  diagnosis::DiagnosisOptions how;  ///< with the errors of the mesh and of the reduced model
};

/// What no reading of such a machine is better than: one that is integrated in steps, or switches, is known less well.
[[nodiscard]] diagnosis::NoiseFloor floor_of(const solver::ReducedSystem& system);

/// Meshes and reduces; a machine whose mesh has a size on a second mesh, too.
/// @throws InputError  for what cannot be read or compared
[[nodiscard]] MeasuredTwin open_measured_twin(const scenarios::Scenario& scenario, const std::string& verb,
                                              const std::vector<ReadRecord>& measured, const Listener& listener);
/// The same with records from files. @param measured  record CSVs, or as the scenario's `columns` says
[[nodiscard]] MeasuredTwin open_measured_twin(const scenarios::Scenario& scenario, const std::string& verb,
                                              const std::vector<std::string>& measured, const Listener& listener);

/// What instruments of a state of the twin say of all rows of all runs.
/// @throws SolveError  where the state has no solution
[[nodiscard]] diagnosis::Prediction read_of(const MeasuredTwin& m, const diagnosis::TwinState& state);

/// A sentence without its full stop where what the mesh does could not be told; else empty.
[[nodiscard]] std::string one_mesh_text(const MeasuredTwin& m);

}  // namespace driftwright::studies
