#include "studies/warm_up_corrected.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "compensation/judging/strategy_matrix.hpp"
#include "studies/validation_study.hpp"

namespace driftwright::studies {
namespace {

constexpr int kCorrectedTimes = 12;   // number of warm-ups, from none to the longest
constexpr int kHalvings = 4;          // bisections between two of them
constexpr std::size_t kNoise = 1000;  // index of the readings' noise, which no run of the validation has

/// Warm-up and job as thermometers read them, with the true drift. The warm-up is corrected like the job, so it is no
/// lead-in.
struct ReadJob {
  MachineRun run;
  std::size_t first_row = 0;  ///< of the job
};

ReadJob read_job(const scenarios::Validation& validation, const WarmUpTrials& trials, double speed_rpm, double time_s) {
  ReadJob read;
  std::vector<Cyclogram::Section> sections;
  if (time_s >= 1.0) sections.push_back({std::round(time_s), {.speed_rpm = speed_rpm}});
  read.run = trials.whole_run(sections, read.first_row);
  read.run.readings = read_in_validation(validation, std::move(read.run.readings), kNoise);
  return read;
}

/// The peak of the corrected drift; the tool is set at the job's first row, with the correction in force at that moment.
double peak_left_um(const compensation::DeployedPredictor& strategy, const ReadJob& read) {
  const std::vector<double>& of_target = read.run.readings.at(strategy.target).values;
  std::vector<double> drift_um;
  for (double value_um : of_target) drift_um.push_back(value_um - of_target.front());
  const std::vector<double> left_um = compensation::judge(strategy, read.run, drift_um).left_um;
  double peak_um = 0.0;
  for (std::size_t i = read.first_row; i < left_um.size(); ++i)
    peak_um = std::max(peak_um, std::abs(left_um[i] - left_um[read.first_row]));
  return peak_um;
}

}  // namespace

std::optional<CorrectedWarmUps> corrected_warm_ups(const scenarios::Scenario& scenario, const WarmUpTrials& trials,
                                                   double speed_rpm, double longest_s, double tolerance_um,
                                                   const Listener& listener) {
  if (!scenario.validation || !scenario.study || effects::has_reading_effects(scenario.machine->effects))
    return std::nullopt;
  const scenarios::Validation& validation = *scenario.validation;
  listener.begin("fitting strategies");
  const StrategyTraining training = strategy_training(scenario, *trials.ahead().model);
  std::vector<compensation::DeployedPredictor> strategies =
      compensation::fit_strategies(training.settings, training.runs).strategies;
  std::erase_if(strategies, [](const auto& s) { return s.is_baseline && s.name != compensation::kNoCorrection; });

  CorrectedWarmUps result{
      .target = scenario.study->target, .speed_rpm = speed_rpm, .model_scatter = validation.model_scatter};
  for (int i = 0; i <= kCorrectedTimes; ++i) result.times_s.push_back(longest_s * i / kCorrectedTimes);
  if (const auto& physics = training.settings.physics; physics && physics->linearised)
    result.model = compensation::words_of(*physics->linearised);
  std::vector<ReadJob> runs(result.times_s.size());
  listener.begin("warm-up beside correction");
  parallel_for(runs.size(), [&](std::size_t i) { runs[i] = read_job(validation, trials, speed_rpm, result.times_s[i]); });
  result.strategies.resize(strategies.size());
  parallel_for(
      strategies.size(),
      [&](std::size_t s) {
        CorrectedWarmUp& of = result.strategies[s];
        of.strategy = strategies[s].name;
        for (const ReadJob& run : runs) of.left_um.push_back(peak_left_um(strategies[s], run));
        const auto first = std::find_if(of.left_um.begin(), of.left_um.end(), [&](double um) { return um <= tolerance_um; });
        of.is_enough = first != of.left_um.end();
        if (!of.is_enough) return;
        const auto at = static_cast<std::size_t>(first - of.left_um.begin());
        of.least_s = result.times_s[at];
        double low_s = at > 0 ? result.times_s[at - 1] : of.least_s;
        for (int i = 0; i < kHalvings && at > 0; ++i) {
          const double time_s = 0.5 * (low_s + of.least_s);
          (peak_left_um(strategies[s], read_job(validation, trials, speed_rpm, time_s)) <= tolerance_um ? of.least_s
                                                                                                        : low_s) = time_s;
        }
      },
      {.on_begin = {}, .on_share = listener.on_share, .wants_end_now = {}});
  return result;
}

}  // namespace driftwright::studies
