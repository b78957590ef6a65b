#include "identification/network_scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/characters.hpp"

namespace driftwright::identification {
namespace {

constexpr double kCapacity_J_K = 1e4;
constexpr double kThermometer_J_K = 1e-3, kThermometerTau_s = 20.0;
constexpr const char* kStill = "floor";
constexpr double kStill_J_K = 1e12, kStillTau_s = 1e9;  // a node that keeps its initial temperature

constexpr double kLeastShare = 1e-4;  // a heated body rises several times as much as the hottest thermometer
constexpr double kLeastOffset_K = 0.005;

/// A number with the digits it needs.
std::string digits(double value) {
  return fmt::format("{:.5g}", value);
}

/// A name that YAML reads as text.
std::string word(const std::string& name) {
  static const std::set<std::string> kOther = {"yes", "no", "true", "false", "on", "off", "null", "y", "n"};
  return kOther.contains(lower_case(name)) || !std::isalpha(static_cast<unsigned char>(name.front())) ? "\"" + name + "\""
                                                                                                      : name;
}

std::string heat(const Identified& network, const IdentifiedBody& b) {
  const Law& law = network.structure.laws[*b.body.law];
  const double power_W = kCapacity_J_K / b.body.tau_s * b.body.rise_K;
  switch (law.kind) {
    case Law::Kind::kTurning:
      return fmt::format("  - {{type: heat_source, node: {}, power: {} W, runs: while_spindle_turns}}\n", b.name,
                         digits(power_W));
    case Law::Kind::kPower:
      return fmt::format("  - {{type: heat_source, node: {}, power: {} W, at_speed: {} rpm, exponent: {}}}\n", b.name,
                         digits(power_W), digits(law.top), digits(law.exponent));
    case Law::Kind::kColumn:
      break;
  }
  return fmt::format("  - {{type: recorded_drive, node: {}, column: {}, gain: {}}}\n", b.name, word(law.channel),
                     digits(law.sign * power_W / law.top));
}

}  // namespace

std::string network_scenario(const Identified& network, const std::string& name, const std::vector<std::string>& records,
                             const std::vector<std::string>& head) {
  std::string text;
  for (const std::string& line : head) text += line.empty() ? "#\n" : "# " + line + "\n";
  const RecordRoles& roles = network.roles;
  const bool has_ambient = !roles.ambient.empty();
  text += fmt::format(
      "name: {}\n\nreference_temperature: {} degC\nstart: steady\n\nmachine: {{generator: lumped}}\n\neffects:\n", name,
      digits(network.reference_degC));
  // Bodies that some channel uses.
  std::set<std::size_t> used;
  for (const IdentifiedChannel& c : network.channels) {
    const bool is_thermometer = c.unit != "um";
    for (std::size_t b = 0; b < network.bodies.size(); ++b) {
      const double weight = c.fit.weight[static_cast<Eigen::Index>(b)];
      if (is_thermometer ? weight > kLeastShare : weight != 0.0) used.insert(b);
    }
  }
  text += "  # bodies: each loses heat to the ambient alone, with the time constant that its name says\n";
  for (std::size_t b : used)
    text += fmt::format("  - {{type: node, node: {}, capacity: 10 kJ/K}}\n", network.bodies[b].name);
  for (std::size_t b : used)
    text += fmt::format("  - {{type: link, node: {}, to: ambient, conductance: {} W/K}}\n", network.bodies[b].name,
                        digits(kCapacity_J_K / network.bodies[b].body.tau_s));
  const auto rest_of = [&](const IdentifiedChannel& c) {  // rest of a thermometer's mean: something at constant temperature
    double rest = has_ambient && c.fit.of_ambient > kLeastShare ? 1.0 - c.fit.of_ambient : 1.0;
    for (double share : c.fit.weight) rest -= share > kLeastShare ? share : 0.0;
    return rest;
  };
  if (has_ambient && std::any_of(network.channels.begin(), network.channels.end(),
                                 [&](const IdentifiedChannel& c) { return c.unit != "um" && rest_of(c) > kLeastShare; })) {
    text += fmt::format(
        "  - {{type: node, node: {}, capacity: {} J/K}}  # keeps the temperature of the first ambient\n  - {{type: link, "
        "node: {}, to: ambient, "
        "conductance: {} W/K}}\n",
        kStill, digits(kStill_J_K), kStill, digits(kStill_J_K / kStillTau_s));
  }
  text += "  # heat\n";
  for (std::size_t b : used) {
    if (network.bodies[b].body.law) text += heat(network, network.bodies[b]);
  }
  bool is_first = true;
  for (const IdentifiedChannel& c : network.channels) {
    if (c.unit == "um") continue;
    if (is_first) text += "  # thermometers: each a mean of bodies, by its conductances to them\n";
    is_first = false;
    text += fmt::format("  - {{type: node, node: at_{}, capacity: {} J/K}}\n", c.name, digits(kThermometer_J_K));
    const double whole_W_K = kThermometer_J_K / kThermometerTau_s;
    const auto link = [&](const std::string& to, double share) {
      text += fmt::format("  - {{type: link, node: at_{}, to: {}, conductance: {} W/K}}\n", c.name, to,
                          digits(whole_W_K * share));
    };
    for (std::size_t b = 0; b < network.bodies.size(); ++b) {
      const double share = c.fit.weight[static_cast<Eigen::Index>(b)];
      if (share > kLeastShare) link(network.bodies[b].name, share);
    }
    if (has_ambient && c.fit.of_ambient > kLeastShare) link("ambient", c.fit.of_ambient);
    if (rest_of(c) > kLeastShare) link(has_ambient ? kStill : "ambient", rest_of(c));
    if (std::abs(c.fit.offset) > kLeastOffset_K)  // a heat that produces the constant difference from its mean
      text += fmt::format("  - {{type: heat_source, node: at_{}, power: {} W}}\n", c.name, digits(whole_W_K * c.fit.offset));
  }
  text += has_ambient ? fmt::format("\nambient: {{csv: {}, channel: {}}}\n", records.front(), word(roles.ambient))
                      : fmt::format("\nambient: {} degC\n", digits(network.reference_degC));
  if (has_ambient || !roles.thermometers.empty()) text += "\nsensors:\n";
  if (has_ambient) text += fmt::format("  - {{name: {}, node: ambient}}\n", word(roles.ambient));
  for (const IdentifiedChannel& c : network.channels) {
    if (c.unit != "um") text += fmt::format("  - {{name: {}, node: at_{}}}\n", word(c.name), c.name);
  }
  is_first = true;
  for (const IdentifiedChannel& c : network.channels) {
    if (c.unit != "um") continue;
    if (is_first) text += "\ndisplacements:\n";
    is_first = false;
    text += fmt::format("  - name: {}\n    sensitivities:\n", word(c.name));
    for (std::size_t b : used)
      text += fmt::format("      - {{node: {}, sensitivity: {} um/K}}\n", network.bodies[b].name,
                          digits(c.fit.weight[static_cast<Eigen::Index>(b)]));
  }
  text += "\ncyclograms:\n";
  text += fmt::format("  {}: {{csv: {}}}\n", word(std::filesystem::path(records.front()).stem().string()), records.front());
  return text + "\nsolver: {output_interval: 1 min}\n";
}

Record run_record(const Record& record, const RecordRoles& roles) {
  Record run{.source = record.source, .time_s = record.time_s, .channels = {}};
  for (double& t : run.time_s) t -= record.time_s.front();
  const auto filled = [&](const std::string& channel) {
    const Eigen::VectorXd values = held(record.at(channel));
    return std::vector<double>(values.begin(), values.end());
  };
  run.channels.push_back({"speed", "rpm", std::vector<double>(record.n_samples(), 0.0)});
  if (!roles.speed.empty()) {
    run.channels[0].values = filled(roles.speed);
    for (double& rpm : run.channels[0].values) rpm = std::abs(rpm);
  }
  for (const std::string& drive : roles.drives) run.channels.push_back({drive, record.at(drive).unit, filled(drive)});
  if (!roles.ambient.empty()) run.channels.push_back({roles.ambient, "degC", filled(roles.ambient)});
  for (const auto* names : {&roles.thermometers, &roles.displacements}) {
    for (const std::string& name : *names) run.channels.push_back(record.at(name));
  }
  return run;
}

}  // namespace driftwright::identification
