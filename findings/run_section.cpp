#include "findings/run_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "machine/heat_flow_record.hpp"

namespace driftwright::findings {
namespace {

using output::Datum, output::Plot, output::Table;
using solver::FlowKind;

std::string words(FlowKind kind) {
  switch (kind) {
    case FlowKind::kSource:
      return "source";
    case FlowKind::kSurrounding:
      return "ambient";
    case FlowKind::kPrescribed:
      return "prescribed temperature";
    case FlowKind::kInternal:
      break;
  }
  return "";
}

/// Region of an unknown, or the name of the lumped node.
std::string place_of(int unknown, const scenarios::Model& model) {
  const mesh::Mesh& mesh = model.mesh();
  if (unknown >= mesh.n_nodes()) return "node " + model.balance.nodes[unknown - mesh.n_nodes()].name;
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells.nodes(c);
    if (std::find(nodes.begin(), nodes.end(), unknown) == nodes.end()) continue;
    const Eigen::Vector3d x_mm = 1e3 * mesh.coords.col(unknown);
    return fmt::format("{} at [{:.0f}, {:.0f}, {:.0f}] mm", mesh.regions[mesh.cells.group[c]], x_mm[0], x_mm[1], x_mm[2]);
  }
  return "";
}

}  // namespace

std::vector<double> minutes(const Record& record) {
  std::vector<double> t_min;
  for (double t_s : record.time_s) t_min.push_back(t_s / 60.0);
  return t_min;
}

std::vector<output::SectionMark> section_marks(const Cyclogram& cyclogram) {
  constexpr std::size_t kMostMarks = 40;  // more would hide the curves: an NC program changes speed hundreds of times
  std::vector<output::SectionMark> marks;
  double start_s = 0.0;
  const Drive* last = nullptr;
  for (const auto& section : cyclogram.sections) {
    if (!last || section.drive.speed_rpm != last->speed_rpm)
      marks.push_back({start_s / 60.0, fmt::format("{:.0f} rpm", section.drive.speed_rpm)});
    last = &section.drive;
    start_s += section.duration_s;
  }
  if (marks.size() > kMostMarks) marks.clear();
  return marks;
}

void add_interval(output::Series& series, const RecordBand* band, const std::string& channel) {
  if (!band || !band->low(channel)) return;
  series.low = band->low(channel)->values;
  series.high = band->high(channel)->values;
}

Plot channels_plot(const std::string& title, const std::string& y_label, const Record& record,
                   const std::vector<std::string>& names, const Cyclogram& cyclogram, const RecordBand* band) {
  Plot plot{.title = title, .x_label = "time [min]", .y_label = y_label, .marks = section_marks(cyclogram)};
  for (const std::string& name : names) {
    plot.series.push_back({.label = name, .x = minutes(record), .y = record.at(name).values});
    add_interval(plot.series.back(), band, name);
  }
  return plot;
}

void add_channel_plots(output::Section& section, const Record& record, const Cyclogram& cyclogram, const RecordBand* band) {
  constexpr std::size_t kPerPlot = 8;
  if (band) output::add(section, output::Text{.words = band->words, .key = "band"});
  const auto add = [&](const std::string& title, const std::string& label, const std::string& unit) {
    const std::vector<std::string> names = record.names_with_unit(unit);
    for (std::size_t first = 0; first < names.size(); first += kPerPlot) {
      const auto begin = names.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(first + kPerPlot, names.size()));
      output::add(section, channels_plot(title, label, record, {begin, end}, cyclogram, band));
    }
  };
  add("Displacements", "displacement [µm]", "um");
  add("Tilts", "tilt [µrad]", "urad");
  add("Temperatures", "temperature [°C]", "degC");
}

namespace {

Table heat_table(const solver::Trajectory& run) {
  const auto last = run.heat_J.cols() - 1;
  const double duration_s = run.time_s.back();
  Table table{.key = "heat_flows",
              .title = "Heat by source and path, mean over the cyclogram",
              .caption = fmt::format("In = stored + out to {:.0e}.", std::max(1e-16, run.energy_gap())),
              .columns = {{.key = "flow", .title = "flow"},
                          {.key = "to_or_from", .title = "to or from"},
                          {.key = "into_machine_W", .title = "into the machine", .unit = "W"},
                          {.key = "out_of_machine_W", .title = "out of it", .unit = "W"},
                          {.key = "heat_kJ", .title = "heat", .unit = "kJ"}}};
  std::vector<std::size_t> by_size(run.flows.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(run.heat_J(static_cast<Eigen::Index>(a), last)) >
           std::abs(run.heat_J(static_cast<Eigen::Index>(b), last));
  });
  double in_W = 0.0, lost_W = 0.0;
  for (FlowKind kind : {FlowKind::kSource, FlowKind::kSurrounding, FlowKind::kPrescribed}) {
    for (std::size_t j : by_size) {
      if (run.flows[j].kind != kind) continue;
      const double heat_J = run.heat_J(static_cast<Eigen::Index>(j), last), mean_W = heat_J / duration_s;
      (mean_W > 0.0 ? in_W : lost_W) += std::abs(mean_W);
      table.rows.push_back({run.flows[j].name, words(kind), mean_W > 0.0 ? Datum(mean_W) : Datum(),
                            mean_W > 0.0 ? Datum() : Datum(std::abs(mean_W)), 1e-3 * heat_J});
    }
  }
  table.rows.push_back({"sum", "", in_W, lost_W, {}});
  table.rows.push_back({"stored in the machine", "", {}, run.stored_J[last] / duration_s, 1e-3 * run.stored_J[last]});
  return table;
}

