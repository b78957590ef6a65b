#include "compensation/injector/axis_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

/// The start times of passes, and whether a pass is under way at a time.
struct Passes {
  AxisMotion motion;

  [[nodiscard]] bool moves() const { return motion.stroke_um > 0.0; }
  [[nodiscard]] double start_s(std::int64_t pass) const { return (static_cast<double>(pass) + 0.5) * motion.every_s; }
  [[nodiscard]] bool at_rest(double t_s) const {
    if (!moves()) return true;
    const double since_s = t_s - start_s(static_cast<std::int64_t>(std::floor(t_s / motion.every_s - 0.5)));
    return since_s > motion.busy_s();
  }
};

ErrorStage stage(std::string cause, std::string words, const std::vector<double>& error_um,
                 const std::vector<bool>& counts) {
  ErrorStage s{.cause = std::move(cause), .words = std::move(words)};
  double sum = 0.0;
  int n = 0;
  for (std::size_t i = 1; i < error_um.size(); ++i) {  // no correction is in force at the first sample yet
    if (!counts[i]) continue;
    sum += error_um[i] * error_um[i];
    s.peak_um = std::max(s.peak_um, std::abs(error_um[i]));
    ++n;
  }
  if (n == 0)
    throw InputError(
        "the axis is at rest at no sample but the first: no error could be looked at; let it rest between passes");
  s.rms_um = std::sqrt(sum / n);
  return s;
}

std::vector<double> minus(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

/// Just before each sample the previous value is in force.
std::vector<double> one_sample_late(const std::vector<double>& values) {
  std::vector<double> late(values.size(), 0.0);
  std::copy(values.begin(), values.end() - 1, late.begin() + 1);
  return late;
}

std::vector<double> in_insertions(const AxisLoop& loop, const std::vector<double>& wish_um) {
  CountConverter converter(loop.insertion_um(), loop.hysteresis_um);
  std::vector<double> given_um;
  for (double wish : wish_um) given_um.push_back(static_cast<double>(converter.insertions(wish)) * loop.insertion_um());
  return given_um;
}

/// The values limited by the largest slew, just before each time.
std::vector<double> slewed(const std::vector<double>& time_s, const std::vector<double>& wish_um, double slew_um_s) {
  std::vector<double> in_um(wish_um.size(), 0.0);
  for (std::size_t i = 1; i < wish_um.size(); ++i) {
    const double most_um = slew_um_s * (time_s[i] - time_s[i - 1]);
    in_um[i] = in_um[i - 1] + std::clamp(wish_um[i - 1] - in_um[i - 1], -most_um, most_um);
  }
  return in_um;
}

std::vector<double> growth_um(const AxisLoop& loop, const Record& record) {
  std::vector<double> growth(record.n_samples(), 0.0);
  if (loop.growing_channel.empty()) return growth;
  const std::vector<double>& temperature = record.at(loop.growing_channel).values;
  for (std::size_t i = 0; i < growth.size(); ++i) {
    const double strain = loop.expansion_1_K * (temperature[i] - temperature.front());
    const AxisStrain strains =
        loop.growing_part == GrowingPart::kScrew ? AxisStrain{.screw = strain} : AxisStrain{.scale = strain};
    growth[i] = unseen_um(loop.feedback, strains, loop.at_um);
  }
  return growth;
}

std::vector<double> kept_where_missing(std::vector<double> values) {
  double last = 0.0;
  for (double& v : values) {
    if (std::isfinite(v)) last = v;
    v = last;
  }
  return values;
}

}  // namespace

std::int64_t CountConverter::insertions(double wish_um) {
  if (!std::isfinite(wish_um)) return given_;
  const double rest_um = wish_um - static_cast<double>(given_) * insertion_um_;
  if (std::abs(rest_um) > 0.5 * insertion_um_ + hysteresis_um_) given_ += std::llround(rest_um / insertion_um_);
  return given_;
}

void require_ledger(const InjectedSeries& s) {
  if (s.control_quarters != s.encoder_quarters + s.total_quarters - s.waiting_quarters)
    throw std::logic_error(fmt::format("counts in {} + inserted {} - waiting {} are not counts out {}", s.encoder_quarters,
                                       s.total_quarters, s.waiting_quarters, s.control_quarters));
}

