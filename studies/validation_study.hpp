#pragma once
// The runs on which strategies are fitted and judged: simulated in every season of a scenario's `validation`, or
// measured.

#include <functional>

#include "compensation/judging/strategy_matrix.hpp"
#include "compensation/judging/travel.hpp"
#include "machine/model.hpp"
#include "scenarios/reader/scenario.hpp"
#include "studies/record_study.hpp"

namespace driftwright::studies {

/// Judges strategies on the scenario's `validation`. The simulation of its model is the truth; the model that strategies
/// may use is scattered by `model_scatter`. Drift counts from the start of each run.
/// @throws InputError  for effects that change readings only, and as judge_strategies()
[[nodiscard]] compensation::StrategyMatrix validate_strategies(const scenarios::Scenario& scenario,
                                                               const scenarios::Model& model,
                                                               const std::optional<compensation::Probing>& probing,
                                                               const Listener& listener);

/// The data that strategies are fitted on: the training cyclograms in the first season, as instruments read them, and
/// what is known about the machine.
struct StrategyTraining {
  std::vector<MachineRun> runs;
  compensation::StrategySettings settings;
};
/// The training data of validate_strategies(). @throws InputError  the same
[[nodiscard]] StrategyTraining strategy_training(const scenarios::Scenario& scenario, const scenarios::Model& model);
/// A simulated record as those instruments read it. @param run  index among the training runs followed by the judged
/// ones; it selects the noise
[[nodiscard]] Record read_in_validation(const scenarios::Validation& validation, Record exact, std::size_t run);

/// The readings of a cyclogram in the scenario's own ambient exactly as validate_strategies() gives them to strategies,
/// with the noise of that run; none if it judges no such run. @param exact  as simulated
[[nodiscard]] std::optional<Record> as_judged(const scenarios::Validation& validation, const std::string& cyclogram,
                                              const Record& exact);

/// Judges strategies on measured records (record_study.hpp). Strategies with physics take part if the scenario has a
/// machine that can be made linear (linear_physics.hpp), drift counts from the start of each record, and the records contain
/// the drive.
[[nodiscard]] compensation::StrategyMatrix validate_on_records(const scenarios::Scenario& scenario, StudyRecords records,
                                                               const std::optional<compensation::Probing>& probing,
                                                               const Listener& listener);

/// Strategies judged for several places of a screw, by rising position, and along its travel.
struct JudgedTravel {
  std::vector<compensation::StrategyMatrix> places;
  compensation::Travel travel;
};
/// Judges for each place, then along the travel: at all places of the target's entry in the machine that the judged runs
/// have read.
/// @param places  two or more of scenarios::places_along()
/// @param judge   for a scenario whose study has one of them as its target
[[nodiscard]] JudgedTravel judge_places(
    scenarios::Scenario scenario, const std::vector<scenarios::DisplacementOutput>& places,
    const std::function<compensation::StrategyMatrix(const scenarios::Scenario&)>& judge);

/// The reason why a model of the machine cannot follow a measured run: its drive is unknown, or it begins out of balance
/// with its ambient. "" if it can.
[[nodiscard]] std::string why_no_model_follows(const scenarios::MachineModel& machine, const MachineRun& run);

/// Whether there are thermometers to choose from.
[[nodiscard]] bool has_thermometers(const scenarios::Study& study, const Record& record);

/// The thermometers of a record to choose from: the study's candidates, or every temperature channel except the target
/// and `ambient`.
/// @throws InputError  when there is none
[[nodiscard]] std::vector<std::string> candidate_sensors(const scenarios::Study& study, const Record& record);

/// The candidates with a value in more than half of the rows of each record. @throws InputError  when there is none
[[nodiscard]] std::vector<std::string> usable_sensors(const std::vector<Record>& records,
                                                      const std::vector<std::string>& candidates);

}  // namespace driftwright::studies
