#include "findings/test_plan_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/median.hpp"
#include "findings/named_value.hpp"
#include "findings/run_section.hpp"
#include "output/heat_map.hpp"

namespace driftwright::findings {
namespace {

using output::Plot, output::Series, output::Table, output::Value, output::Verdict;
using studies::JudgedTest, studies::TestPlan;

constexpr double kOften = 0.25;         // share of the faults of a kind from which a map is orange
constexpr double kWorthShowing = 0.02;  // share from which a confusion is shown
constexpr std::size_t kMostPairs = 25;

/// Laws of the question, grouped by kind in their order.
std::vector<std::pair<std::string, std::vector<Eigen::Index>>> laws_by_kind(const diagnosis::Question& question) {
  std::vector<std::pair<std::string, std::vector<Eigen::Index>>> kinds;
  for (std::size_t i = 0; i < question.laws.size(); ++i) {
    const std::string& effect = question.laws[i].effect;
    auto at = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == effect; });
    if (at == kinds.end()) at = kinds.insert(at, {effect, {}});
    at->second.push_back(static_cast<Eigen::Index>(i));
  }
  return kinds;
}

double weight(const TestPlan& plan, Eigen::Index law) {
  return plan.question.laws[static_cast<std::size_t>(law)].weight;
}

/// Mean over some laws, weighted.
template <class Of>
double mean(const TestPlan& plan, const std::vector<Eigen::Index>& laws, const Of& of) {
  double sum = 0.0, all = 0.0;
  for (Eigen::Index a : laws) {
    sum += weight(plan, a) * of(a);
    all += weight(plan, a);
  }
  return sum / all;
}

std::string drive_words(const Drive& d) {
  std::vector<std::string> words;
  if (d.speed_rpm > 0.0) words.push_back(fmt::format("{:.0f} rpm", d.speed_rpm));
  for (std::size_t a = 0; a < d.feed_m_s.size(); ++a) {
    if (d.feed_m_s[a] > 0.0) words.push_back(fmt::format("{} {:.4g} m/min", "xyz"[a], 60.0 * d.feed_m_s[a]));
  }
  if (d.cutting_power_W > 0.0) words.push_back(fmt::format("{:.4g} W", d.cutting_power_W));
  return words.empty() ? "at rest" : fmt::format("{}", fmt::join(words, ", "));
}

Verdict verdict_of(const TestPlan& plan) {
  const double usual = 100.0 * plan.usual.prospect.share_named, planned = 100.0 * plan.planned.prospect.share_named;
  std::vector<std::string> sections;
  for (const auto& s : plan.planned.cyclogram.sections)
    sections.push_back(fmt::format("{:.4g} min {}", s.duration_s / 60.0, drive_words(s.drive)));
  const bool is_usual = plan.planned.cyclogram.sections == plan.usual.cyclogram.sections;
  return {
      .kind = Verdict::Kind::kGood,
      .title = is_usual
                   ? "No better test was found than the usual one"
                   : fmt::format(
                         "Of the assumed faults, this test distinguishes {:.0f} % from all others, the usual one {:.0f} %",
                         planned, usual),
      .text = fmt::format("In {:.4g} h: {}. Faults are drawn evenly over the kinds of effects, and from a hundredth to "
                          "twice what the catalogue expects; the others are too small, or "
                          "another kind of effect does the same. This compares tests; it is no forecast.",
                          plan.duration_s / 3600.0, fmt::join(sections, ", "))};
}

Table tests_table(const TestPlan& plan) {
  Table table{.key = "tests",
              .title = "Tests of the same length",
              .caption =
                  "Usual: full drive for half of the time, rest for the other half. Stepped: a quarter, half, three "
                  "quarters of and all of it, then rest.",
              .columns = {{.key = "test", .title = "test"},
                          {.key = "share_named", .title = "faults named", .digits = output::percent(1)},
                          {.key = "number_sigma", .title = "own numbers known to, of before", .digits = output::percent(0)},
                          {.key = "sections", .title = "sections"}}};
  for (const JudgedTest* t : {&plan.usual, &plan.stepped, &plan.planned})
    table.rows.push_back({t->name, t->prospect.share_named, t->prospect.number_sigma.mean(), t->cyclogram.sections.size()});
  return table;
}

