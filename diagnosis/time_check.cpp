#include "diagnosis/time_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/errors.hpp"
#include "base/median.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kMet = 0.3;          // of the course of the readings: what the twin leaves of them where it is about right
constexpr double kTimesBetter = 3.0;  // than with the times as recorded
constexpr double kAsWell = 1.5;       // of a smaller factor: what a machine does that is merely slower

MeasuredRun with_times(MeasuredRun run, double factor) {
  for (double& t : run.time_s) t *= factor;
  if (run.has_ambient) {  // else it is the scenario's, by its own clock
    for (double& t : run.ambient.time_s) t *= factor;
  }
  for (Cyclogram::Section& s : run.cyclogram.sections) s.duration_s *= factor;
  for (Cyclogram::Column& c : run.cyclogram.columns) {
    for (double& t : c.rows.time_s) t *= factor;
  }
  set_grid(run);
  return run;
}

/// What the twin leaves of the readings' course, constant offsets aside: the median over the channels. 1 where it has no
/// solution.
double left_of_course(const MeasuredRun& run, const Twin& twin, Twin::Workspace& workspace) {
  Eigen::MatrixXd prediction;
  if (!has_solution([&] { prediction = twin.readings(twin.as_written(), run, workspace); })) return 1.0;
  std::vector<double> shares;
  for (const MeasuredChannel& c : run.channels) {
    const Eigen::ArrayXd there = (c.value.array() == c.value.array()).cast<double>();
    const auto deviation = [&](Eigen::ArrayXd x) {
      x = (there > 0.0).select(x, 0.0);
      const double mean = x.sum() / there.sum();
      return std::sqrt(((x - mean) * there).square().sum());
    };
    const double course = deviation(c.value.array());
    if (course > 0.0) shares.push_back(deviation(c.value.array() - prediction.row(c.output).transpose().array()) / course);
  }
  return upper_median(std::move(shares));
}

}  // namespace

void require_plausible_times(const std::vector<MeasuredRun>& runs, const Twin& twin) {
  Twin::Workspace workspace(twin);
  for (const MeasuredRun& run : runs) {
    const double as_recorded = left_of_course(run, twin, workspace);
    if (as_recorded < kMet) continue;
    for (const double factor : {1.0 / 60.0, 60.0}) {
      const double otherwise = left_of_course(with_times(run, factor), twin, workspace);
      if (!(otherwise < kMet && kTimesBetter * otherwise < as_recorded)) continue;
      // A machine that is merely faster or slower than the scenario is met as well, or better, by a smaller factor.
      const auto is_met_between = [&](double between) {
        return left_of_course(with_times(run, std::pow(factor, between)), twin, workspace) < kAsWell * otherwise;
      };
      if (is_met_between(0.5) || is_met_between(0.75)) continue;
      throw InputError(fmt::format(
          "{}: the times look {} times too {}: with the times as recorded the scenario leaves {:.0f} % of the course of the "
          "readings, with times {} as long {:.0f} %; does the time's header (time_s, time_min, time_h) say what its numbers "
          "are?",
          run.path, 60, factor < 1.0 ? "long" : "short", 100.0 * as_recorded, factor < 1.0 ? "a sixtieth" : "60 times",
          100.0 * otherwise));
    }
  }
}

}  // namespace driftwright::diagnosis
