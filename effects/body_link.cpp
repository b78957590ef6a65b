#include "effects/time_window.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double conductance_W_K = e["conductance"];
  balance.links.push_back({e.name() + " - " + e.references.at("to").name, e.body(),
                           in_window(
                               e, [=](const Inputs&) { return conductance_W_K; }, balance),
                           e.references.at("to").name});
}

void check(const Effect& e, const ConfigMap& in) {
  check_window(e, in);
  if (e.body() == e.references.at("to")) in.fail("to", "a link joins two bodies");
}

}  // namespace

EffectKind body_link() {
  return {.key = "link",
          .title = "conductance between a body and a lumped node or the hall",
          .law = "Q = conductance (T - T_to), spread evenly over the region or surface",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters = with_window({{"conductance", "W/K", 0.0, 1e9, {}, "total conductance", 0.1, "contact"}}),
          .contribute = contribute,
          .references = {{"to", {BodyKind::kNode}, {}, "lumped node at the other end, or hall"}},
          .check = check};
}

}  // namespace driftwright::effects
