#include "findings/placement_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "findings/machine_section.hpp"
#include "findings/named_value.hpp"
#include "studies/placement_tests.hpp"

namespace driftwright::findings {
namespace {

using output::Column, output::Plot, output::Series, output::Table, output::Value, output::Verdict;
using studies::ChosenBy, studies::PlacedFor, studies::Placement, studies::Residual;

constexpr double kWorthBuying = 0.9;  // ratio of the remaining error: one more thermometer must reduce it below this

// Times the error with one thermometer; larger values would squeeze the relevant curves against the axis.
constexpr double kOutOfPicture = 4.0;

/// The error of the curve for which the places were chosen.
double of(const Placement& p, const Residual& left) {
  if (p.options.placed_for == PlacedFor::kObserver) return left.observer_um;
  if (p.options.placed_for == PlacedFor::kRegression) return left.regression_um;
  return std::sqrt(left.observer_um * left.regression_um);
}

std::string for_words(PlacedFor placed_for) {
  if (placed_for == PlacedFor::kObserver) return "observer";
  if (placed_for == PlacedFor::kRegression) return "regression";
  return "both";
}

std::string told_for_words(PlacedFor placed_for) {
  return placed_for == PlacedFor::kBoth ? "both (geometric mean of observer and regression)"
                                        : "the " + for_words(placed_for);
}

std::string n_words(std::size_t n) {
  return n == 1 ? "1 thermometer" : fmt::format("{} thermometers", n);
}

/// The members of the set of n that are not mounted yet, in the order of Placement::names.
std::vector<int> bought(const Placement& p) {
  const std::vector<int>& set = p.chosen.sets[static_cast<std::size_t>(p.options.n) - 1];
  return {set.begin() + static_cast<std::ptrdiff_t>(p.mounted.size()), set.end()};
}

std::string spot_name(const Placement& p, int spot) {
  const std::vector<int> set = bought(p);
  const auto at = std::find(set.begin(), set.end(), spot);
  if (at != set.end()) return p.names[static_cast<std::size_t>(at - set.begin())];
  const studies::Spot& s = p.spots[static_cast<std::size_t>(spot)];
  if (s.node < 0) return s.region;
  return fmt::format("{} [{:.0f}, {:.0f}, {:.0f}] mm", s.region, 1e3 * s.at_m.x(), 1e3 * s.at_m.y(), 1e3 * s.at_m.z());
}

/// The number of thermometers that are worthwhile: the first number after which more of them reduce the error by less than a
/// tenth each.
std::size_t enough(const Placement& p) {
  for (std::size_t n = 0; n < p.chosen.left.size(); ++n) {
    double worth_um = of(p, p.chosen.left[n]);
    bool is_enough = true;
    for (std::size_t more = n + 1; more < p.chosen.left.size(); ++more) {
      worth_um *= kWorthBuying;
      is_enough = is_enough && of(p, p.chosen.left[more]) > worth_um;
    }
    if (is_enough) return n + 1;
  }
  return p.chosen.left.size();
}

Verdict verdict_of(const Placement& p) {
  const auto n = static_cast<std::size_t>(p.options.n);
  const Residual& left = p.chosen.left[n - 1];
  std::string text = fmt::format(
      "With {} a regression leaves {:.2f} µm and the observer {:.2f} µm of a drift of {:.1f} µm (RMS, on cyclograms and "
      "machines that the places were not chosen on).",
      n_words(n), left.regression_um, left.observer_um, p.drift_um);
  const std::size_t n_enough = enough(p);
  if (n_enough < n) {
    text += fmt::format(" {} would be enough: further ones reduce the error by less than a tenth each.", n_words(n_enough));
  } else if (n_enough < p.chosen.left.size()) {
    text += fmt::format(" Stop after {}: further ones reduce the error by less than a tenth each.", n_words(n_enough));
  } else if (n_enough > 1) {
    text += fmt::format(" Even the last of {} reduces the error by a tenth.", n_enough);
  }
  return {.kind = Verdict::Kind::kGood, .title = fmt::format("{} placed", n_words(n)), .text = text};
}

/// Where to mount them, which test to run, and with which commands.
std::vector<std::string> steps_after_placement(const Placement& p, const scenarios::Scenario& scenario,
                                               const output::Provenance& made_by) {
  const std::string placed = output::path_in_results(made_by, "placed.yaml");
  const std::size_t n_new = p.names.size();
  std::vector<std::string> steps;
  if (n_new > 0)
    steps.push_back(
        fmt::format("Mount {} at the {} of the table below. {} is the scenario with {}; sensors.yaml contains only {}.",
                    n_words(n_new), p.mesh.n_nodes() > 0 ? "points" : "bodies", placed, n_new == 1 ? "it" : "them",
                    n_new == 1 ? "its entry" : "the entries"));
  const int least = studies::least_test(
      p.tests, p.options.placed_for == PlacedFor::kObserver ? &Residual::observer_um : &Residual::regression_um);
  if (least >= 0)
    steps.push_back(fmt::format("Run this test and record it: {}.", p.tests[static_cast<std::size_t>(least)].programme));
  const std::string target = scenario.study || p.channels.empty() ? "" : " --target " + p.channels.front();
  steps.push_back(
      fmt::format("Then test strategies on another day: `driftwright validate {} --train TEST.csv --test "
                  "ANOTHER_DAY.csv{}`. TEST.csv is "
                  "the record of the test.",
                  placed, target));
  return steps;
}

Table places_table(const Placement& p, const std::vector<std::string>& entries) {
  Table table{.key = "places",
              .title = "Places",
              .columns = {{.key = "name", .title = "name"},
                          {.key = "region", .title = "region"},
                          {.key = "x_mm", .title = "x", .unit = "mm", .digits = output::decimals(1)},
                          {.key = "y_mm", .title = "y", .unit = "mm", .digits = output::decimals(1)},
                          {.key = "z_mm", .title = "z", .unit = "mm", .digits = output::decimals(1)},
                          {.key = "entry"}},
              .file = "place.csv"};
  const std::vector<int> set = bought(p);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const studies::Spot& spot = p.spots[static_cast<std::size_t>(set[i])];
    const bool has_point = spot.node >= 0;
    const auto mm = [&](int axis) { return has_point ? output::Datum(1e3 * spot.at_m[axis]) : output::Datum(); };
    table.rows.push_back({p.names[i], spot.region, mm(0), mm(1), mm(2), entries[i]});
  }
  return table;
}

Table curve_table(const Placement& p) {
  Table table{
      .key = "curve",
      .title = "How many: all figures",
      .caption =
          "RMS of the drift left on cyclograms and machines that were not chosen on. As designed: what the criteria say of "
          "the same places; with the loss of the worst one "
          "where that is counted.",
      .columns = {
          {.key = "n", .title = "n"},
          {.key = "observer_um", .title = "observer", .unit = "um", .digits = output::decimals(2)},
          {.key = "regression_um", .title = "regression", .unit = "um", .digits = output::decimals(2)},
          {.key = "observer_lost_um", .title = "observer, worst loss", .unit = "um", .digits = output::decimals(2)},
          {.key = "regression_lost_um", .title = "regression, worst loss", .unit = "um", .digits = output::decimals(2)},
          {.key = "design_observer_um", .title = "observer, as designed", .unit = "um", .digits = output::decimals(2)},
          {.key = "design_regression_um", .title = "regression, as designed", .unit = "um", .digits = output::decimals(2)},
          {.key = "objective_um", .title = "objective", .unit = "um", .digits = output::decimals(2)},
          {.key = "places", .title = "places"}}};
  table.rows.push_back({std::size_t{0}, p.without.observer_um, p.without.regression_um, output::Datum(), output::Datum(),
                        output::Datum(), output::Datum(), output::Datum(), std::vector<std::string>{}});
  for (std::size_t n = 0; n < p.chosen.sets.size(); ++n) {
    std::vector<std::string> places;
    for (std::size_t i = p.mounted.size(); i < p.chosen.sets[n].size(); ++i)
      places.push_back(spot_name(p, p.chosen.sets[n][i]));
    table.rows.push_back({n + 1, p.chosen.left[n].observer_um, p.chosen.left[n].regression_um, p.chosen_lost[n].observer_um,
                          p.chosen_lost[n].regression_um, p.observer_um[n], p.regression_um[n], p.objective_um[n], places});
  }
  return table;
}

/// Some columns of the curve, for people.
Table short_curve(Table curve) {
  constexpr std::size_t kShown = 5;  // n, both predictors, and both with the worst one lost
  curve.key.clear();
  curve.title = "How many";
  for (std::size_t c = kShown; c < curve.columns.size(); ++c) curve.columns[c].title.clear();
  curve.caption = "RMS of the drift left on cyclograms and machines that were not chosen on.";
  return curve;
}

Table ways_table(const Placement& p, double Residual::*value, const std::string& predictor) {
  Table table{.key = predictor + "_by_way",
              .title = fmt::format("Ways to choose: drift left to the {}", predictor),
              .caption = "Random: median and best of six sets; which is best is known only afterwards.",
              .columns = {{.key = "way", .title = "way"}}};
  for (std::size_t n = 1; n <= p.chosen.sets.size(); ++n)
    table.columns.push_back(
        {.key = fmt::format("n{}_um", n), .title = fmt::format("n = {}", n), .unit = "um", .digits = output::decimals(2)});
  const auto add_row = [&](const std::string& way, const std::vector<Residual>& left,
                           const std::vector<std::vector<int>>& sets) {
    std::vector<output::Datum> row = {way};
    for (std::size_t n = 0; n < p.chosen.sets.size(); ++n)
      row.push_back(sets.empty() || !sets[n].empty() ? output::Datum(left[n].*value) : output::Datum());
    table.rows.push_back(std::move(row));
  };
  add_row("chosen", p.chosen.left, p.chosen.sets);
  for (const ChosenBy& other : p.others) {
    const bool is_random = !other.best.empty();
    add_row(is_random ? "random, median" : other.way, other.left, is_random ? std::vector<std::vector<int>>{} : other.sets);
    if (is_random) add_row("random, best", other.best, {});
  }
  return table;
}

Table losses_table(const Placement& p) {
  Table table{
      .key = "loss_of_one",
      .title = fmt::format("Any one of {} fails", p.options.n),
      .caption = "The observer goes on with the others, the regression is fitted anew without it: the worst of all cases.",
      .columns = {
          {.key = "way", .title = "way"},
          {.key = "observer_um", .title = "observer, all", .unit = "um", .digits = output::decimals(2)},
          {.key = "observer_lost_um", .title = "observer, worst loss", .unit = "um", .digits = output::decimals(2)},
          {.key = "observer_worst", .title = "of"},
          {.key = "regression_um", .title = "regression, all", .unit = "um", .digits = output::decimals(2)},
          {.key = "regression_lost_um", .title = "regression, worst loss", .unit = "um", .digits = output::decimals(2)},
          {.key = "regression_worst", .title = "of"}}};
  for (const studies::LossOfOne& loss : p.losses) {
    const auto lost = [&](int spot) { return spot < 0 ? output::Datum() : output::Datum(spot_name(p, spot)); };
    table.rows.push_back({loss.way, loss.all.observer_um, loss.worst.observer_um, lost(loss.worst_for_observer),
                          loss.all.regression_um, loss.worst.regression_um, lost(loss.worst_for_regression)});
  }
  return table;
}

Table tests_table(const Placement& p) {
  Table table{.key = "tests",
              .title = "Tests",
              .caption =
                  "What is left when the regression was fitted to this one test alone, and the observer learned from it "
                  "with the drift measured.",
              .columns = {{.key = "duration_h", .title = "hours", .unit = "h", .digits = output::decimals(0)},
                          {.key = "programme", .title = "programme"},
                          {.key = "regression_um", .title = "regression", .unit = "um", .digits = output::decimals(2)},
                          {.key = "observer_um", .title = "observer", .unit = "um", .digits = output::decimals(2)}}};
  for (const studies::TriedTest& test : p.tests)
    table.rows.push_back({test.duration_s / 3600.0, test.programme, test.left.regression_um, test.left.observer_um});
  return table;
}

Plot curve_plot(const Placement& p, double Residual::*value, const std::string& predictor) {
  Plot plot{.title = fmt::format("When to stop buying: {}", predictor),
            .x_label = "thermometers",
            .y_label = "drift left, RMS [µm]",
            .half_width = true};
  const auto add_curve = [&](const std::string& label, const std::vector<Residual>& left, bool with_none,
                             Series::Style style, int color) {
    Series series{.label = label, .style = style, .color = color};
    if (with_none && predictor == "observer") {
      series.x.push_back(0.0);
      series.y.push_back(p.without.observer_um);
    }
    for (std::size_t n = 0; n < left.size(); ++n) {
      if (!std::isfinite(left[n].*value) || !(left[n].*value < kOutOfPicture * p.chosen.left.front().*value)) continue;
      series.x.push_back(static_cast<double>(n + 1));
      series.y.push_back(left[n].*value);
    }
    plot.series.push_back(std::move(series));
  };
  add_curve("chosen", p.chosen.left, true, Series::Style::kLine, 0);
  add_curve("chosen, worst one lost", p.chosen_lost, false, Series::Style::kDashed, 0);
  int color = 1;
  for (const ChosenBy& other : p.others) {
    const bool is_random = !other.best.empty();
    std::vector<Residual> left = other.left;
    for (std::size_t n = 0; n < left.size(); ++n) {
      if (!is_random && other.sets[n].empty()) left[n].*value = std::nan("");
    }
    add_curve(is_random ? "random, median" : other.way, left, false,
              is_random ? Series::Style::kDashed : Series::Style::kLine, color++);
  }
  return plot;
}

output::Picture told_picture(const Placement& p, const scenarios::MachineModel& machine) {
  std::vector<output::PictureMark> marks;
  for (const output::PictureMark& mark : marks_of(machine)) {
    if (mark.is_indicator) marks.push_back(mark);
  }
  const auto add_mark = [&](const std::string& name, int spot) {
    const studies::Spot& s = p.spots[static_cast<std::size_t>(spot)];
    marks.push_back({name, scenarios::motion_of(machine.axes, s.region)(s.at_m)});
  };
  const std::vector<int> set = bought(p);
  for (std::size_t i = 0; i < set.size(); ++i) add_mark(p.names[i], set[i]);
  for (int spot : p.mounted) add_mark(p.spots[static_cast<std::size_t>(spot)].sensor, spot);
  return {.title = fmt::format(
              "Error of the drift in µm that a single thermometer at each point would leave, estimated by the search "
              "criterion for {}; {:.2f} µm without a thermometer. "
              "Dots: the {} that were chosen together; rings: indicators; grey: no place for one",
              told_for_words(p.options.placed_for), p.told_nothing_um, p.options.n),
          .svg = output::draw_machine({.mesh = &p.mesh,
                                       .field = output::PictureField{"drift left by one thermometer there [µm]", p.told_um},
                                       .marks = marks})};
}

}  // namespace

