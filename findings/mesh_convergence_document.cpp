#include "findings/mesh_convergence_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "findings/named_value.hpp"

namespace driftwright::findings {
namespace {

using studies::ConvergedValue, studies::Convergence, studies::MeshConvergence;

std::string convergence_words(Convergence kind) {
  switch (kind) {
    case Convergence::kMonotone:
      return "monotone";
    case Convergence::kOscillating:
      return "oscillating";
    case Convergence::kGrowing:
      return "changes grow";
    case Convergence::kUnresolved:
      return "no change";
  }
  return "";
}

std::string moment_words(const ConvergedValue& value) {
  return value.is_peak ? "at its peak" : "at the end";
}

output::Table meshes_table(const MeshConvergence& found) {
  output::Table table{.key = "meshes",
                      .title = "The three meshes",
                      .columns = {{.key = "mesh", .title = "mesh"},
                                  {.key = "is_own", .title = "the scenario's"},
                                  {.key = "factor", .title = "mesh sizes times", .digits = output::decimals(2)},
                                  {.key = "size_mm", .title = "mean element size", .unit = "mm"},
                                  {.key = "elements", .title = "elements"},
                                  {.key = "unknowns", .title = "unknowns"},
                                  {.key = "time_s", .title = "time", .unit = "s"},
                                  {.key = "was_known", .title = "model read from disk"}}};
  const char* const names[] = {"coarse", "middle", "fine"};
  for (std::size_t k = 0; k < 3; ++k) {
    const studies::MeshLevel& level = found.levels[k];
    table.rows.push_back({names[k], k == found.own, level.factor, 1e3 * level.size_m, level.n_elements, level.n_unknowns,
                          level.seconds, level.was_known});
  }
  return table;
}

/// The values of one unit.
output::Table values_table(const MeshConvergence& found, const std::string& unit, const std::string& key,
                           const std::string& title) {
  constexpr output::Digits kFour = output::significant(4), kTwo = output::significant(2);
  output::Table table{.key = key,
                      .title = title,
                      .columns = {{.key = "name", .title = "channel"},
                                  {.key = "moment", .title = "when"},
                                  {.key = "coarse_" + unit, .title = "coarse", .unit = unit, .digits = kFour},
                                  {.key = "middle_" + unit, .title = "middle", .unit = unit, .digits = kFour},
                                  {.key = "fine_" + unit, .title = "fine", .unit = unit, .digits = kFour},
                                  {.key = "convergence", .title = "convergence"},
                                  {.key = "order", .title = "order p", .digits = output::decimals(1)},
                                  {.key = "extrapolated_" + unit, .title = "extrapolated", .unit = unit, .digits = kFour},
                                  {.key = "error_coarse_" + unit, .title = "error, coarse", .unit = unit, .digits = kTwo},
                                  {.key = "error_middle_" + unit, .title = "error, middle", .unit = unit, .digits = kTwo},
                                  {.key = "error_fine_" + unit, .title = "error, fine", .unit = unit, .digits = kTwo}}};
  for (const ConvergedValue& value : found.values) {
    if (value.unit != unit) continue;
    const studies::GridConvergence& c = value.convergence;
    table.rows.push_back({value.channel, value.is_peak ? "peak" : "end", value.values[0], value.values[1], value.values[2],
                          convergence_words(c.kind), c.order, c.extrapolated, c.error[0], c.error[1], c.error[2]});
  }
  return table;
}

/// A channel over the element size: the three values, and a dashed line to the extrapolated one at zero.
output::Plot channel_plot(const MeshConvergence& found, std::size_t first) {
  const ConvergedValue& end = found.values[first];
  output::Plot plot{.title = end.channel + " over the element size",
                    .x_label = "mean element size [mm]",
                    .y_label = fmt::format("{} [{}]", end.unit == "K" ? "rise of " + end.channel : end.channel,
                                           output::shown_unit(end.unit)),
                    .half_width = true};
  for (std::size_t i : {first, first + 1}) {
    const ConvergedValue& value = found.values[i];
    const int color = static_cast<int>(i - first);
    output::Series line{.label = moment_words(value), .color = color};
    for (std::size_t k = 0; k < 3; ++k) {
      line.x.push_back(1e3 * found.levels[k].size_m);
      line.y.push_back(value.values[k]);
    }
    if (!std::isnan(value.convergence.extrapolated)) {
      plot.series.push_back({.label = moment_words(value) + ", extrapolated",
                             .x = {0.0, line.x.back()},
                             .y = {value.convergence.extrapolated, line.y.back()},
                             .style = output::Series::Style::kDashed,
                             .color = color});
    }
    plot.series.push_back(std::move(line));
  }
  return plot;
}

/// Plots of displacements and tilts, or of thermometers.
void add_plots(output::Section& section, const MeshConvergence& found, bool thermometers) {
  for (std::size_t i = 0; i + 1 < found.values.size(); i += 2) {
    if ((found.values[i].unit == "K") == thermometers) add(section, channel_plot(found, i));
  }
}

/// Channels without an order that a user may rely on.
std::vector<std::string> named_of_kind(const MeshConvergence& found, Convergence kind) {
  std::vector<std::string> names;
  for (const ConvergedValue& value : found.values) {
    if (value.unit != "K" && value.convergence.kind == kind)
      names.push_back(fmt::format("{} {}", value.channel, moment_words(value)));
  }
  return names;
}

output::Verdict verdict_of(const MeshConvergence& found, const ConvergedValue& worst) {
  const double error = worst.convergence.error[found.own], value = worst.values[found.own];
  const std::string unit = output::shown_unit(worst.unit);
  output::Verdict verdict{
      .title = fmt::format("On the scenario's mesh the error of {} is about {:.2g} {}", worst.channel, error, unit),
      .text = fmt::format("This is the largest relative error of the displacements and tilts: {} {} is {:.4g} {} there.",
                          worst.channel, moment_words(worst), value, unit)};
  if (const auto growing = named_of_kind(found, Convergence::kGrowing); !growing.empty()) {
    verdict.kind = output::Verdict::Kind::kBad;
    verdict.text += fmt::format(
        " The changes from mesh to mesh do not shrink for {}. All three meshes are too coarse for an estimate there, and "
        "the "
        "errors of these rows are not reliable.",
        fmt::join(growing, ", "));
  }
  return verdict;
}

std::vector<std::string> next_steps(const MeshConvergence& found, const ConvergedValue& worst) {
  std::vector<std::string> steps;
  const double p = worst.convergence.used_order;
  if (!std::isnan(p) && worst.convergence.kind == Convergence::kMonotone) {
    const double factor = std::pow(0.5, 1.0 / p);
    const double elements = found.levels[found.own].n_elements / std::pow(factor, 3);
    steps.push_back(fmt::format(
        "To halve this error multiply every `mesh_size` of the scenario by {:.2f}. That mesh has about {:.0f} elements.",
        factor, elements));
  } else if (worst.convergence.kind != Convergence::kUnresolved) {
    steps.push_back(
        "The order of convergence of this value is not known from these meshes. Multiply every `mesh_size` of the scenario "
        "by "
        "0.7 and run this command again with a larger --most-elements.");
  }
  return steps;
}

}  // namespace

output::Document document_of(const MeshConvergence& found, const scenarios::Scenario& scenario,
                             const output::Provenance& made_by) {
  output::Document document{
      .made_by = made_by,
      .title = fmt::format("{}: convergence of the mesh", scenario.name),
      .subtitle = fmt::format("cyclogram {} on three meshes with the {} model", found.cyclogram, found.model)};
  output::Section& body = document.body;
  const ConvergedValue* worst = studies::worst_displacement(found);
  const bool has_displacements =
      std::any_of(found.values.begin(), found.values.end(), [](const ConvergedValue& v) { return v.unit != "K"; });
  if (worst) {
    add(body, verdict_of(found, *worst));
  } else if (has_displacements) {
    add(body, output::Verdict{.kind = output::Verdict::Kind::kGood,
                              .title = "The mesh is fine enough for this model",
                              .text = "No displacement and no tilt changes from mesh to mesh by more than the error of the "
                                      "model itself."});
  }
  add(body, output::Value{.key = "cyclogram", .datum = found.cyclogram});
  add(body, output::Value{.key = "model", .datum = found.model});
  add(body, named_value("theoretical_order", "order in theory", found.highest_order, output::decimals(0)));
  add_plots(body, found, false);
  if (worst) body.sections.push_back(output::next_section(next_steps(found, *worst)));
  output::Section numbers;
  for (const auto& [unit, key, title] :
       {std::tuple{"um", "displacements", "Displacements on the three meshes"},
        {"urad", "tilts", "Tilts on the three meshes"},
        {"K", "thermometers", "Rise of the thermometers since the start, on the three meshes"}}) {
    output::Table table = values_table(found, unit, key, title);
    if (!table.rows.empty()) add(numbers, std::move(table));
  }
  add(numbers, meshes_table(found));
  add(numbers,
      output::Text{
          .words = fmt::format(
              "Order, extrapolated value and error follow from the three values by Roache's grid "
              "convergence index with the safety factor {}; the order is limited to {} at least and {} at "
              "most. An error of an oscillating value is {} times the range of the three values. An order far above "
              "the highest one, and an oscillation, mean that two meshes agree by chance: compare a fourth "
              "size.",
              studies::kSafetyFactor, studies::kLeastOrder, found.highest_order, studies::kSafetyFactor)});
  if (scenario.solver.model == scenarios::ModelKind::kReduced)
    add(numbers, output::Text{.words = fmt::format(
                                  "'No change' means that the three values agree within the tolerance of the reduced model, "
                                  "{:g} K ({:g} µm, {:g} µrad).",
                                  scenario.solver.reduction_tolerance_K, 2.0 * scenario.solver.reduction_tolerance_K,
                                  20.0 * scenario.solver.reduction_tolerance_K)});
  body.sections.push_back(std::move(numbers));
  output::Section thermometers{.title = "Thermometers over the element size", .detail = true};
  add_plots(thermometers, found, true);
  if (!thermometers.blocks.empty()) body.sections.push_back(std::move(thermometers));
  return document;
}

}  // namespace driftwright::findings
