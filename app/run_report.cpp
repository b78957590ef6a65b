#include "app/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/iso230_3_report.hpp"
#include "machine/heat_flow_record.hpp"

namespace driftwright::app {
namespace {

using output::Heading;
using output::Plot;
using output::Table;
using solver::FlowKind;

std::string words(FlowKind kind) {
  switch (kind) {
    case FlowKind::kSource:
      return "source";
    case FlowKind::kSurrounding:
      return "hall";
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

Plot channels_plot(const std::string& title, const std::string& y_label, const Record& record,
                   const std::vector<std::string>& names, const Cyclogram& cyclogram) {
  Plot plot{.title = title,
            .x_label = "time [min]",
            .y_label = y_label,
            .series = {},
            .bands = {},
            .marks = section_marks(cyclogram)};
  for (const std::string& name : names)
    plot.series.push_back({.label = name, .x = minutes(record), .y = record.at(name).values});
  return plot;
}

void add_channel_plots(output::Report& report, const Record& record, const Cyclogram& cyclogram) {
  constexpr std::size_t kPerPlot = 8;
  const auto add = [&](const std::string& title, const std::string& label, const std::string& unit) {
    const std::vector<std::string> names = record.names_with_unit(unit);
    for (std::size_t first = 0; first < names.size(); first += kPerPlot) {
      const auto begin = names.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(first + kPerPlot, names.size()));
      report.blocks.emplace_back(channels_plot(title, label, record, {begin, end}, cyclogram));
    }
  };
  add("Displacements", "displacement [um]", "um");
  add("Tilts", "tilt [urad]", "urad");
  add("Temperatures", "temperature [degC]", "degC");
}

Table heat_table(const solver::Trajectory& run) {
  const auto last = run.heat_J.cols() - 1;
  const double duration_s = run.time_s.back();
  Table table{.caption = fmt::format("Mean heat flow over the cyclogram. In = stored + out to {:.0e}.",
                                     std::max(1e-16, run.energy_gap())),
              .headers = {"flow", "to or from", "into the machine [W]", "out of it [W]", "heat [kJ]"},
              .rows = {}};
  double in_W = 0.0, lost_W = 0.0;
  for (FlowKind kind : {FlowKind::kSource, FlowKind::kSurrounding, FlowKind::kPrescribed}) {
    for (std::size_t j = 0; j < run.flows.size(); ++j) {
      if (run.flows[j].kind != kind) continue;
      const double heat_J = run.heat_J(static_cast<Eigen::Index>(j), last), mean_W = heat_J / duration_s;
      (mean_W > 0.0 ? in_W : lost_W) += std::abs(mean_W);
      table.rows.push_back({run.flows[j].name, words(kind), mean_W > 0.0 ? fmt::format("{:.1f}", mean_W) : "",
                            mean_W > 0.0 ? "" : fmt::format("{:.1f}", -mean_W), fmt::format("{:.1f}", 1e-3 * heat_J)});
    }
  }
  table.rows.push_back({"sum", "", fmt::format("{:.1f}", in_W), fmt::format("{:.1f}", lost_W), ""});
  table.rows.push_back({"stored in the machine", "", "", fmt::format("{:.1f}", run.stored_J[last] / duration_s),
                        fmt::format("{:.1f}", 1e-3 * run.stored_J[last])});
  return table;
}

Table inner_heat_table(const solver::Trajectory& run) {
  const auto last = run.heat_J.cols() - 1;
  Table table{.caption =
                  "Heat that flows within the machine: > 0 out of the surface or body into the lumped node, or from the "
                  "first part of a joint to the second.",
              .headers = {"flow", "mean [W]", "heat [kJ]"},
              .rows = {}};
  for (std::size_t j = 0; j < run.flows.size(); ++j) {
    if (run.flows[j].kind != FlowKind::kInternal) continue;
    const double heat_J = run.heat_J(static_cast<Eigen::Index>(j), last);
    table.rows.push_back(
        {run.flows[j].name, fmt::format("{:.1f}", heat_J / run.time_s.back()), fmt::format("{:.1f}", 1e-3 * heat_J)});
  }
  return table;
}

Plot heat_plot(const solver::Trajectory& run, const Cyclogram& cyclogram) {
  constexpr std::size_t kMostCurves = 6;  // and `stored`: as many as there are colours
  const Record record = scenarios::heat_flow_record(run, cyclogram.name);
  std::vector<std::pair<double, std::size_t>> by_size;  // total heat moved, channel
  for (std::size_t j = 0; j < run.flows.size(); ++j) {
    if (run.flows[j].kind == FlowKind::kInternal) continue;
    double moved = 0.0;
    for (double power_W : record.channels[j + 1].values) moved += std::isnan(power_W) ? 0.0 : std::abs(power_W);
    by_size.emplace_back(-moved, j + 1);
  }
  std::sort(by_size.begin(), by_size.end());
  std::vector<std::string> names = {"stored"};
  for (const auto& [size, channel] : by_size) {
    if (names.size() <= kMostCurves) names.push_back(record.channels[channel].name);
  }
  Plot plot = channels_plot("Heat into the machine", "heat flow [W]", record, names, cyclogram);
  plot.series.front().style = output::Series::Style::kDashed;
  return plot;
}

Table overshoot_table(const solver::Trajectory& run, const scenarios::Model& model) {
  Table table{.caption =
                  "Where temperatures left the bounds that conduction keeps, beside a jump that is sharper than the mesh "
                  "(consistent mass matrix); the largest of each jump, above the solver's tolerance.",
              .headers = {"jump at [min]", "overshoot [K]", "at [min]", "where"},
              .rows = {}};
  for (const solver::Overshoot& o : run.overshoots) {
    table.rows.push_back({fmt::format("{:.2f}", o.jump_s / 60.0), fmt::format("{:.4f}", o.amount_K),
                          fmt::format("{:.2f}", o.time_s / 60.0), place_of(o.unknown, model)});
  }
  return table;
}

std::string overshoot_text(const solver::Trajectory& run, const scenarios::Model& model) {
  if (run.overshoots.empty()) return "";
  const auto worst = std::max_element(run.overshoots.begin(), run.overshoots.end(),
                                      [](const auto& a, const auto& b) { return a.amount_K < b.amount_K; });
  return fmt::format("overshoot of {:.3f} K in {}, {:.0f} s after the jump at {:.1f} min", worst->amount_K,
                     place_of(worst->unknown, model), worst->time_s - worst->jump_s, worst->jump_s / 60.0);
}

output::Report simulation_report(const scenarios::Scenario& scenario, const scenarios::Model& model,
                                 const std::vector<const Cyclogram*>& cyclograms,
                                 const std::vector<scenarios::SimulatedRun>& runs, const output::Provenance& made_by) {
  output::Report report{.title = scenario.name + ": simulation",
                        .subtitle = fmt::format("Driftwright {}, scenario {}; {} nodes, {} cells, {} lumped nodes; {}",
                                                made_by.version, made_by.scenario, model.mesh().n_nodes(),
                                                model.mesh().cells.size(), model.balance.nodes.size(), model.words()),
                        .blocks = {}};
  const auto add = [&](auto block) { report.blocks.emplace_back(std::move(block)); };
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Record& record = runs[i].record;
    add(Heading{"Cyclogram " + cyclograms[i]->name});
    add_channel_plots(report, record, *cyclograms[i]);
    add(iso230_3_block(compensation::iso230_3_figures(record)));
    add(heat_plot(runs[i].trajectory, *cyclograms[i]));
    add(heat_table(runs[i].trajectory));
    add(inner_heat_table(runs[i].trajectory));
    if (!runs[i].trajectory.overshoots.empty()) add(overshoot_table(runs[i].trajectory, model));
  }
  return report;
}

}  // namespace driftwright::app