output::Document document_of(const Placement& p, const scenarios::Scenario& scenario,
                             const std::vector<std::string>& entries, const output::Provenance& made_by) {
  output::Document document{
      .made_by = made_by,
      .title = fmt::format("{}: places for thermometers", scenario.name),
      .subtitle =
          fmt::format("{}{}", p.model, p.is_linearised ? "; laws of temperature frozen where the machine is at work" : "")};
  output::Section& body = document.body;
  add(body, verdict_of(p));

  output::Section picture;
  if (p.mesh.n_nodes() > 0) add(picture, told_picture(p, *scenario.machine));
  add(picture, curve_plot(p, &Residual::observer_um, "observer"));
  add(picture, curve_plot(p, &Residual::regression_um, "regression"));
  body.sections.push_back(std::move(picture));
  body.sections.push_back(output::next_section(steps_after_placement(p, scenario, made_by)));

  output::Section numbers{.title = "The numbers"};
  add(numbers, places_table(p, entries));
  add(numbers, named_value("drift_um", "drift without correction, RMS", p.drift_um, "um", output::decimals(2)));
  add(numbers, named_value("model_alone_um", p.mounted.empty() ? "left by the model alone" : "left with those mounted",
                           p.without.observer_um, "um", output::decimals(2)));
  add(numbers, named_value("enough", "number after which further thermometers reduce the error by less than a tenth each",
                           enough(p)));
  if (p.own) {
    add(numbers, named_value("own.thermometers", "thermometers of the scenario", p.own->sets.front().size()));
    add(numbers, named_value("own.observer_um", "error that these leave, with the observer", p.own->left.front().observer_um,
                             "um", output::decimals(2)));
    add(numbers, named_value("own.regression_um", "error that these leave, with a regression",
                             p.own->left.front().regression_um, "um", output::decimals(2)));
  }
  add(numbers, short_curve(curve_table(p)));
  if (const int least = studies::least_test(p.tests, &Residual::regression_um); least >= 0) {
    const studies::TriedTest& test = p.tests[static_cast<std::size_t>(least)];
    add(numbers, Verdict{.key = "test_for_regression",
                         .title = fmt::format("Test for a regression: {}", test.programme),
                         .text = fmt::format("Fitted to it alone, a regression on these places leaves {:.2f} µm, within a "
                                             "tenth of the best test that was tried.",
                                             test.left.regression_um)});
    const studies::TriedTest& other =
        p.tests[static_cast<std::size_t>(studies::least_test(p.tests, &Residual::observer_um))];
    add(numbers, Verdict{.key = "test_for_observer",
                         .title = fmt::format("Test for the observer: {}", other.programme),
                         .text = fmt::format("Having learned from it, the observer leaves {:.2f} µm, within a tenth of the "
                                             "best test; without a test {:.2f} µm.",
                                             other.left.observer_um,
                                             p.chosen.left[static_cast<std::size_t>(p.options.n) - 1].observer_um)});
  }
  body.sections.push_back(std::move(numbers));

  output::Section experts{.title = "For experts"};
  output::Section how{.title = "How the places were chosen", .detail = true};
  add(how, Value{.key = "channels", .words = "drift of", .datum = p.channels});
  add(how, Value{.key = "placed_for", .words = "chosen for", .datum = for_words(p.options.placed_for)});
  add(how, Value{.key = "any_may_fail", .words = "any one may fail", .datum = p.options.any_may_fail});
  add(how, Value{.key = "regions", .words = "may sit on", .datum = p.regions});
  if (!p.left_out.empty())
    add(how, Value{.key = "left_out", .words = "left out by their names (--region brings them in)", .datum = p.left_out});
  if (!p.options.mounted.empty()) add(how, Value{.key = "mounted", .words = "mounted already", .datum = p.options.mounted});
  add(how, named_value("candidates", "places looked at, sensors of the scenario among them", p.spots.size()));
  add(how, Value{.key = "chosen_on", .words = "chosen on", .datum = p.chosen_on});
  add(how, Value{.key = "judged_on", .words = "judged on", .datum = p.judged_on});
  if (!p.made.empty()) add(how, Value{.key = "made", .words = "of these made of the scenario's drives", .datum = p.made});
  add(how, Value{.key = "ambients", .words = "courses of the ambient temperature", .datum = p.ambients});
  add(how, Value{.key = "scatter", .words = "model uncertain by", .datum = p.options.scatter});
  add(how, named_value("noise_K", "noise of a reading", p.options.noise_K, "K", output::significant(2)));
  output::Section compared{.title = "Other numbers and ways to choose, the loss of one, tests", .detail = true};
  add(compared, curve_table(p));
  add(compared, ways_table(p, &Residual::observer_um, "observer"));
  add(compared, ways_table(p, &Residual::regression_um, "regression"));
  add(compared, losses_table(p));
  add(compared, tests_table(p));
  output::Section entries_text{.title = "The entries, to paste under `sensors:`", .detail = true};
  add(entries_text, output::Preformatted{.text = fmt::format("  - {}\n", fmt::join(entries, "\n  - "))});
  for (output::Section* part : {&how, &compared, &entries_text}) experts.sections.push_back(std::move(*part));
  body.sections.push_back(std::move(experts));
  return document;
}

}  // namespace driftwright::findings