Table kinds_table(const TestPlan& plan) {
  Table table{
      .key = "kinds",
      .title = "Effects",
      .caption =
          "Seen: large enough to be distinguished from nothing. Named: distinguished from every other kind of effect, too. "
          "Evidence: of a "
          "fault of one standard deviation of its prior, what the machine's own "
          "numbers can take of it taken off; the median of its places and laws.",
      .columns = {{.key = "effect", .title = "effect"},
                  {.key = "n_laws", .title = "places and laws"},
                  {.key = "seen_usual", .title = "seen, usual", .digits = output::percent(0)},
                  {.key = "seen_planned", .title = "seen, planned", .digits = output::percent(0)},
                  {.key = "named_usual", .title = "named, usual", .digits = output::percent(0)},
                  {.key = "named_planned", .title = "named, planned", .digits = output::percent(0)},
                  {.key = "nats_usual", .title = "evidence, usual", .unit = "nats", .digits = output::significant(3)},
                  {.key = "nats_planned", .title = "evidence, planned", .unit = "nats", .digits = output::significant(3)}}};
  const auto median = [](const Eigen::VectorXd& of, const std::vector<Eigen::Index>& laws) {
    std::vector<double> list;
    for (Eigen::Index a : laws) list.push_back(of[a]);
    return upper_median(std::move(list));
  };
  for (const auto& [effect, laws] : laws_by_kind(plan.question)) {
    const auto& before = plan.usual.prospect;
    const auto& after = plan.planned.prospect;
    table.rows.push_back({effect, laws.size(), mean(plan, laws, [&](Eigen::Index a) { return before.seen[a]; }),
                          mean(plan, laws, [&](Eigen::Index a) { return after.seen[a]; }),
                          mean(plan, laws, [&](Eigen::Index a) { return before.named[a]; }),
                          mean(plan, laws, [&](Eigen::Index a) { return after.named[a]; }), median(before.nats, laws),
                          median(after.nats, laws)});
  }
  return table;
}

/// For the detected faults of each kind, the share that another kind could explain: kinds x kinds, 0 to 1.
Eigen::MatrixXd taken_kinds(const TestPlan& plan, const JudgedTest& test) {
  const auto kinds = laws_by_kind(plan.question);
  const auto n = static_cast<Eigen::Index>(kinds.size());
  Eigen::MatrixXd taken = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index other = 0; other < n; ++other) {
      const auto& others = kinds[static_cast<std::size_t>(other)].second;
      taken(k, other) = mean(plan, kinds[static_cast<std::size_t>(k)].second, [&](Eigen::Index a) {
        double most = 0.0;
        for (Eigen::Index b : others) most = std::max(most, test.prospect.taken(a, b));
        return most;
      });
    }
  }
  return taken;
}

/// Two maps of the kinds that are confused after one of the tests. Kinds are numbered, because their names are longer than a
/// cell.
void add_maps(output::Section& body, const TestPlan& plan) {
  const auto kinds = laws_by_kind(plan.question);
  const Eigen::MatrixXd usual = taken_kinds(plan, plan.usual), planned = taken_kinds(plan, plan.planned);
  const Eigen::MatrixXd most = usual.cwiseMax(planned);
  std::vector<Eigen::Index> shown;
  for (Eigen::Index k = 0; k < most.rows(); ++k) {
    if (std::max(most.row(k).maxCoeff(), most.col(k).maxCoeff()) >= kWorthShowing) shown.push_back(k);
  }
  if (shown.empty()) return;
  const auto map_of = [&](const Eigen::MatrixXd& taken, const std::string& title) {
    output::HeatMap map{.columns = {}, .rows = {}, .values = {}, .limit = 100.0 * kOften, .unit = "%"};
    for (Eigen::Index k : shown) {
      std::string name = kinds[static_cast<std::size_t>(k)].first;
      std::replace(name.begin(), name.end(), '_', ' ');
      map.rows.push_back(fmt::format("{} {}", name, map.rows.size() + 1));
      map.columns.push_back({"", std::to_string(map.rows.size())});
      std::vector<double> row;
      for (Eigen::Index other : shown) row.push_back(other == k ? std::nan("") : 100.0 * taken(k, other));
      map.values.push_back(std::move(row));
    }
    return output::Picture{.title = title, .svg = output::draw_heat_map(map)};
  };
  add(body, map_of(usual,
                   "Usual test: share of a row's faults, of those large enough to be seen, that a column's effect may "
                   "explain as well"));
  add(body, map_of(planned, "Planned test: the same"));
}

