#pragma once
// The linear model of a machine that strategies may use (thermal modes, fitted model, observer).

#include <optional>
#include <span>
#include <string>

#include "compensation/judging/strategies.hpp"
#include "machine/model.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

/// The model for strategies, with random factors (compensation::scattered()); none if it is not a linear reduced one.
[[nodiscard]] std::optional<compensation::Physics> physics_of(const scenarios::Scenario& scenario,
                                                              const scenarios::Model& model, double scatter, int seed);

/// What strategies may know of the machine, or the reason why nothing.
struct LinearPhysics {
  std::optional<compensation::Physics> physics;
  std::string why_none;
};
/// The same of a reduced model whose laws may follow temperatures: it is run through the training runs and linearised about
/// the states in them (solver::linearise()), and the error that this makes in the target's drift is kept.
/// @param runs  for training, with drive and ambient; @param scatter, seed  as of physics_of()
/// @throws InputError, SolveError  for a model without the study's target, and one that cannot be run
[[nodiscard]] LinearPhysics linear_physics(const scenarios::Scenario& scenario, const scenarios::Model& model,
                                           std::span<const MachineRun> runs, double scatter, int seed);

}  // namespace driftwright::studies