InjectedSeries drive_axis(const AxisLoop& loop, std::span<const double> time_s, std::span<const double> correction_um) {
  if (time_s.size() != correction_um.size())
    throw InputError(fmt::format("{} times but {} corrections", time_s.size(), correction_um.size()));
  InjectedAxis axis(loop.encoder, loop.injector, loop.servo);
  CountConverter converter(loop.insertion_um(), loop.hysteresis_um);
  const Passes passes{loop.motion};
  InjectedSeries series;
  std::int64_t pass = 0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double t_s = time_s[i] - time_s.front();
    for (; passes.moves() && passes.start_s(pass) <= t_s; ++pass) {
      axis.run_until(passes.start_s(pass));
      axis.command(pass % 2 == 0 ? loop.motion.stroke_um : 0.0, loop.motion.feed_um_s);
    }
    axis.run_until(t_s);
    series.axis_um.push_back(axis.position_um() - axis.commanded_um());
    series.at_rest.push_back(passes.at_rest(t_s));
    series.inserted_quarters.push_back(axis.injector().inserted());
    axis.set_correction(converter.insertions(correction_um[i]) * loop.injector.rules.quarters);
  }
  series.encoder_quarters = axis.injector().encoder().count();
  series.control_quarters = axis.control_quarters();
  series.total_quarters = axis.injector().inserted();
  series.waiting_quarters = axis.injector().waiting();
  series.n_insertions = axis.injector().n_insertions();
  series.control_jumps = axis.control_jumps();
  series.faults = axis.faults();
  require_ledger(series);
  return series;
}

AxisLoopResult run_axis_loop(const AxisLoop& loop, const Record& truth, const std::string& channel,
                             const PredictedFromReadings& predicted) {
  const Record exact = sampled(truth, loop.sampling_s);
  AxisLoopResult run;
  run.time_s = exact.time_s;
  const std::vector<double> drift_um = exact.at(channel).values;
  const std::vector<double> growth = growth_um(loop, exact);
  std::vector<double> error_um(drift_um.size());
  for (std::size_t i = 0; i < error_um.size(); ++i) {
    error_um[i] = drift_um[i] + growth[i];
    if (!std::isfinite(error_um[i])) throw InputError(fmt::format("'{}' is missing at {} s", channel, exact.time_s[i]));
  }
  const std::vector<double> ideal_um = kept_where_missing(predicted(exact));
  run.predicted_um = predicted(as_read(exact, loop.thermometers, loop.seed));
  const std::vector<double> read_um = kept_where_missing(run.predicted_um);
  const std::vector<double> counted_um = in_insertions(loop, read_um);

  const std::vector<double> still(error_um.size(), 0.0);
  run.before_um = error_um;
  const InjectedSeries without = drive_axis(loop, run.time_s, still);
  run.with = drive_axis(loop, run.time_s, run.predicted_um);
  for (std::size_t i = 0; i < error_um.size(); ++i) run.before_um[i] += without.axis_um[i];
  run.after_um = error_um;
  for (std::size_t i = 0; i < error_um.size(); ++i) {
    run.after_um[i] += run.with.axis_um[i];
    run.inserted_um.push_back(static_cast<double>(run.with.inserted_quarters[i]) * loop.encoder.quarter_um());
  }
  run.at_rest = run.with.at_rest;

  const auto add = [&](const char* cause, std::string words, const std::vector<double>& error) {
    run.stages.push_back(stage(cause, std::move(words), error, run.at_rest));
  };
  add("none", "no correction", run.before_um);
  add("model", "predictor on true temperatures", minus(error_um, ideal_um));
  add("thermometers", fmt::format("noise {:g} K, steps {:g} K", loop.thermometers.noise_K, loop.thermometers.resolution_K),
      minus(error_um, read_um));
  add("sampling", fmt::format("each correction holds for {:g} s", loop.sampling_s),
      minus(error_um, one_sample_late(read_um)));
  add("resolution", fmt::format("whole insertions of {:g} um, hysteresis {:g} um", loop.insertion_um(), loop.hysteresis_um),
      minus(error_um, one_sample_late(counted_um)));
  add("rate limit", fmt::format("at most {:g} um/s", loop.injector.largest_slew_um_s),
      minus(error_um, slewed(run.time_s, counted_um, loop.injector.largest_slew_um_s)));
  add("axis", "edges, waiting for low lines, counter and servo", run.after_um);
  return run;
}

}  // namespace driftwright::compensation
