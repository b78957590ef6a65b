#include "app/axis_loop_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace driftwright::app {
namespace {

using compensation::AxisLoop;
using compensation::AxisLoopRun;
using compensation::ErrorStage;
using output::Bars;
using output::Paragraph;
using output::Plot;
using output::Series;
using output::Table;

/// The pictures show every so manieth sample, and of those between the worst.
constexpr std::size_t kMostPoints = 1500;

Series shown(const std::string& label, const AxisLoopRun& run, const std::vector<double>& values_um, double width) {
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

Bars cause_bars(const AxisLoopRun& run) {
  Bars bars{.caption = fmt::format(
                "RMS error of the tool with one cause more switched on from bar to bar: corrected by the predictor on true "
                "temperatures at every moment, then from readings, and so on; the last bar has all causes. Without "
                "correction it is "
                "{:.1f} um. At rest, just before each renewal of the correction.",
                run.stages.front().rms_um),
            .bars = {}};
  for (std::size_t i = 1; i < run.stages.size(); ++i) {
    const ErrorStage& s = run.stages[i];
    bars.bars.push_back(
        {.label = i == 1 ? s.cause : "+ " + s.cause, .value = s.rms_um, .text = fmt::format("{:.2f} um", s.rms_um)});
  }
  return bars;
}

Table cause_table(const AxisLoopRun& run) {
  Table table{.caption = "The same as numbers. A cause may also take something away: its error then has the other sign.",
              .headers = {"switched on", "what it is", "RMS [um]", "peak [um]", "change of RMS [um]"},
              .rows = {}};
  for (std::size_t i = 0; i < run.stages.size(); ++i) {
    const ErrorStage& s = run.stages[i];
    table.rows.push_back({s.cause, s.words, fmt::format("{:.3f}", s.rms_um), fmt::format("{:.2f}", s.peak_um),
                          i == 0 ? "" : fmt::format("{:+.3f}", s.rms_um - run.stages[i - 1].rms_um)});
  }
  return table;
}

Plot room_plot(const AxisLoop& loop) {
  Plot plot{.title = "Correction that finds room while the axis moves",
            .x_label = "feed [m/min]",
            .y_label = "rate [um/s]",
            .series = {}};
  const double separation_s = loop.injector.separation_s();
  const double most_um_s = compensation::largest_feed_um_s(loop.encoder.quarter_um(), 1, separation_s);
  for (int quarters : {4, 2, 1}) {
    Series series{.label = fmt::format("{} ({:g} um) at once",
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

/// The axis at standstill after a correction by ten insertions at once: as fast as they may follow each other, and at the slew.
Plot step_plot(const AxisLoop& loop) {
  constexpr int kInsertions = 10, kSamples = 600;
  const double step_um = kInsertions * loop.insertion_um();
  Plot plot{.title = fmt::format("A correction of {:g} um at standstill", step_um),
            .x_label = "time [s]",
            .y_label = "axis - commanded [um]",
            .series = {}};
  const double end_s = 1.0 + 1.2 * step_um / loop.injector.largest_slew_um_s;
  for (bool at_once : {true, false}) {
    compensation::InjectorSettings injector = loop.injector;
    constexpr double kNoLimit_um_s = 1e6;
    if (at_once) injector.largest_slew_um_s = kNoLimit_um_s;
    compensation::InjectedAxis axis(loop.encoder, injector, loop.servo);
    axis.set_correction(static_cast<std::int64_t>(kInsertions) * loop.injector.rules.quarters);
    Series series{.label = at_once ? "all at once" : fmt::format("at {:g} um/s, as set", injector.largest_slew_um_s)};
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

/// What the axis met, or nothing where it was sound.
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

void add_axis_loop(output::Report& report, const scenarios::AxisLoopSettings& settings, const AxisLoopRun& run,
                   double tolerance_um, const std::vector<output::SectionMark>& marks) {
  const auto add = [&](auto block) { report.blocks.emplace_back(std::move(block)); };
  const AxisLoop& loop = settings.loop;
  add(output::Heading{fmt::format("{} through the pulse injector, edge by edge", settings.displacement)});
  const std::string faults = faults_told(run.with.faults);
  add(Paragraph{fmt::format(
      "The regression corrects {} every {:g} s from readings with {:g} K of noise in steps of {:g} K, in insertions of {:g} "
      "um; the "
      "axis has {} encoder. {} insertions; counts in {:+d}, inserted {:+d}, out {:+d} quarter steps, {} illegal "
      "transitions. A feed "
      "above {:.0f} mm/min leaves no room for an insertion between two edges.{}",
      settings.displacement, loop.sampling_s, loop.thermometers.noise_K, loop.thermometers.resolution_K, loop.insertion_um(),
      loop.feedback == compensation::Feedback::kMotor ? "a motor" : "a linear", run.with.n_insertions,
      run.with.encoder_quarters, run.with.total_quarters, run.with.control_quarters, run.with.control_jumps,
      largest_feed_mm_min(loop), faults.empty() ? "" : fmt::format(" Faults: {}.", faults))});
  add(cause_bars(run));
  add(cause_table(run));
  add(Plot{.title = settings.displacement + " at rest, before and after (the worst between two points)",
           .x_label = "time [min]",
           .y_label = settings.displacement + " [um]",
           .series = {shown("before", run, run.before_um, 3.0), shown("after", run, run.after_um, 1.5)},
           .bands = {{fmt::format("tolerance ±{:g} um", tolerance_um), -tolerance_um, tolerance_um}},
           .marks = marks});
  for (Plot plot : {step_plot(loop), room_plot(loop)}) {
    plot.half_width = true;
    add(std::move(plot));
  }
}

std::string axis_loop_line(const scenarios::AxisLoopSettings& settings, const AxisLoopRun& run) {
  std::string causes;
  for (std::size_t i = 1; i < run.stages.size(); ++i)
    causes += fmt::format("{}{} {:.2f}", i == 1 ? "" : ", + ", run.stages[i].cause, run.stages[i].rms_um);
  compensation::AxisFaults told = run.with.faults;
  told.n_glitches = 0;  // there and back over one edge, as an axis that rests on it may go: harmless, and in the report
  const std::string faults = faults_told(told);
  return fmt::format("  edge by edge, regression by injector: {} {:.2f} um RMS before, after with {} um\n{}",
                     settings.displacement, run.stages.front().rms_um, causes,
                     faults.empty() ? "" : fmt::format("    faults of this axis: {}\n", faults));
}

nlohmann::ordered_json axis_loop_json(const scenarios::AxisLoopSettings& settings, const AxisLoopRun& run) {
  nlohmann::ordered_json j = {{"channel", settings.displacement},
                              {"predictor", "regression"},
                              {"sampling_s", settings.loop.sampling_s},
                              {"insertion_um", settings.loop.insertion_um()},
                              {"largest_feed_mm_min", largest_feed_mm_min(settings.loop)},
                              {"switched_on_in_turn", nlohmann::ordered_json::array()}};
  for (const ErrorStage& s : run.stages)
    j["switched_on_in_turn"].push_back(
        {{"cause", s.cause}, {"what", s.words}, {"rms_um", s.rms_um}, {"peak_um", s.peak_um}});
  const compensation::InjectedSeries& with = run.with;
  j["counts"] = {{"encoder_quarters", with.encoder_quarters}, {"inserted_quarters", with.total_quarters},
                 {"control_quarters", with.control_quarters}, {"waiting_quarters", with.waiting_quarters},
                 {"insertions", with.n_insertions},           {"illegal_transitions", with.control_jumps}};
  j["faults"] = {{"jumps", with.faults.n_jumps},
                 {"too_fast", with.faults.n_too_fast},
                 {"glitches", with.faults.n_glitches},
                 {"swapped", with.faults.swapped}};
  return j;
}

}  // namespace driftwright::app
