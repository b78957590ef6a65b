#include "app/diagnosis_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <set>

#include "app/diagnosis_summary.hpp"
#include "app/measured_iso230_3.hpp"
#include "app/residual_report.hpp"

namespace driftwright::app {
namespace {

using output::Bars;
using output::Heading;
using output::Paragraph;
using output::Plot;
using output::Preformatted;
using output::Table;

using Blocks = std::vector<output::ReportBlock>;

output::Verdict verdict_box(const diagnosis::Diagnosis& d) {
  using diagnosis::Verdict;
  const auto kind = d.verdict == Verdict::kConsistent    ? output::Verdict::Kind::kGood
                    : d.verdict == Verdict::kUnexplained ? output::Verdict::Kind::kBad
                                                         : output::Verdict::Kind::kNeutral;
  static const std::map<Verdict, const char*> titles = {{Verdict::kConsistent, "Consistent with the scenario"},
                                                        {Verdict::kSuspected, "A cause is suspected"},
                                                        {Verdict::kNamed, "Causes named"},
                                                        {Verdict::kAmbiguous, "Ambiguous: several causes would do"},
                                                        {Verdict::kUnexplained, "Something is left unexplained"},
                                                        {Verdict::kInsufficientData, "Too few data for a verdict"}};
  return {kind, titles.at(d.verdict), d.reason};
}

void add_causes(const diagnosis::Diagnosis& d, Blocks& blocks) {
  for (std::size_t i = 0; i < d.causes.size(); ++i) {
    const diagnosis::Cause& c = d.causes[i];
    blocks.emplace_back(
        Heading{fmt::format("Cause {}, {}: {} at {}", i + 1, diagnosis::word(c.standing), c.effect, c.where)});
    if (!c.doubt.empty() || !c.is_written)
      blocks.emplace_back(
          Paragraph{fmt::format("{}{}", c.doubt.empty() ? "" : "Only suspected, since " + c.doubt + ". ",
                                c.is_written ? ""
                                             : fmt::format("It is not written into extended.yaml: {}.",
                                                           d.written.why_nothing.empty()
                                                               ? "rows that were kept out are predicted better without it"
                                                               : d.written.why_nothing))});
    if (c.n_searched > 0)
      blocks.emplace_back(Paragraph{
          fmt::format("The search was made again {} without a part of the rows; it found this effect at this place {}.",
                      c.n_searched == 1 ? "once" : fmt::format("{} times", c.n_searched),
                      c.n_again == 0              ? "in none of them"
                      : c.n_again == c.n_searched ? "each time"
                                                  : fmt::format("{} of them", c.n_again))});
    Table table{
        .caption = c.alternatives.empty()
                       ? "Gain: logarithm of how much more probable the data are with it than without, after the "
                         "price of having looked for it among all candidates. No other claim comes within 3 nats."
                       : "The first line is the best; the data cannot tell it from the others (less than 3 nats apart).",
        .headers = {"effect", "where", "law", "numbers (95 % interval)", "gain [nats]"},
        .rows = {}};
    const auto add = [&](const diagnosis::Cause& x) {
      table.rows.push_back({x.effect, x.where, x.law, parameters_text(x), fmt::format("{:.1f}", x.log_evidence_gain)});
    };
    add(c);
    for (const diagnosis::Cause& a : c.alternatives) add(a);
    blocks.emplace_back(table);
  }
}

void add_experiment(const diagnosis::Experiment& e, Blocks& blocks) {
  blocks.emplace_back(Heading{"Experiment that would tell them apart"});
  blocks.emplace_back(Paragraph{e.why});
  blocks.emplace_back(Paragraph{fmt::format(
      "Cyclogram {}: {}. Any two of the explanations would then differ by {:.1f} sigmas or more, what is not known of their "
      "numbers taken off.",
      e.cyclogram.name, sections_text(e.cyclogram), e.discrimination)});
  if (e.extra_sensor) {
    blocks.emplace_back(
        Paragraph{fmt::format("With a further thermometer on {}: {:.1f} sigmas; they differ there by up to {:.2g} K.",
                              e.extra_sensor->region, e.extra_sensor->discrimination, e.extra_sensor->difference_K)});
  }
}

void add_unexplained(const diagnosis::Unexplained& u, Blocks& blocks) {
  blocks.emplace_back(Heading{"What no candidate explains"});
  Table table{
      .caption = fmt::format("The smooth part of what is left, in standard deviations of what noise would have of it. "
                             "Its waveform follows {} (correlation {:.2f}).",
                             u.correlates_with, u.correlation),
      .headers = {"channel", "rms", "unit", "beyond noise [sigmas]"},
      .rows = {}};
  for (const auto& c : u.channels)
    table.rows.push_back({c.name, fmt::format("{:.3g}", c.rms), c.unit, fmt::format("{:.1f}", c.times_noise)});
  blocks.emplace_back(table);
  if (u.heat_would_sit_in.empty() || u.time_s.empty()) return;
  Plot plot{.title = fmt::format("Heat in {} that would explain most of it, in the first record", u.heat_would_sit_in),
            .x_label = "time [min]",
            .y_label = "heat [W]",
            .series = {{.label = "heat", .x = {}, .y = u.heat_W, .style = output::Series::Style::kSteps}}};
  for (double t_s : u.time_s) plot.series[0].x.push_back(t_s / 60.0);
  blocks.emplace_back(plot);
}

void add_wander(const diagnosis::HeatWander& wander, Blocks& blocks) {
  Table table{.caption = fmt::format(
                  "Where the model errs: heat that comes and goes in its bodies, alike for about {:.0f} min, as it would "
                  "explain what the first search left. Causes are weighed beside this process noise.",
                  wander.time_s / 60.0),
              .headers = {"body", "heat, 1 sigma [W]", "share of what it does to the readings [%]"},
              .rows = {}};
  for (const auto& b : wander.bodies)
    table.rows.push_back({b.body.name, fmt::format("{:.2g}", b.sd_W), fmt::format("{:.0f}", 100.0 * b.share)});
  blocks.emplace_back(table);
}

/// What a waveform looks like, with its numbers.
std::string shape_text(const diagnosis::Waveform& w) {
  using diagnosis::Shape;
  const bool is_heat = w.of == diagnosis::Waveform::Of::kHeat;
  const bool is_tilt = !is_heat && w.unit == "rad";
  const char* unit = !w.to.empty() ? "W/K" : is_heat ? "W" : is_tilt ? "urad" : "um";
  const double scale = is_heat ? 1.0 : 1e6;
  const auto size = [&] {
    return fmt::format("{:.3g} ± {:.2g} {}", scale * w.shape.size, 2.0 * scale * w.shape.size_sd, unit);
  };
  const std::string what = w.to.empty() ? "" : "conductance to " + w.to + ": ";
  switch (w.shape.shape) {
    case Shape::kNothing:
      return "nothing that stands out";
    case Shape::kConstant:
      return what + "constant, " + size();
    case Shape::kStep:
      return fmt::format("{}step of {} at {:.1f} min", what, size(), w.shape.time_s / 60.0);
    case Shape::kDecay:
      return fmt::format("{}{} at {:.1f} min, decaying with {:.1f} min (a mass added or taken away)", what, size(),
                         w.shape.time_s / 60.0, w.shape.time_constant_s / 60.0);
    case Shape::kPeriodic:
      return fmt::format("{}periodic, {}, period {:.1f} min", what, size(), w.shape.period_s / 60.0);
    case Shape::kProportional:
      return fmt::format("{}follows {}", what, w.shape.follows);
    case Shape::kWindows: {
      std::vector<std::string> windows;
      for (const auto& [begin_s, end_s] : w.shape.windows_s)
        windows.push_back(fmt::format("{:.1f}-{:.1f}", begin_s / 60.0, end_s / 60.0));
      return fmt::format("{}{} in {} of one size: {} min", what, size(), windows.size() == 1 ? "a window" : "windows",
                         fmt::join(windows, ", "));
    }
    case Shape::kOther:
      return "none of the simple courses";
  }
  return "";
}

/// The best of each run and kind are drawn.
void add_waveforms(const diagnosis::Diagnosis& d, Blocks& blocks) {
  constexpr std::size_t kMostPlots = 4;
  Table table{.caption =
                  "What the scenario misses with its own numbers fitted (as written, where no likely ones fit) and no "
                  "cause, row by row: the heat that each body "
                  "alone would want beside what is written, or the conductance that would bring it, and the growth "
                  "that each displacement has beside its prediction. Likelihood: over no such heat. Explained: of the "
                  "readings' squared misses by the heat, of the waveform's by its course.",
              .headers = {"record", "where", "what it looks like", "likelihood [nats]", "heat explains", "course explains"},
              .rows = {}};
  std::vector<Plot> plots;
  std::set<std::pair<std::string, bool>> drawn;
  for (const diagnosis::Waveform& w : d.waveforms) {
    const bool is_heat = w.of == diagnosis::Waveform::Of::kHeat;
    if (w.shape.shape == diagnosis::Shape::kNothing) continue;
    table.rows.push_back({w.run, w.where, shape_text(w), is_heat ? fmt::format("{:.0f}", w.log_likelihood_gain) : "",
                          is_heat ? fmt::format("{:.0f} %", 100.0 * w.explained) : "",
                          fmt::format("{:.0f} %", 100.0 * w.shape.explained)});
    if (plots.size() == kMostPlots || !drawn.insert({is_heat ? w.run : w.run + " " + w.where, is_heat}).second) continue;
    const bool is_exchange = !w.to.empty();
    Plot plot{.title = is_exchange ? fmt::format("Conductance that is missing between {} and {}, {}", w.where, w.to, w.run)
                       : is_heat   ? fmt::format("Heat that is missing in {}, {}", w.where, w.run)
                                   : fmt::format("Growth that is missing in {}, {}", w.where, w.run),
              .x_label = "time [min]",
              .y_label = is_exchange       ? "conductance [W/K]"
                         : is_heat         ? "heat [W]"
                         : w.unit == "rad" ? "tilt [urad]"
                                           : "growth [um]",
              .series = {{.label = is_exchange ? "conductance"
                                   : is_heat   ? "heat"
                                               : "growth",
                          .x = {},
                          .y = is_exchange ? w.conductance_W_K : w.value,
                          .style = output::Series::Style::kSteps}}};
    for (double t_s : w.time_s) plot.series[0].x.push_back(t_s / 60.0);
    if (!is_heat) {
      for (double& y : plot.series[0].y) y *= 1e6;
    }
    plots.push_back(std::move(plot));
  }
  if (table.rows.empty()) return;
  blocks.emplace_back(Heading{"What is missing over time"});
  blocks.emplace_back(table);
  for (Plot& plot : plots) blocks.emplace_back(std::move(plot));
}

void add_gain(const diagnosis::Diagnosis& d, Blocks& blocks) {
  blocks.emplace_back(Heading{"What mending it gains"});
  Table table{
      .caption = fmt::format(
          "Root mean square and peak of measured minus simulated. Held out: {}. Noise floor: what the "
          "readings scatter by themselves. Regression: ridge on memories of speed, ambient and whatever else drives, "
          "which knows nothing of the machine; then with readings of thermometers too. The file: what extended.yaml gives "
          "over the whole of all records, to which its "
          "numbers were fitted.",
          d.holdout),
      .headers = {"channel", "unit", "as written", "scatter alone", "extended", "regression", "with thermometers",
                  "noise floor", "peak before", "peak after", "the file, all rows"},
      .rows = {}};
  for (const auto& g : d.gain) {
    table.rows.push_back({g.name, g.unit, fmt::format("{:.3g}", g.rmse_before), fmt::format("{:.3g}", g.rmse_calibrated),
                          fmt::format("{:.3g}", g.rmse_after), fmt::format("{:.3g}", g.rmse_of_drive),
                          fmt::format("{:.3g}", g.rmse_of_readings), fmt::format("{:.3g}", g.noise_floor),
                          fmt::format("{:.3g}", g.peak_before), fmt::format("{:.3g}", g.peak_after),
                          std::isnan(g.rmse_written) ? "" : fmt::format("{:.3g}", g.rmse_written)});
  }
  blocks.emplace_back(table);
  if (const std::string better = better_regression_text(d); !better.empty()) blocks.emplace_back(Paragraph{better});
}

void add_data(const diagnosis::Diagnosis& d, Blocks& blocks) {
  if (d.data.empty()) return;
  blocks.emplace_back(Heading{"The data themselves"});
  Table table{.caption = "", .headers = {"channel", "finding", "compared"}, .rows = {}};
  for (const auto& f : d.data) table.rows.push_back({f.channel, f.what, f.leaves_out ? "left out" : "yes"});
  blocks.emplace_back(table);
}

void add_candidates(const DiagnosisPage& page, Blocks& blocks) {
  constexpr std::size_t kMost = 15;
  const diagnosis::Diagnosis& d = page.diagnosis;
  Bars bars{
      fmt::format("Evidence [nats] that each would bring alone beside scatter, its signature taken at trial size (linear "
                  "theory); the best of {} candidates. What stands up is fitted in full and pays for being one of many.",
                  d.n_candidates),
      {}};
  std::set<std::size_t> shown;
  for (const diagnosis::Score& s : d.search.scores) {
    if (bars.bars.size() == kMost || !(s.gain > 0.0)) break;
    if (!shown.insert(s.candidate).second) continue;  // by a better law
    const diagnosis::Candidate& c = page.candidates.at(s.candidate);
    bars.bars.push_back({fmt::format("{} at {}: {}", c.effect, c.where, c.variants.at(s.variant).law), s.gain,
                         fmt::format("{:.1f}", s.gain)});
  }
  const diagnosis::Chance& chance = d.search.chance;
  const double price = std::log(std::max(1.0, static_cast<double>(d.n_candidates)));
  blocks.emplace_back(Heading{"Best single candidates"});
  blocks.emplace_back(
      Paragraph{fmt::format("The best of all would have {:.1f} nats at half of all machines in which nothing is wrong, "
                            "{:.1f} at one in a hundred, above which a cause is "
                            "suspected, and {:.1f} at one in ten thousand, above which it is named; found by simulating "
                            "this machine with these records.",
                            chance.gain_at(0.5) + price, chance.gain_at(0.01) + price, chance.gain_at(1e-4) + price)});
  if (bars.bars.empty()) {
    blocks.emplace_back(Paragraph{"None would bring evidence."});
    return;
  }
  blocks.emplace_back(bars);
  const std::vector<MissingHeat> heat = missing_heat(d, page.candidates);
  if (heat.empty()) return;
  Bars by_body{
      "Where missing heat would explain the residual: evidence [nats] of heat in each body, with its power; negative: the "
      "scenario has too much.",
      {}};
  for (const MissingHeat& h : heat)
    by_body.bars.push_back({h.body, h.evidence, fmt::format("{:.1f} nats, {:.3g} W ({})", h.evidence, h.power_W, h.law)});
  blocks.emplace_back(by_body);
}

Table numbers_table(const diagnosis::Diagnosis& d) {
  Table table{
      .caption =
          "The scenario's uncertain numbers as fitted. Moved: from what the scenario says, in standard deviations of "
          "what is known of it: the scenario's `known_to`, else 10 %, exponents 3 %, the hall 0.3 K.",
      .headers = {"number", "fitted", "95 % interval", "unit", "known to", "moved [sigmas]"},
      .rows = {}};
  for (const diagnosis::Estimate& e : d.calibrated) {
    table.rows.push_back({e.name, fmt::format("{:.4g}", e.value), interval_text(e), e.unit, known_to_text(e),
                          fmt::format("{:+.2f}", e.deviation)});
  }
  return table;
}

void add_written(const DiagnosisPage& page, Blocks& blocks) {
  blocks.emplace_back(Heading{"What was written: " + page.file});
  for (const std::string& failure : page.extended.not_written)
    blocks.emplace_back(output::Verdict{output::Verdict::Kind::kBad, "Not written", failure});
  blocks.emplace_back(page.difference.empty() ? Preformatted{"No difference to the scenario."}
                                              : Preformatted{page.difference});
}

output::Report begin(const std::string& what, const DiagnosisPage& page, const output::Provenance& made_by) {
  std::vector<std::string> names;
  for (const auto& run : page.measured.runs) names.push_back(run.path);
  return {.title = page.measured.scenario.name + ": " + what,
          .subtitle = fmt::format("Driftwright {}, scenario {}; measured: {}", made_by.version, made_by.scenario,
                                  fmt::join(names, ", ")),
          .blocks = {}};
}

}  // namespace

output::Report diagnosis_report(const DiagnosisPage& page, const output::Provenance& made_by) {
  const diagnosis::Diagnosis& d = page.diagnosis;
  output::Report report = begin("diagnosis", page, made_by);
  report.blocks.emplace_back(verdict_box(d));
  add_causes(d, report.blocks);
  if (d.experiment) add_experiment(*d.experiment, report.blocks);
  if (d.unexplained) add_unexplained(*d.unexplained, report.blocks);
  if (d.wander) add_wander(*d.wander, report.blocks);
  add_candidates(page, report.blocks);
  add_waveforms(d, report.blocks);
  add_data(d, report.blocks);
  add_gain(d, report.blocks);
  add_residuals(page.measured, d, "extended", report.blocks);
  report.blocks.push_back(iso230_3_block(measured_iso230_3(page.measured)));
  report.blocks.emplace_back(Heading{"The scenario's own numbers"});
  report.blocks.emplace_back(numbers_table(d));
  add_written(page, report.blocks);
  return report;
}

output::Report calibration_report(const DiagnosisPage& page, const output::Provenance& made_by) {
  const diagnosis::Diagnosis& d = page.diagnosis;
  output::Report report = begin("calibration", page, made_by);
  const std::string warning = calibration_warning(d, page.candidates);
  const bool fits = warning.empty();
  report.blocks.emplace_back(output::Verdict{
      fits ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
      fits ? "The scenario's numbers explain the measurement" : "The numbers alone do not explain the measurement",
      warning});
  report.blocks.emplace_back(Heading{"Numbers"});
  report.blocks.emplace_back(numbers_table(d));
  if (d.unexplained) add_unexplained(*d.unexplained, report.blocks);
  if (d.wander) add_wander(*d.wander, report.blocks);
  add_waveforms(d, report.blocks);
  add_data(d, report.blocks);
  add_gain(d, report.blocks);
  add_residuals(page.measured, d, "calibrated", report.blocks);
  report.blocks.push_back(iso230_3_block(measured_iso230_3(page.measured)));
  if (!fits) add_candidates(page, report.blocks);
  add_written(page, report.blocks);
  return report;
}

}  // namespace driftwright::app
