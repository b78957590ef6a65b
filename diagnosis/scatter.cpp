#include "diagnosis/scatter.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

constexpr double kScatter = 0.10;  // of what is not in the catalogue as a number

template <class List, class Matches>
auto& entry(List& list, const Matches& matches, typename List::value_type fresh) {
  for (auto& e : list) {
    if (matches(e)) return e;
  }
  list.push_back(std::move(fresh));
  return list.back();
}

ChangedBody& body_of(TwinState& state, const std::string& body, const std::string& displacement) {
  ChangedBody fresh{body};
  fresh.displacement = displacement;
  return entry(
      state.bodies, [&](const ChangedBody& b) { return b.body == body && b.displacement == displacement; }, fresh);
}

Knob uncertain_factor(const std::string& effect, const std::string& where, std::function<void(TwinState&, double)> set) {
  return {.effect = effect,
          .where = where,
          .name = "factor",
          .unit = "1",
          .scale = Knob::Scale::kLog,
          .nominal = 1.0,
          .prior_sd = kScatter,
          .step = 0.5 * kScatter,
          .set = std::move(set)};
}

}  // namespace

std::string where_of(const effects::Effect& e) {
  const auto to = e.references.find("to");
  return e.kind->key == "link" && to != e.references.end() ? e.place + "," + to->second.name : e.place;
}

std::vector<Knob> scatter(const Twin& twin) {
  std::vector<Knob> knobs;
  const AugmentedModel& a = twin.augmented();
  for (std::size_t i = 0; i < a.n_own_effects; ++i) {
    const effects::Effect& e = a.model.effects[i];
    for (std::size_t p = 0; p < e.kind->parameters.size(); ++p) {
      const effects::Parameter& parameter = e.kind->parameters[p];
      if (parameter.scatter == 0.0 || std::isnan(e.values[p]) || e.values[p] == 0.0) continue;
      knobs.push_back({.effect = parameter.finding,
                       .where = e.kind->key == "air_node" ? e.place + ",hall" : where_of(e),
                       .name = parameter.name,
                       .unit = parameter.unit,
                       .scale = Knob::Scale::kLog,
                       .nominal = e.values[p],
                       .prior_sd = parameter.scatter,
                       .step = 0.5 * parameter.scatter,
                       .low = -1e300,
                       .high = 1e300,
                       .set = [i, p](TwinState& s, double value) { s.effects[i].values[p] = value; }});
    }
    const bool by_formula =
        e.kind->key == "natural_convection" || e.kind->key == "rotating_cylinder" || e.kind->key == "air_gap";
    if (!by_formula) continue;
    const effects::HeatBalance alone = scenarios::reducible(effects::heat_balance({e}));
    std::vector<std::string> names;
    for (const auto& f : alone.films) names.push_back(f.name);
    for (const auto& l : alone.links) names.push_back(l.name);
    for (const auto& c : alone.contacts) names.push_back(c.name);
    for (const std::string& name : names) {
      const char* effect = e.kind->key == "natural_convection" ? "convection" : "forced_convection";
      knobs.push_back(uncertain_factor(effect, e.place, [name](TwinState& s, double value) {
        entry(s.exchanges, [&](const ChangedExchange& c) { return c.name == name && c.from_s == 0.0; }, {name}).factor *=
            value;
      }));
    }
  }
  const std::vector<std::string>& regions = twin.machine().mesh.regions;
  for (const auto& part : twin.machine().system.parts) {
    const auto add = [&](const char* effect, double ChangedBody::*member, const std::string& displacement = {}) {
      knobs.push_back(
          uncertain_factor(effect, part.body, [body = part.body, member, displacement](TwinState& s, double value) {
            body_of(s, body, displacement).*member *= value;
          }));
    };
    if (part.conduction.cwiseAbs().maxCoeff() > 0.0) add("conductivity", &ChangedBody::conductivity);
    if (part.mass.cwiseAbs().maxCoeff() > 0.0) add("heat_capacity", &ChangedBody::heat_capacity);
    const auto& model = a.model;
    const bool is_meshed = std::find(regions.begin(), regions.end(), part.body) != regions.end();
    bool expands = false;
    for (std::size_t o = model.sensors.size(); o < static_cast<std::size_t>(part.outputs.cols()); ++o) {
      if (!(part.outputs.col(static_cast<Eigen::Index>(o)).cwiseAbs().maxCoeff() > 0.0)) continue;
      const std::size_t d = o - model.sensors.size();
      // A sensitivity is a number of its own, but for a region that bends the mesh as well: that is one expansion.
      const bool by_points = d >= model.displacements.size() || (model.displacements[d].points && is_meshed);
      if (by_points) {
        expands = true;
      } else {
        add("expansion", &ChangedBody::expansion, model.displacements[d].name);
      }
    }
    if (expands) add("expansion", &ChangedBody::expansion);
  }
  return knobs;
}

}  // namespace driftwright::diagnosis