Plot programme_plot(const TestPlan& plan) {
  Plot plot{.title = "Programme", .x_label = "time [h]", .y_label = "share of the most [%]"};
  const auto add_series = [&](const std::string& label, const auto& of) {
    Series series{.label = label, .style = Series::Style::kSteps};
    double most = 0.0, time_s = 0.0;
    for (const auto& s : plan.planned.cyclogram.sections) most = std::max(most, of(s.drive));
    for (const auto& s : plan.usual.cyclogram.sections) most = std::max(most, of(s.drive));
    if (most == 0.0) return;
    for (const auto& s : plan.planned.cyclogram.sections) {
      series.x.push_back(time_s / 3600.0);
      series.y.push_back(100.0 * of(s.drive) / most);
      time_s += s.duration_s;
    }
    series.x.push_back(time_s / 3600.0);
    series.y.push_back(series.y.back());
    plot.series.push_back(std::move(series));
  };
  add_series("spindle", [](const Drive& d) { return d.speed_rpm; });
  for (std::size_t a = 0; a < 3; ++a)
    add_series(fmt::format("axis {}", "xyz"[a]), [a](const Drive& d) { return d.feed_m_s[a]; });
  add_series("cutting power", [](const Drive& d) { return d.cutting_power_W; });
  return plot;
}

Plot readings_plot(const Record& record, const std::string& unit, const std::string& title, const std::string& label) {
  Plot plot{.title = title, .x_label = "time [h]", .y_label = label};
  std::vector<double> hours;
  for (double t_s : record.time_s) hours.push_back(t_s / 3600.0);
  for (const Channel& c : record.channels) {
    if (c.unit == unit) plot.series.push_back({.label = c.name, .x = hours, .y = c.values});
  }
  return plot;
}

Table channels_table(const TestPlan& plan) {
  Table table{.key = "channels",
              .title = "Channels",
              .caption = "Faults that the planned test would name without one instrument, or with one more thermometer.",
              .columns = {{.key = "channel", .title = "channel"},
                          {.key = "change", .title = "it is"},
                          {.key = "share_named", .title = "faults named", .digits = output::percent(1)},
                          {.key = "difference",
                           .title = "difference",
                           .digits = {.n = 1, .kind = output::Digits::Kind::kPercent, .has_sign = true}}}};
  const double as_is = plan.planned.prospect.share_named;
  for (const auto& c : plan.without) table.rows.push_back({c.name, "left out", c.share_named, c.share_named - as_is});
  for (const auto& c : plan.with) table.rows.push_back({c.name, "added", c.share_named, c.share_named - as_is});
  return table;
}

std::string law_words(const diagnosis::DoubtedLaw& law) {
  return fmt::format("{} at {} ({})", law.effect, law.where, law.law);
}

Table pairs_table(const TestPlan& plan) {
  Table table{.key = "pairs",
              .title = "Pairs that the planned test distinguishes least",
              .caption =
                  "d': of a fault of one standard deviation of its prior from the other effect at any size, in standard "
                  "deviations of what is not known.",
              .columns = {{.key = "fault", .title = "fault"},
                          {.key = "other", .title = "may be taken for"},
                          {.key = "d_usual", .title = "d', usual", .digits = output::decimals(1)},
                          {.key = "d_planned", .title = "d', planned", .digits = output::decimals(1)},
                          {.key = "taken_usual", .title = "taken, usual", .digits = output::percent(0)},
                          {.key = "taken_planned", .title = "taken, planned", .digits = output::percent(0)}},
              .detail = true};
  struct Pair {
    Eigen::Index a, b;
  };
  std::vector<Pair> pairs;
  const auto& p = plan.planned.prospect;
  for (Eigen::Index a = 0; a < p.d.rows(); ++a) {
    Eigen::Index nearest = 0;
    if (p.taken.row(a).maxCoeff(&nearest) > 0.0) pairs.push_back({a, nearest});
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const Pair& u, const Pair& v) { return p.taken(u.a, u.b) > p.taken(v.a, v.b); });
  pairs.resize(std::min(pairs.size(), kMostPairs));
  for (const Pair& pair : pairs) {
    const auto& u = plan.usual.prospect;
    table.rows.push_back({law_words(plan.question.laws[static_cast<std::size_t>(pair.a)]),
                          law_words(plan.question.laws[static_cast<std::size_t>(pair.b)]), u.d(pair.a, pair.b),
                          p.d(pair.a, pair.b), u.taken(pair.a, pair.b), p.taken(pair.a, pair.b)});
  }
  return table;
}