Table inner_heat_table(const solver::Trajectory& run) {
  const auto last = run.heat_J.cols() - 1;
  Table table{
      .key = "inner_heat_flows",
      .title = "Heat that flows within the machine",
      .caption = "> 0 out of the surface or body into the lumped node, or from the first part of a joint to the second.",
      .columns = {{.key = "flow", .title = "flow"},
                  {.key = "mean_W", .title = "mean", .unit = "W"},
                  {.key = "heat_kJ", .title = "heat", .unit = "kJ"}},
      .detail = true};
  for (std::size_t j = 0; j < run.flows.size(); ++j) {
    if (run.flows[j].kind != FlowKind::kInternal) continue;
    const double heat_J = run.heat_J(static_cast<Eigen::Index>(j), last);
    table.rows.push_back({run.flows[j].name, heat_J / run.time_s.back(), 1e-3 * heat_J});
  }
  return table;
}

Plot heat_plot(const solver::Trajectory& run, const Cyclogram& cyclogram) {
  constexpr std::size_t kMostRunCurves = 6;  // besides `stored`: as many as there are colours
  const Record record = scenarios::heat_flow_record(run, cyclogram.name);
  std::vector<std::pair<double, std::size_t>> by_size;  // total exchanged heat, channel
  for (std::size_t j = 0; j < run.flows.size(); ++j) {
    if (run.flows[j].kind == FlowKind::kInternal) continue;
    double moved = 0.0;
    for (double power_W : record.channels[j + 1].values) moved += std::isnan(power_W) ? 0.0 : std::abs(power_W);
    by_size.emplace_back(-moved, j + 1);
  }
  std::sort(by_size.begin(), by_size.end());
  std::vector<std::string> names = {"stored"};
  for (const auto& [size, channel] : by_size) {
    if (names.size() <= kMostRunCurves) names.push_back(record.channels[channel].name);
  }
  Plot plot = channels_plot("Heat into the machine", "heat flow [W]", record, names, cyclogram);
  plot.series.front().style = output::Series::Style::kDashed;
  return plot;
}

}  // namespace

void add_heat(output::Section& section, const solver::Trajectory& run, const Cyclogram& cyclogram) {
  add(section, heat_plot(run, cyclogram));
  add(section, heat_table(run));
  add(section, inner_heat_table(run));
}

void add_overshoots(output::Section& section, const solver::Trajectory& run, const scenarios::Model& model) {
  if (run.overshoots.empty()) return;
  Table table{
      .key = "overshoots",
      .title = "Where temperatures left the bounds that conduction keeps",
      .caption =
          "Beside a jump that is sharper than the mesh (consistent mass matrix); the largest of each jump, above the "
          "solver's tolerance.",
      .columns = {{.key = "jump_at_min", .title = "jump at", .unit = "min", .digits = output::decimals(2)},
                  {.key = "overshoot_K", .title = "overshoot", .unit = "K", .digits = output::decimals(4)},
                  {.key = "at_min", .title = "at", .unit = "min", .digits = output::decimals(2)},
                  {.key = "where", .title = "where"}},
      .detail = true};
  for (const solver::Overshoot& o : run.overshoots)
    table.rows.push_back({o.jump_s / 60.0, o.amount_K, o.time_s / 60.0, place_of(o.unknown, model)});
  const auto worst = std::max_element(run.overshoots.begin(), run.overshoots.end(),
                                      [](const auto& a, const auto& b) { return a.amount_K < b.amount_K; });
  add(section,
      output::Text{fmt::format("overshoot of {:.3f} K in {}, {:.0f} s after the jump at {:.1f} min", worst->amount_K,
                               place_of(worst->unknown, model), worst->time_s - worst->jump_s, worst->jump_s / 60.0)});
  add(section, std::move(table));
}

}  // namespace driftwright::findings
