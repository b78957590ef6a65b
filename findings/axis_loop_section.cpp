#include "findings/axis_loop_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace driftwright::findings {
namespace {

using compensation::AxisLoop, compensation::AxisLoopResult, compensation::ErrorStage;
using output::Bars, output::Plot, output::Series, output::Table, output::Value;

/// Plots show every n-th sample, and of the samples between these the worst.
constexpr std::size_t kMostPoints = 1500;

Series shown(const std::string& label, const AxisLoopResult& run, const std::vector<double>& values_um, double width) {
  Series series{.label = label, .width = width};
  const std::size_t step = std::max<std::size_t>(1, run.time_s.size() / kMostPoints);
  for (std::size_t i = 1; i < run.time_s.size(); i += step) {
    std::size_t worst = run.time_s.size();
    for (std::size_t j = i; j < std::min(i + step, run.time_s.size()); ++j) {
      if (run.at_rest[j] && (worst == run.time_s.size() || std::abs(values_um[j]) > std::abs(values_um[worst]))) worst = j;
    }
    if (worst == run.time_s.size()) continue;
    series.x.push_back(run.time_s[worst] / 60.0);
    series.y.push_back(values_um[worst]);
  }
  return series;
}

Bars cause_bars(const AxisLoopResult& run) {
  Bars bars{.caption = fmt::format(
                "RMS error of the tool with one cause more switched on from bar to bar: corrected by the predictor on true "
                "temperatures at every moment, then from readings, and so on; the last bar has all causes. Without "
                "correction it is "
                "{:.1f} µm. At rest, just before each renewal of the correction.",
                run.stages.front().rms_um),
            .bars = {}};
  for (std::size_t i = 1; i < run.stages.size(); ++i) {
    const ErrorStage& s = run.stages[i];
    bars.bars.push_back(
        {.label = i == 1 ? s.cause : "+ " + s.cause, .value = s.rms_um, .text = fmt::format("{:.2f} µm", s.rms_um)});
  }
  return bars;
}

Table cause_table(const AxisLoopResult& run) {
  Table table{
      .key = "switched_on_in_turn",
      .title = "Causes of error, switched on in turn",
      .caption = "The same as numbers. A cause may also take something away: its error then has the other sign.",
      .columns = {{.key = "cause", .title = "switched on"},
                  {.key = "what", .title = "what it is"},
                  {.key = "rms_um", .title = "RMS", .unit = "um", .digits = output::decimals(3)},
                  {.key = "peak_um", .title = "peak", .unit = "um", .digits = output::decimals(2)},
                  {.key = "rms_change_um", .title = "change of RMS", .unit = "um", .digits = output::signed_decimals(3)}}};
  for (std::size_t i = 0; i < run.stages.size(); ++i) {
    const ErrorStage& s = run.stages[i];
    table.rows.push_back({s.cause, s.words, s.rms_um, s.peak_um,
                          i == 0 ? output::Datum() : output::Datum(s.rms_um - run.stages[i - 1].rms_um)});
  }
  return table;
}

Plot room_plot(const AxisLoop& loop) {
  Plot plot{.title = "Correction that finds room while the axis moves", .x_label = "feed [m/min]", .y_label = "rate [µm/s]"};
  const double separation_s = loop.injector.separation_s();
  const double most_um_s = compensation::largest_feed_um_s(loop.encoder.quarter_um(), 1, separation_s);
  for (int quarters : {4, 2, 1}) {
    Series series{.label = fmt::format("{} ({:g} µm) at once",
                                       quarters == 4   ? "cycle"
                                       : quarters == 2 ? "half"
                                                       : "quarter",
                                       quarters * loop.encoder.quarter_um())};
    constexpr int kPoints = 600;
    for (int i = 1; i <= kPoints; ++i) {
      const double feed_um_s = 1.1 * most_um_s * i / kPoints;
      series.x.push_back(feed_um_s * 60e-6);
      series.y.push_back(compensation::insertion_rate_um_s(feed_um_s, loop.encoder.quarter_um(), quarters, separation_s,
                                                           loop.injector.largest_slew_um_s));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// The axis at rest after a correction by ten insertions at once: as fast as insertions may follow each other, and at the
/// slew.
Plot step_plot(const AxisLoop& loop) {
  constexpr int kInsertions = 10, kSamples = 600;
  const double step_um = kInsertions * loop.insertion_um();
  Plot plot{.title = fmt::format("A correction of {:g} µm at standstill", step_um),
            .x_label = "time [s]",
            .y_label = "axis - commanded [µm]"};
  const double end_s = 1.0 + 1.2 * step_um / loop.injector.largest_slew_um_s;
  for (bool at_once : {true, false}) {
    compensation::InjectorSettings injector = loop.injector;
    constexpr double kNoLimit_um_s = 1e6;
    if (at_once) injector.largest_slew_um_s = kNoLimit_um_s;
    compensation::InjectedAxis axis(loop.encoder, injector, loop.servo);
    axis.set_correction(static_cast<std::int64_t>(kInsertions) * loop.injector.rules.quarters);
    Series series{.label = at_once ? "all at once" : fmt::format("at {:g} µm/s, as set", injector.largest_slew_um_s)};
    for (int i = 0; i <= kSamples; ++i) {
      const double t_s = (at_once ? std::min(1.0, end_s) : end_s) * i / kSamples;
      axis.run_until(t_s);
      series.x.push_back(t_s);
      series.y.push_back(axis.position_um());
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

double largest_feed_mm_min(const AxisLoop& loop) {
  return 60e-3 * compensation::largest_feed_um_s(loop.encoder.quarter_um(), loop.injector.rules.quarters,
                                                 loop.injector.separation_s());
}

/// The faults of the axis in words; "" without faults.
std::string faults_told(const compensation::AxisFaults& faults) {
  std::string text;
  const auto add = [&](const std::string& words) { text += (text.empty() ? "" : "; ") + words; };
  if (faults.swapped) add("the encoder counts against the command, and insertion has ended");
  if (faults.n_jumps > 0) add(fmt::format("{} jumps of both lines at once", faults.n_jumps));
  if (faults.n_too_fast > 0) add(fmt::format("{} edges faster than the control counts", faults.n_too_fast));
  if (faults.n_glitches > 0)
    add(fmt::format("{} edge{} there and back within the least separation", faults.n_glitches,
                    faults.n_glitches == 1 ? "" : "s"));
  return text;
}

}  // namespace

output::Section axis_loop_section(const scenarios::AxisLoopSettings& settings, const AxisLoopResult& run,
                                  double tolerance_um, const std::vector<output::SectionMark>& marks) {
  const AxisLoop& loop = settings.loop;
  const compensation::InjectedSeries& with = run.with;
  output::Section section{.key = "axis_loop",
                          .title = fmt::format("{} through the pulse injector, edge by edge", settings.displacement)};
  add(section,
      output::Text{
          .words = fmt::format(
              "The regression corrects {} every {:g} s from readings with {:g} K of noise in steps of {:g} K, in insertions "
              "of {:g} µm; "
              "the axis has {} encoder. {} insertions; counts in {:+d}, inserted {:+d}, out {:+d} quarter steps, {} illegal "
              "transitions. A feed above {:.0f} mm/min leaves no room for an insertion between two edges.",
              settings.displacement, loop.sampling_s, loop.thermometers.noise_K, loop.thermometers.resolution_K,
              loop.insertion_um(), loop.feedback == compensation::Feedback::kMotor ? "a motor" : "a linear",
              with.n_insertions, with.encoder_quarters, with.total_quarters, with.control_quarters, with.control_jumps,
              largest_feed_mm_min(loop)),
          .detail = true});
  compensation::AxisFaults harmful = with.faults;
  harmful.n_glitches = 0;  // back and forth over one edge, as an axis at rest may move: harmless, shown as a detail
  if (const std::string words = faults_told(harmful); !words.empty())
    add(section, output::Text{.words = fmt::format("Faults of this axis: {}.", words)});
  if (with.faults.n_glitches > 0)
    add(section, output::Text{.words = fmt::format("Harmless: {}.", faults_told({.n_glitches = with.faults.n_glitches})),
                              .detail = true});
  add(section, Value{.key = "channel", .datum = settings.displacement});
  add(section, Value{.key = "predictor", .datum = "regression"});
  add(section, Value{.key = "sampling_s", .datum = loop.sampling_s});
  add(section, Value{.key = "insertion_um", .datum = loop.insertion_um()});
  add(section, Value{.key = "largest_feed_mm_min", .datum = largest_feed_mm_min(loop)});
  add(section, cause_bars(run));
  add(section, cause_table(run));
  add(section, Plot{.title = settings.displacement + " at rest, before and after (the worst between two points)",
                    .x_label = "time [min]",
                    .y_label = settings.displacement + " [µm]",
                    .series = {shown("before", run, run.before_um, 3.0), shown("after", run, run.after_um, 1.5)},
                    .bands = {{fmt::format("tolerance ±{:g} µm", tolerance_um), -tolerance_um, tolerance_um}},
                    .marks = marks});
  for (Plot plot : {step_plot(loop), room_plot(loop)}) {
    plot.half_width = true;
    add(section, std::move(plot));
  }
  for (const auto& [key, count] : {std::pair<const char*, output::Datum>{"counts.encoder_quarters", with.encoder_quarters},
                                   {"counts.inserted_quarters", with.total_quarters},
                                   {"counts.control_quarters", with.control_quarters},
                                   {"counts.waiting_quarters", with.waiting_quarters},
                                   {"counts.insertions", with.n_insertions},
                                   {"counts.illegal_transitions", with.control_jumps},
                                   {"faults.jumps", with.faults.n_jumps},
                                   {"faults.too_fast", with.faults.n_too_fast},
                                   {"faults.glitches", with.faults.n_glitches},
                                   {"faults.swapped", with.faults.swapped}})
    add(section, Value{.key = key, .datum = count});
  return section;
}

}  // namespace driftwright::findings