Table numbers_table(const TestPlan& plan) {
  Table table{.key = "numbers",
              .title = "The machine's own numbers",
              .caption = "One standard deviation afterwards, of what the scenario knows each to.",
              .columns = {{.key = "number", .title = "number"},
                          {.key = "known_to", .title = "known to", .digits = output::significant(2)},
                          {.key = "left_usual", .title = "left, usual", .digits = output::percent(0)},
                          {.key = "left_planned", .title = "left, planned", .digits = output::percent(0)}},
              .detail = true};
  for (std::size_t i = 0; i < plan.numbers.size(); ++i) {
    const diagnosis::Knob& k = plan.numbers[i];
    const auto at = static_cast<Eigen::Index>(i);
    table.rows.push_back({fmt::format("{} {} {}", k.effect, k.where, k.name), k.prior_sd,
                          plan.usual.prospect.number_sigma[at], plan.planned.prospect.number_sigma[at]});
  }
  return table;
}

Table programme_table(const TestPlan& plan) {
  Table table{.key = "programme",
              .title = "Programme",
              .columns = {{.key = "from_min", .title = "from", .unit = "min", .digits = output::decimals(1)},
                          {.key = "duration_min", .title = "for", .unit = "min", .digits = output::decimals(1)},
                          {.key = "drive", .title = "drive"},
                          {.key = "speed_rpm"},
                          {.key = "feed_x_mm_min"},
                          {.key = "feed_y_mm_min"},
                          {.key = "feed_z_mm_min"},
                          {.key = "cutting_power_W"}}};
  double time_s = 0.0;
  for (const auto& s : plan.planned.cyclogram.sections) {
    table.rows.push_back({time_s / 60.0, s.duration_s / 60.0, drive_words(s.drive), s.drive.speed_rpm,
                          60e3 * s.drive.feed_m_s[0], 60e3 * s.drive.feed_m_s[1], 60e3 * s.drive.feed_m_s[2],
                          s.drive.cutting_power_W});
    time_s += s.duration_s;
  }
  return table;
}

}  // namespace

output::Document document_of(const TestPlan& plan, const scenarios::Scenario& scenario, const std::string& rows,
                             const output::Provenance& made_by) {
  output::Document document{
      .made_by = made_by,
      .title = fmt::format("{}: test programme of {:.4g} h", scenario.name, plan.duration_s / 3600.0),
      .subtitle = fmt::format("read every {:.4g} s: {}", plan.interval_s, fmt::join(plan.channels, ", "))};
  output::Section& body = document.body;
  add(body, verdict_of(plan));
  add(body, tests_table(plan));
  add(body, programme_table(plan));
  add(body, programme_plot(plan));
  for (const auto& [unit, label, title] :
       {std::tuple("degC", "temperature [°C]", "Temperatures that the machine as written would have"),
        std::tuple("um", "drift [µm]", "Drift that it would have")}) {
    Plot plot = readings_plot(plan.planned_record, unit, title, label);
    if (!plot.series.empty()) add(body, std::move(plot));
  }
  add_maps(body, plan);
  add(body, kinds_table(plan));
  add(body, channels_table(plan));
  add(body, pairs_table(plan));
  add(body, numbers_table(plan));
  add(body, named_value("hours", "length", plan.duration_s / 3600.0, "h", output::significant(4)));
  add(body, named_value("interval_s", "rows every", plan.interval_s, "s", output::significant(4)));
  add(body, named_value("noise_K", "noise of a thermometer", plan.noise.temperature_K, "K", output::significant(3)));
  add(body, named_value("noise_um", "noise of a displacement", plan.noise.displacement_um, "um", output::significant(3)));
  add(body, Value{.key = "programmes_tried", .words = "programmes tried", .datum = plan.n_tried});
  add(body, Value{.key = "share_named_by_search",
                  .words = "faults named, as the search's linear machine has it",
                  .datum = plan.search_share,
                  .digits = output::percent(1),
                  .detail = true});
  add(body, output::Preformatted{.title = "For a scenario's cyclograms", .text = rows});
  return document;
}

}  // namespace driftwright::findings
