#pragma once
// What a verb runs cyclograms on: the finite elements, or the reduced model of the same machine.

#include <optional>
#include <variant>

#include "base/listener.hpp"
#include "machine/reduced_machine.hpp"

namespace driftwright::scenarios {

struct Model {
  std::variant<scenarios::Machine, scenarios::ReducedMachine> machine;
  effects::HeatBalance balance;
  bool was_known = false;  ///< the reduced model came from disk

  [[nodiscard]] const scenarios::Machine* full() const { return std::get_if<scenarios::Machine>(&machine); }
  [[nodiscard]] const scenarios::ReducedMachine* reduced() const { return std::get_if<scenarios::ReducedMachine>(&machine); }
  [[nodiscard]] const mesh::Mesh& mesh() const { return full() ? full()->placed.mesh : reduced()->mesh; }
  [[nodiscard]] const solver::Outputs& outputs() const {
    return full() ? full()->system.outputs : reduced()->system.outputs;
  }
  [[nodiscard]] int n_unknowns() const { return full() ? full()->system.size() : reduced()->n_unknowns; }
  /// True where coefficients and powers follow from the drive alone.
  [[nodiscard]] bool is_linear() const { return full() ? full()->system.is_linear() : reduced()->system.is_linear(); }
  /// For terminal and report: what was run, and how far it is from the full model. Ends without a full stop.
  [[nodiscard]] std::string words() const;
};

/// Drift from the thermal modes of a model.
/// @throws InputError  when thermostats leave it without a linear model
[[nodiscard]] compensation::ModalPredictors modal_predictors(const scenarios::Scenario& scenario, const Model& model,
                                                             int n_modes, const Drive& typical);

/// States that a reduced model will about have: as many displacement fields.
inline constexpr int kStates = 50;
/// How many fields are written of the longest cyclogram.
[[nodiscard]] int n_fields(const Scenario& scenario);

/// Meshes, places and factorises, saying so.
/// @param n_fields  about how many whole fields are to be written, which takes displacements everywhere
[[nodiscard]] scenarios::Machine build_machine(const scenarios::MachineModel& model, const Listener& listener, int n_fields);

/// The reduced machine of a plan, from disk where it is known, else made and kept. @param was_known  unless null, which it was
[[nodiscard]] scenarios::ReducedMachine open_reduced(const scenarios::MachineModel& model,
                                                     const scenarios::ReductionPlan& plan, const Listener& listener,
                                                     bool* was_known = nullptr);

/// The model that the scenario asks for. A reduced one comes from disk where the machine is known for such cyclograms, else it is
/// made and kept.
/// @param cyclograms  that it will be asked; those of the scenario are always among them
[[nodiscard]] Model open_model(const scenarios::Scenario& scenario, const std::vector<const Cyclogram*>& cyclograms,
                               const Listener& listener, bool with_fields);

}  // namespace driftwright::scenarios
