#include "compensation/judging/correction.hpp"

#include <algorithm>
#include <cmath>

#include "compensation/injector/injection_run.hpp"

namespace driftwright::compensation {
namespace {

CorrectedDrift judge(const DriftToCorrect& run, const char* actuator, std::vector<double> residual_um) {
  CorrectedDrift result{.predictor = {},
                        .actuator = actuator,
                        .channel = {},
                        .residual_um = std::move(residual_um),
                        .before = score(run.drift_um),
                        .after = {},
                        .inside_tolerance = false,
                        .schedule = std::nullopt};
  result.after = score(result.residual_um);
  result.inside_tolerance =
      result.after.n == static_cast<int>(run.drift_um.size()) && result.after.peak_abs <= run.tolerance_um;
  return result;
}

}  // namespace

CorrectedDrift correct_by_injector(const DriftToCorrect& run, std::span<const double> predicted_um, double period_um) {
  const std::vector<double> inserted_um = simulate_injection(run.time_s, predicted_um, period_um).inserted_um;
  std::vector<double> residual_um;
  for (std::size_t i = 0; i < run.drift_um.size();
       ++i) {  // the correction changes at each sample, so the value just before counts, too
    const double after_um = run.drift_um[i] - inserted_um[i];
    const double before_um = run.drift_um[i] - (i == 0 ? 0.0 : inserted_um[i - 1]);
    residual_um.push_back(std::abs(before_um) > std::abs(after_um) ? before_um : after_um);
  }
  return judge(run, "pulse injector", std::move(residual_um));
}

CorrectedDrift correct_by_schedule(const DriftToCorrect& run, std::span<const double> predicted_um, double margin_um,
                                   SchedulePolicy policy, const CorrectionLimits& limits) {
  Schedule schedule = plan_cyclogram(run.time_s, predicted_um, run.boundaries_s,
                                     {.policy = policy,
                                      .tolerance_um = run.tolerance_um,
                                      .margin_um = std::min(margin_um, 0.5 * run.tolerance_um),
                                      .limits = limits});
  std::vector<double> residual_um;
  for (std::size_t i = 0; i < run.drift_um.size(); ++i) {
    residual_um.push_back(run.drift_um[i] - correction_at(schedule, run.time_s[i]));
  }
  CorrectedDrift result = judge(run, "schedule", std::move(residual_um));
  result.schedule = std::move(schedule);
  return result;
}

std::vector<double> operation_boundaries_s(std::span<const double> section_durations_s) {
  std::vector<double> boundaries_s = {0.0};
  for (double duration_s : section_durations_s) boundaries_s.push_back(boundaries_s.back() + duration_s);
  return boundaries_s;
}

}  // namespace driftwright::compensation
