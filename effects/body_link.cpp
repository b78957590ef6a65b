#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double conductance_W_K = e["conductance"];
  const std::string to = e.references.at("to").name;
  balance.exchanges.push_back(make_link(
      e.name() + " - " + to, e.body(), [=](const Inputs&) { return conductance_W_K; }, to));
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.body() == e.references.at("to")) in.fail("to", "a link joins two bodies");
}

}  // namespace

EffectKind body_link() {
  return {.key = "link",
          .title = "conductance between a body and a lumped node or the hall",
          .law = "Q = conductance (T - T_to), spread evenly over the region or surface",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters = {{"conductance", "W/K", 0.0, 1e9, {}, "total conductance", 0.1, "contact"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .references = {{"to", {BodyKind::kNode}, {}, "lumped node at the other end, or hall"}},
          .check = check,
          .exchange_finding = "contact"};
}

}  // namespace driftwright::effects
