#include <algorithm>

#include "effects/doubt.hpp"

namespace driftwright::effects {
namespace {

constexpr std::size_t kFewBodies = 12;  // up to so many, any two may be joined; beyond, those that a third one joins already
constexpr double kTrial = 0.1;          // of a typical conductance

void contribute(const Effect& e, HeatBalance& balance) {
  const double conductance_W_K = e["conductance"];
  const std::string to = e.references.at("to").name;
  balance.exchanges.push_back(make_link(
      e.name() + " - " + to, e.body(), [=](const Inputs&) { return conductance_W_K; }, to));
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.body() == e.references.at("to")) in.fail("to", "a link joins two bodies");
}

/// Air that films lie in. Regions meet it by their surfaces' films, which are doubted as such.
bool is_air_of_films(const DoubtScene& s, const Body& body) {
  return std::any_of(s.balance.exchanges.begin(), s.balance.exchanges.end(),
                     [&](const Exchange& e) { return e.body.kind == BodyKind::kSurface && node(e.surrounding) == body; });
}

bool has_common_neighbour(const DoubtScene& s, const Body& a, const Body& b) {
  return std::any_of(s.bodies.begin(), s.bodies.end(),
                     [&](const Body& c) { return !(c == a) && !(c == b) && are_joined(s, a, c) && are_joined(s, b, c); });
}

/// A path between two bodies that nothing joins: nodes with each other, with the ambient, and with regions.
std::vector<Doubt> doubts(const DoubtScene& s) {
  const double typical_W_K = s.typical_conductance_W_K();
  std::vector<Doubt> list;
  const auto add = [&](const Body& from, const Body& to) {
    Doubt missing{.finding = "link",
                  .where = {},
                  .law = "a path of heat that the scenario lacks",
                  .added = {make_effect("link", from, {{"conductance", 0.0}})},
                  .numbers = {doubted("conductance", "W/K", 2.0 * typical_W_K, 0.05 * typical_W_K)},
                  .trial = kTrial * typical_W_K};
    missing.numbers[0].low = 0.0;
    missing.added[0].references["to"] = to;
    missing.where = where_of(missing.added[0]);
    list.push_back(std::move(missing));
  };
  const bool is_small = s.bodies.size() <= kFewBodies;
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    const Body& from = s.bodies[i];
    const bool is_node = from.kind == BodyKind::kNode;
    for (std::size_t j = is_node ? i + 1 : 0; j < s.bodies.size(); ++j) {
      const Body& to = s.bodies[j];
      if (to.kind != BodyKind::kNode || are_joined(s, from, to)) continue;
      if (!is_node && is_air_of_films(s, to)) continue;
      if (is_small || has_common_neighbour(s, from, to)) add(from, to);
    }
    // A region loses its heat to the ambient by films.
    if (is_node && !are_joined(s, from, ambient_node())) add(from, ambient_node());
  }
  return list;
}

}  // namespace

EffectKind body_link() {
  return {.key = "link",
          .title = "conductance between a body and a lumped node or the ambient",
          .law = "Q = conductance (T - T_to), spread evenly over the region or surface",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters = {{"conductance", "W/K", 0.0, 1e9, {}, "total conductance", 0.1, "contact"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .references = {{"to", {BodyKind::kNode}, {}, "lumped node at the other end, or ambient"}},
          .check = check,
          .doubts = doubts,
          .exchange_finding = "contact"};
}

}  // namespace driftwright::effects
