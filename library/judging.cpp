#include "driftwright/judging.hpp"

#include "studies/record_study.hpp"
#include "studies/validation_study.hpp"

namespace driftwright {

std::vector<JudgedStrategy> judge(const std::string& scenario_file, const std::vector<std::string>& train,
                                  const std::vector<std::string>& test, const Listener& listener) {
  const scenarios::Scenario scenario = scenarios::read_scenario(scenario_file);
  (void)scenarios::require_study(scenario, "judge");
  if (train.empty() || test.empty()) throw InputError("judge: records to train on and records to test on are both required");
  const compensation::StrategyMatrix matrix =
      studies::validate_on_records(scenario, studies::read_records(scenario, {.train = train, .test = test}), {}, listener);
  std::vector<JudgedStrategy> strategies;
  for (const compensation::JudgedStrategy& s : matrix.strategies) {
    JudgedStrategy& plain = strategies.emplace_back();
    plain.name = s.fitted.name;
    plain.is_baseline = s.fitted.is_baseline;
    plain.why = s.why;
    plain.verdict = compensation::word(s.safety);
    for (const compensation::Case& c : s.cases) {
      plain.cases.push_back({.record = matrix.runs.at(c.run).name,
                             .failed = c.failed,
                             .rms_before_um = c.before.rmse,
                             .peak_before_um = c.before.peak_abs,
                             .rms_left_um = c.after.rmse,
                             .peak_left_um = c.after.peak_abs});
    }
  }
  return strategies;
}

}  // namespace driftwright
