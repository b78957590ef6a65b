#include "findings/residual_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.hpp"
#include "base/shown_units.hpp"
#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

using diagnosis::MeasuredChannel;
using output::Series;

/// Sum of the squares of measured minus simulated, over the readings that exist, in units of the noise.
double squares_of(const MeasuredChannel& c, const Eigen::MatrixXd& readings, double noise) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < c.value.size(); ++i) {
    const double error = (c.value[i] - readings(c.output, i)) / noise;
    if (std::isfinite(error)) sum += error * error;
  }
  return sum;
}

bool has_all_runs(const studies::MeasuredTwin& m, const diagnosis::Prediction& readings) {
  return readings.size() == m.runs.size();
}

}  // namespace

ShownScale shown_scale(const studies::MeasuredTwin& m, const MeasuredChannel& channel) {
  if (channel.unit == "K") {
    const double reference_K = m.twin ? m.twin->reference_K() : kZeroCelsius_K;
    return {.unit = "degC", .difference_unit = "K", .scale = 1.0, .zero = reference_K - kZeroCelsius_K};
  }
  const char* unit = shown_difference_unit(channel.unit);
  return {.unit = unit, .difference_unit = unit, .scale = driftwright::shown_scale(channel.unit), .zero = 0.0};
}

std::optional<ShownChannel> clearest_channel(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                             const diagnosis::Prediction& before, const diagnosis::Prediction* after,
                                             const std::vector<std::string>& only) {
  if (!has_all_runs(m, before) || (after && !has_all_runs(m, *after))) return std::nullopt;
  const auto is_named = [&](const std::string& name) { return std::find(only.begin(), only.end(), name) != only.end(); };
  bool has_named = false;
  for (const auto& run : m.runs) {
    for (const MeasuredChannel& c : run.channels) has_named = has_named || is_named(c.name);
  }
  std::optional<ShownChannel> best;
  double most = 0.0;
  for (std::size_t r = 0; r < m.runs.size(); ++r) {
    for (std::size_t k = 0; k < m.runs[r].channels.size(); ++k) {
      const MeasuredChannel& c = m.runs[r].channels[k];
      const auto noise = d.noise.find(c.name);
      if (noise == d.noise.end() || (has_named && !is_named(c.name))) continue;
      const double gained = squares_of(c, before[r], noise->second.total()) -
                            (after ? squares_of(c, (*after)[r], noise->second.total()) : 0.0);
      if (best && !(gained > most)) continue;
      most = gained;
      best = {r, k};
    }
  }
  return best;
}

std::string channel_words(const studies::MeasuredTwin& m, const ShownChannel& shown) {
  return fmt::format("{} in {}", m.runs[shown.run].channels[shown.channel].name, m.runs[shown.run].name);
}

output::Plot channel_figure(const studies::MeasuredTwin& m, const ShownChannel& shown, std::string title,
                            const std::vector<ShownCurve>& simulated) {
  const diagnosis::MeasuredRun& run = m.runs[shown.run];
  const MeasuredChannel& c = run.channels[shown.channel];
  const ShownScale as = shown_scale(m, c);
  std::vector<double> time_min;
  for (double t_s : run.time_s) time_min.push_back(t_s / 60.0);
  const auto curve = [&](const std::string& label, const auto& values) {
    Series series{.label = label, .x = time_min, .y = {}};
    for (Eigen::Index i = 0; i < values.size(); ++i) series.y.push_back(as.zero + as.scale * values[i]);
    return series;
  };
  output::Plot plot{.title = std::move(title),
                    .x_label = "time [min]",
                    .y_label = fmt::format("{} [{}]", c.name, output::shown_unit(as.unit)),
                    .series = {curve("measured", c.value)},
                    .marks = section_marks(run.cyclogram)};
  plot.series.front().style = Series::Style::kPoints;
  plot.series.front().width = 2.6;  // wider than the curves, which are drawn over it
  for (const ShownCurve& s : simulated) plot.series.push_back(curve(s.label, (*s.readings)[shown.run].row(c.output)));
  return plot;
}

}  // namespace driftwright::findings
