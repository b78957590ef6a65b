#pragma once
// The model that a verb runs cyclograms on: the finite elements, or the reduced model of the same machine.

#include <optional>
#include <variant>

#include "base/listener.hpp"
#include "machine/reduced_machine.hpp"

namespace driftwright::scenarios {

/// The full machine at another pose of its axes.
struct PosedMachine {
  Pose pose;
  solver::FullSystem system;
  std::optional<solver::Elasticity> elasticity;  ///< with fields
};

/// The reduced machine at another pose.
struct PosedReduced {
  Pose pose;
  solver::ReducedSystem system;
  Eigen::MatrixXd elastic;  ///< coordinates of the displacements in Travel::displacement for a reduced state, m x size
};

/// A full or reduced machine with its heat balance.
struct Model {
  std::variant<scenarios::Machine, scenarios::ReducedMachine> machine;
  effects::HeatBalance balance;
  bool was_known = false;                ///< the reduced model came from disk
  std::vector<PosedMachine> poses = {};  ///< of a full machine: the other poses of its cyclograms
  std::vector<PosedReduced> reduced_poses = {};  ///< of a reduced one

  [[nodiscard]] const scenarios::Machine* full() const { return std::get_if<scenarios::Machine>(&machine); }
  [[nodiscard]] const scenarios::ReducedMachine* reduced() const { return std::get_if<scenarios::ReducedMachine>(&machine); }
  [[nodiscard]] const mesh::Mesh& mesh() const { return full() ? full()->placed.mesh : reduced()->mesh; }
  [[nodiscard]] const solver::Outputs& outputs() const {
    return full() ? full()->system.outputs : reduced()->system.outputs;
  }
  [[nodiscard]] int n_unknowns() const { return full() ? full()->n_unknowns() : reduced()->n_unknowns; }
  /// True if coefficients and powers depend on the drive alone.
  [[nodiscard]] bool is_linear() const { return full() ? full()->system.is_linear() : reduced()->system.is_linear(); }
  /// For terminal and report: which model was run, and its distance from the full model. Without a full stop.
  [[nodiscard]] std::string words() const;
};

/// Drift predictors from the thermal modes of a model.
/// @throws InputError  when thermostats leave it without a linear model
[[nodiscard]] compensation::ModalPredictors modal_predictors(const scenarios::Scenario& scenario, const Model& model,
                                                             int n_modes, const Drive& typical);

/// Typical number of states of a reduced model [-]; building it takes as many displacement fields.
inline constexpr int kStates = 50;
/// A name of this build. Other sources, or another build of them, may compute a machine differently. Program and library of
/// one build have the same.
[[nodiscard]] std::string build_name();

/// Number of fields to be written for the longest cyclogram.
[[nodiscard]] int n_fields(const Scenario& scenario);

/// Meshes, places and factorises the machine, and reports each step to the listener.
/// @param n_fields  approximate number of whole fields to be written; each needs displacements of all nodes
/// @param drawn     mesh of build_mesh(); null: it is made
/// @param ranks     as build()
[[nodiscard]] scenarios::Machine build_machine(const scenarios::MachineModel& model, const Listener& listener, int n_fields,
                                               const mesh::Mesh* drawn = nullptr, const solver::Ranks* ranks = nullptr);

/// The reduced machine of a plan: read from disk if it is stored there, else made and stored. @param was_known receives
/// which, unless null
[[nodiscard]] scenarios::ReducedMachine open_reduced(const scenarios::MachineModel& model,
                                                     const scenarios::ReductionPlan& plan, const Listener& listener,
                                                     bool* was_known = nullptr);

/// Whether a caller of a reduced model runs it by simulate_run(), which moves axes, or holds the machine at one pose.
enum class Follows { kOnePose, kMoves };

/// The model that the scenario asks for. A reduced one is read from disk if the machine is stored for such cyclograms, else
/// it is made and stored.
/// @param cyclograms  that it will run; those of the scenario are always included in a reduced model, and in a full one if
///                    there are none here. A full one follows those that move axes
/// @param drawn       mesh of build_mesh(); null: it is made
/// @param ranks       as build(); for scenarios that require_distributable() lets pass
/// @param follows     what the caller does with a reduced model of a cyclogram that moves axes
/// @throws InputError  for a reduced model that does not follow a cyclogram that moves axes
[[nodiscard]] Model open_model(const scenarios::Scenario& scenario, const std::vector<const Cyclogram*>& cyclograms,
                               const Listener& listener, bool with_fields, const mesh::Mesh* drawn = nullptr,
                               const solver::Ranks* ranks = nullptr, Follows follows = Follows::kOnePose);

}  // namespace driftwright::scenarios
