#include "studies/machine_draft_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/characters.hpp"
#include "base/config_map.hpp"
#include "mesh/unnamed_geometry.hpp"

namespace driftwright::studies {
namespace {

/// Any text as a YAML string.
std::string quoted(const std::string& text) {
  const bool is_plain = is_name(text) && !std::isdigit(static_cast<unsigned char>(text.front())) && text.front() != '-';
  return is_plain ? text : double_quoted(text);
}

std::string at_mm(const Eigen::Vector3d& x_m) {
  const auto mm = [](double x) { return std::abs(x) < 5e-6 ? 0.0 : 1e3 * x; };  // avoids "-0.00"
  return fmt::format("[{:.2f} mm, {:.2f} mm, {:.2f} mm]", mm(x_m[0]), mm(x_m[1]), mm(x_m[2]));
}

std::string direction(const Eigen::Vector3d& n) {
  const auto clean = [](double x) { return std::abs(x) < 1e-6 ? 0.0 : x; };
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", clean(n[0]), clean(n[1]), clean(n[2]));
}

constexpr const char* kGuess =
    "  # `known_to: guess` lets diagnose and calibrate move a number by a factor of 2; `known_to: 10 %` is for one that\n"
    "  # you know (docs/how-to/scenario.md).\n";

/// Two digits, since it is a guess.
double rounded(double x) {
  const double step = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return step * std::round(x / step);
}

/// The runs, and the study that judges them, for both kinds of machines.
std::string runs_block() {
  return "\nambient: 20 degC                            # or rows of [time, temperature], or a record "
         "(docs/how-to/cyclograms.md)\n"
         "\ncyclograms:                              # guesses: [duration, spindle speed]\n"
         "  warm_up: [[120 min, 3000 rpm]]\n"
         "  steps: [[40 min, 1000 rpm], [40 min, 3000 rpm], [40 min, 0 rpm]]\n"
         "  shift: [[60 min, 3000 rpm], [20 min, 0 rpm], [60 min, 2000 rpm], [40 min, 0 rpm]]\n";
}

std::string study_block(const std::string& target, std::size_t n_sensors) {
  return fmt::format(
      "\nstudy:\n  target: {}                      # what `run` fits and judges\n  train: [warm_up, steps]\n"
      "  judge: shift                         # on which nothing is fitted\n  sensors_to_choose: {}\n"
      "  sensor_resolution: 0.1 K             # a guess: the step of the thermometers\n  tolerance: 10 um                   "
      "  # a guess\n",
      target, std::min<std::size_t>(n_sensors, 2));
}

std::string head(const std::string& name, const std::string& what) {
  return fmt::format(
      "# {}, as `driftwright init` has written it. It runs as it is:\n#\n#     driftwright run THIS_FILE\n#\n"
      "# What says \"guess\" is one: put your machine's numbers in its place. All keys: docs/reference/scenario.md; "
      "effects: driftwright list effects.\n"
      "name: {}\n\nreference_temperature: 20 degC           # a guess: at it the machine is straight\n",
      what, name);
}

}  // namespace

std::string machine_text(const MachineDraft& draft, const mesh::UnnamedGeometry& geometry, const std::string& file) {
  std::string text = fmt::format("machine:\n  mesh: {}\n", quoted(file));
  if (!geometry.unit.empty()) {
    const char* guess = geometry.is_drawing ? "a guess from the size, for the file says another one: its lengths"
                                            : "a guess from the size: the lengths in the file";
    text += fmt::format("  units: {}{}\n", geometry.unit,
                        geometry.unit_is_a_guess ? fmt::format("                            # {}", guess) : "");
  }
  if (geometry.is_drawing) {
    text += "  element_order: 2                     # quadratic; linear tetrahedra are far too stiff in bending\n";
    double largest_mm = 0.0;
    for (const auto& region : draft.regions) largest_mm = std::max(largest_mm, rounded(1e3 * region.mesh_size_m));
    text += "  mesh_size:                           # a guess: coarse, to begin with\n";
    text += fmt::format("    default: {:g} mm\n", largest_mm);
    for (const auto& region : draft.regions) {
      if (rounded(1e3 * region.mesh_size_m) < largest_mm)
        text += fmt::format("    {}: {:g} mm\n", quoted(region.name), rounded(1e3 * region.mesh_size_m));
    }
    const bool any =
        std::any_of(draft.regions.begin(), draft.regions.end(), [](const auto& r) { return r.inside_m.has_value(); });
    if (any)
      text +=
          "  regions:                             # solids without a name in the file, by a point in each: rename them\n"
          "                                       # (regions.svg shows which is which)\n";
    for (const auto& region : draft.regions) {
      if (region.inside_m) text += fmt::format("    {}: {}\n", quoted(region.name), at_mm(*region.inside_m));
    }
  }
  if (!draft.planes.empty() || !draft.remaining.empty())
    text += "  surfaces:                            # found by their geometry\n";
  for (const auto& plane : draft.planes)
    text += fmt::format("    - {{name: {}, region: {}, plane: {{through: {}, normal: {}}}}}\n", quoted(plane.surface),
                        quoted(plane.region), at_mm(plane.through_m), direction(plane.normal));
  for (const std::string& region : draft.remaining)
    text += fmt::format("    - {{name: {}, region: {}, remaining: true}}\n",
                        quoted(fmt::format("{}_rest", plain_name(region))), quoted(region));
  const bool any_pair = std::any_of(draft.joints.begin(), draft.joints.end(), [](const auto& j) { return !j.a.empty(); });
  if (any_pair) text += "  joints:                              # planes of two parts that lie on each other\n";
  for (const auto& joint : draft.joints) {
    if (!joint.a.empty())
      text += fmt::format("    - {{name: {}, a: {}, b: {}}}\n", quoted(joint.name), quoted(joint.a), quoted(joint.b));
  }
  return text;
}

std::string scenario_text(const MachineDraft& draft, const mesh::UnnamedGeometry& geometry, const std::string& name,
                          const std::string& file) {
  std::string text = head(name, fmt::format("A machine from {}", std::filesystem::path(file).filename().string()));
  for (const std::string& remark : draft.remarks)
    text.insert(text.find("name: "), fmt::format("# Look at this: {}.\n", remark));
  text += fmt::format("\n{}", machine_text(draft, geometry, file));
  text += "\nmaterials:                               # guesses from the names; driftwright list materials\n";
  for (const auto& region : draft.regions) text += fmt::format("  {}: {}\n", quoted(region.name), region.material);
  text += "\nsupports:                                # a guess: levelling feet under the lowest plane faces, with z up\n";
  for (const auto& foot : draft.feet) {
    text += fmt::format("  - {{surface: {}, springs: [{:.4g} N/um, {:.4g} N/um, {:.4g} N/um]}}\n", quoted(foot.surface),
                        200.0 * foot.share, 200.0 * foot.share, 600.0 * foot.share);
  }
  if (!draft.joints.empty()) {
    text += fmt::format(
        "\n# Mechanics of joints: all are tied until `joints:` says otherwise, such as\n#   joints:\n#     - {{name: {}, "
        "normal_stiffness: 2e9 N/m, "
        "tangential_stiffness: 5e8 N/m}}\n",
        quoted(draft.joints.front().name));
  }
  text += fmt::format(
      "\neffects:\n{}  # Heat of the spindle: a guess, so that the whole machine would warm by about 2 K.\n"
      "  - {{type: heat_source, region: {}, power: {:g} W, at_speed: 3000 rpm, exponent: 1.5, "
      "known_to: {{power: guess, exponent: 30 %}}}}\n",
      kGuess, quoted(draft.spindle), rounded(draft.heat_W));
  text += "  # Free convection and radiation of surfaces in still air: guesses of 5 to 12 W/(m^2 K).\n";
  for (const std::string& surface : draft.films)
    text += fmt::format("  - {{type: convection, surface: {}, film: 10 W/(m^2 K), known_to: guess}}\n", quoted(surface));
  if (!draft.joints.empty())
    text += "  # Joints: guesses; bolted and scraped 2000 to 10000, a guideway 500 to 3000 W/(m^2 K).\n";
  for (const auto& joint : draft.joints)
    text +=
        fmt::format("  - {{type: contact, joint: {}, conductance: 2000 W/(m^2 K), known_to: guess}}\n", quoted(joint.name));
  text += "\nsensors:                                 # one on each part: put them where your thermometers sit\n";
  for (const auto& sensor : draft.thermometers)
    text += fmt::format("  - {{name: {}, region: {}, at: {}}}\n", quoted(fmt::format("t_{}", plain_name(sensor.region))),
                        quoted(sensor.region), at_mm(sensor.at_m));
  text += draft.table ? "\ndisplacements:                           # the tool against the table; both points are guesses\n"
                      : "\ndisplacements:                           # of the tool against the ground, a guess; add `table: "
                        "{region, at}` for a table\n";
  for (const char* axis : {"x", "y", "z"}) {
    text += fmt::format("  - {{name: drift_{}, along: {}, tool: {{region: {}, at: {}}}", axis, axis,
                        quoted(draft.tool.region), at_mm(draft.tool.at_m));
    if (draft.table)
      text += fmt::format(", table: {{region: {}, at: {}}}", quoted(draft.table->region), at_mm(draft.table->at_m));
    text += "}\n";
  }
  text += runs_block();
  text +=
      "\nsolver:\n  model: reduced                       # a small model made of the finite elements; `full` runs these\n";
  return fmt::format("{}{}", text, study_block("drift_z", draft.thermometers.size()));
}

std::string lumped_scenario_text(const std::string& name) {
  const char* machine =
      "\nmachine: {generator: lumped}             # no mesh: nodes and links alone\n"
      "\neffects:                                 # all numbers are guesses, of a spindle in its housing\n";
  const char* rest =
      "  - {type: node, node: spindle, capacity: 5.6 kJ/K, known_to: guess}          # 12 kg of steel\n"
      "  - {type: node, node: housing, capacity: 19 kJ/K, known_to: guess}           # 41 kg of cast iron\n"
      "  - {type: heat_source, node: spindle, power: 150 W, at_speed: 3000 rpm, exponent: 1.5, "
      "known_to: {power: guess, exponent: 30 %}}\n"
      "  - {type: link, node: spindle, to: housing, conductance: 12 W/K, known_to: guess}\n"
      "  - {type: link, node: housing, to: ambient, conductance: 5 W/K, known_to: guess}\n"
      "\nsensors:\n  - {name: t_spindle, node: spindle}\n  - {name: t_housing, node: housing}\n"
      "\ndisplacements:\n  - name: drift_z                        # 0.22 m of steel grow by 2.5 µm for each kelvin\n"
      "    sensitivities: [{node: spindle, sensitivity: 2.5 um/K}]\n";
  return fmt::format("{}{}{}{}{}{}", head(name, "A machine of lumped nodes"), machine, kGuess, rest, runs_block(),
                     study_block("drift_z", 2));
}

}  // namespace driftwright::studies
