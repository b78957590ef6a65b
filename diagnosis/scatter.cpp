#include "diagnosis/scatter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/own_effects.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kAmbient_K = 0.3;
constexpr double kLargestStep = 0.05;  // largest step of a logarithm for differences; usually a quarter of its prior

double step_of(double known_to) {
  return std::min(0.25 * known_to, kLargestStep);
}

/// The prior of a body's heat capacity, conductivity or expansion. @param unsaid  without `known_to`
double known_of_body(const Twin& twin, const std::string& property, const std::string& body, double unsaid) {
  for (std::size_t i = 0; i < twin.n_own_effects(); ++i) {
    const effects::Effect& e = twin.as_written()[i];
    if (e.kind->key == "node" && e.place == body && property == "heat_capacity")
      return effects::known_to(e.known_to, "capacity", unsaid);
  }
  for (const scenarios::MaterialEntry& m : twin.augmented().model.materials) {
    if (m.region == body) return effects::known_to(m.known_to, property, unsaid);
  }
  return unsaid;
}

}  // namespace

std::vector<Knob> ambient_scatter(const std::vector<MeasuredRun>& runs) {
  std::vector<Knob> knobs;
  for (const MeasuredRun& run : runs) {
    knobs.push_back({.effect = "ambient",
                     .where = effects::kAmbientName,
                     .name = "offset in " + run.name,
                     .unit = "K",
                     .in = run.name,
                     .prior_sd = kAmbient_K,
                     .step = 0.5 * kAmbient_K,
                     .set = [name = run.name](TwinState& s, double value) {
                       s.push_back(effects::make_effect("ambient", effects::Place::kAmbient, effects::kAmbientName,
                                                        {{"offset", value}}));
                       s.back().in = name;
                     }});
  }
  return knobs;
}

std::vector<std::string> number_names(const Twin& twin, const std::vector<Knob>& knobs) {
  std::vector<std::string> names;
  std::map<std::string, int> uses;
  for (const Knob& k : knobs) {
    TwinState turned = twin.as_written();
    k.set(turned, k.value(0.0));
    std::string of;  // names one of several sensitivities of a body
    if (turned.size() > twin.n_own_effects() && turned.back().words.contains("displacement"))
      of = turned.back().words.at("displacement").empty() ? "" : " of " + turned.back().words.at("displacement");
    const std::string name = fmt::format("{} {} {}{}", k.own.empty() ? k.effect : k.own, k.where, k.name, of);
    const int use = ++uses[name];
    names.push_back(use == 1 ? name : fmt::format("{} {}", name, use));
  }
  return names;
}

double written_value(const Twin& twin, const Knob& knob) {
  if (!knob.own.empty()) return knob.nominal;
  double value = 1.0;
  for (std::size_t i = 0; i < twin.n_own_effects(); ++i) {
    const effects::Effect& e = twin.as_written()[i];
    if (e.place != knob.where) continue;
    if (e.kind->key == knob.effect && e.has("factor")) value *= e["factor"];
    if (e.kind->key == "node" && knob.effect == "heat_capacity") value *= e["capacity"];
  }
  return value;
}

std::vector<Knob> scatter(const Twin& twin) {
  std::vector<Knob> knobs;
  for (std::size_t i = 0; i < twin.n_own_effects(); ++i) {
    const effects::Effect& e = twin.as_written()[i];
    for (std::size_t p = 0; p < e.kind->parameters.size(); ++p) {
      const effects::Parameter& parameter = e.kind->parameters[p];
      if (parameter.scatter == 0.0 || std::isnan(e.values[p]) || e.values[p] == 0.0) continue;
      const double known_to = effects::known_to(e.known_to, parameter.name, parameter.scatter);
      if (known_to == 0.0) continue;
      knobs.push_back({.effect = parameter.finding,
                       .where = effects::where_of(e),
                       .name = parameter.name,
                       .unit = parameter.unit,
                       .scale = Knob::Scale::kLog,
                       .nominal = e.values[p],
                       .prior_sd = known_to,
                       .step = step_of(known_to),
                       .low = parameter.low,
                       .high = parameter.high,
                       .set = [i, p](TwinState& s, double value) { s[i].values[p] = value; },
                       .own = e.kind->key,
                       .line = line_of(e),
                       .is_said = effects::known_to(e.known_to, parameter.name, 0.0) > 0.0});
    }
  }
  const effects::DoubtScene scene = scene_of(twin, {});
  for (const effects::EffectKind& kind : effects::catalogue()) {
    if (!kind.doubts) continue;
    for (const effects::Doubt& d : kind.doubts(scene)) {
      if (!d.scatters) continue;
      Knob size = knobs_of(d).front();
      size.prior_sd = known_of_body(twin, d.finding, d.where, effects::kBodyScatter);
      size.is_said = known_of_body(twin, d.finding, d.where, 0.0) > 0.0;
      if (size.prior_sd == 0.0) continue;
      size.step = step_of(size.prior_sd);
      knobs.push_back(std::move(size));
    }
  }
  return knobs;
}

}  // namespace driftwright::diagnosis
