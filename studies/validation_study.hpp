#pragma once
// The runs that strategies are fitted on and judged by: simulated in every season of a scenario's `validation`, or measured.

#include "compensation/judging/strategy_matrix.hpp"
#include "machine/model.hpp"
#include "scenarios/reader/scenario.hpp"
#include "studies/record_study.hpp"

namespace driftwright::studies {

/// Strategies on the scenario's `validation`. The simulation of its model is the truth; the model that strategies may use is off by
/// `model_scatter`. Drift counts from the start of each run.
/// @throws InputError  for effects that change readings alone, and as judge_strategies()
[[nodiscard]] compensation::StrategyMatrix validate_strategies(const scenarios::Scenario& scenario,
                                                               const scenarios::Model& model, const Listener& listener);

/// What strategies are fitted on: the training cyclograms in the first season, as instruments read them, and what is known of the machine.
struct StrategyTraining {
  std::vector<compensation::ObservedRun> runs;
  compensation::StrategySettings settings;
};
/// As validate_strategies() fits them. @throws InputError  the same
[[nodiscard]] StrategyTraining strategy_training(const scenarios::Scenario& scenario, const scenarios::Model& model);
/// A simulated record as those instruments read it. @param run  index among training runs and, behind them, those judged: which noise
[[nodiscard]] Record read_in_validation(const scenarios::Validation& validation, Record exact, std::size_t run);

/// The readings of a cyclogram in the scenario's own ambient as validate_strategies() gives them to strategies, with the noise of that very run;
/// none where it judges no such run. @param exact  as simulated
[[nodiscard]] std::optional<Record> as_judged(const scenarios::Validation& validation, const std::string& cyclogram,
                                              const Record& exact);

/// Strategies on measured records (record_study.hpp). Those with physics take part where the scenario has a machine that is linear, drift counts from the start
/// of each record, and the records say what drove it.
[[nodiscard]] compensation::StrategyMatrix validate_on_records(const scenarios::Scenario& scenario, StudyRecords records,
                                                               const Listener& listener);

/// Why a model of the machine cannot follow a measured run: nothing says what drove it, or it begins out of balance with its ambient. "" where it can.
[[nodiscard]] std::string why_no_model_follows(const scenarios::MachineModel& machine, const compensation::ObservedRun& run);

/// The model as strategies get it, off by random factors (compensation::scattered()); none where it is not a linear reduced one.
[[nodiscard]] std::optional<compensation::Physics> physics_of(const scenarios::Scenario& scenario,
                                                              const scenarios::Model& model, double scatter, int seed);

/// Whether there is any to choose from.
[[nodiscard]] bool has_thermometers(const scenarios::Study& study, const Record& record);

/// Thermometers of a record to choose from: the study's candidates, or every temperature channel but the target and `ambient`.
/// @throws InputError  when there is none
[[nodiscard]] std::vector<std::string> candidate_sensors(const scenarios::Study& study, const Record& record);

/// Those with a value in more than half of the rows of each record. @throws InputError  when there is none
[[nodiscard]] std::vector<std::string> usable_sensors(const std::vector<Record>& records,
                                                      const std::vector<std::string>& candidates);

}  // namespace driftwright::studies
