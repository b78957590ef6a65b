#include "effects/body_between.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace driftwright::effects {
namespace {

constexpr std::size_t kFewBodies =
    6;  // with up to this many bodies also any two that a third one joins; with more only those that are joined directly
constexpr double kTrial = 0.1;       // of a typical conductance
constexpr double kCapacitySd = 1.5;  // 1 sigma of the logarithm of its capacity
constexpr double kRatioSd = 1.0;     // 1 sigma of ln(conductance to the second body / conductance to the first)
constexpr double kAmbientSd = 1.5, kUsualToAmbient = 0.3;  // the same for its link to the ambient
// Nats; with little capacity it equals a path between the two bodies, which is the simpler cause.
constexpr double kRare = 4.0;
constexpr double kTimeConstants[] = {0.03, 0.12, 0.5};  // tried first, as shares of the longest record

DoubtedNumber logarithmic(const char* name, const char* unit, double prior_sd, double nominal) {
  DoubtedNumber number = doubted(name, unit, prior_sd, 0.1, nominal);
  number.is_log = true;
  return number;
}

/// @param a, b  the bodies that its heat comes from and goes to
Doubt between(const DoubtScene& s, const DoubtScene::Material& a, const DoubtScene::Material& b) {
  const double typical_W_K = s.typical_conductance_W_K();
  const double capacity_J_K = std::min(a.capacity_J_K, b.capacity_J_K);
  const Body own = node(fmt::format("between_{}_and_{}", a.body.name, b.body.name));
  Doubt d{
      .finding = "hidden_body",
      .where = a.body.name + "," + b.body.name,
      .law = "a body between the two",
      .added = {make_effect("node", own, {{"capacity", capacity_J_K}}), make_effect("link", a.body, {{"conductance", 0.0}}),
                make_effect("link", b.body, {{"conductance", 0.0}})},
      .numbers = {doubted("conductance", "W/K", typical_W_K, 0.05 * typical_W_K),
                  logarithmic("capacity", "J/K", kCapacitySd, capacity_J_K),
                  logarithmic("ratio_of_conductances", "1", kRatioSd, 1.0)},
      .trial = kTrial * typical_W_K,
      .grid = {},
      .rarity = kRare};
  d.added[1].references["to"] = own;
  d.added[2].references["to"] = own;
  d.numbers[0].low = 0.0;
  d.numbers[0].set = [](std::span<Effect> added, double value_W_K) {
    for (std::size_t i = 1; i < added.size(); ++i) added[i].set("conductance", value_W_K);
  };
  d.numbers[1].grows_with_size = true;
  d.numbers[1].set = [](std::span<Effect> added, double value_J_K) { added[0].set("capacity", value_J_K); };
  d.numbers[2].set = [](std::span<Effect> added, double ratio) {
    added[2].set("conductance", ratio * added[1]["conductance"]);
  };
  for (double share : kTimeConstants)
    d.grid.push_back({std::log(2.0 * d.trial * share * s.longest_s() / capacity_J_K), 0.0});
  return d;
}

Doubt with_own_loss(const Doubt& between) {
  Doubt d = between;
  d.law += ", with a way of its own to the ambient";
  d.added.push_back(make_effect("link", d.added[0].body(), {{"conductance", 0.0}}));
  d.added[3].references["to"] = ambient_node();
  d.numbers.push_back(logarithmic("ratio_to_ambient", "1", kAmbientSd, kUsualToAmbient));
  d.numbers[3].set = [](std::span<Effect> added, double ratio) {
    added[3].set("conductance", ratio * added[1]["conductance"]);
  };
  for (std::vector<double>& x : d.grid) x.push_back(0.0);
  return d;
}

}  // namespace

std::vector<Doubt> bodies_between(const DoubtScene& s) {
  std::vector<Doubt> list;
  if (!(s.longest_s() > 0.0)) return list;
  const auto is_near = [&](const Body& a, const Body& b) {
    return are_joined(s, a, b) || (s.bodies.size() <= kFewBodies && have_common_neighbour(s, a, b));
  };
  for (std::size_t i = 0; i < s.materials.size(); ++i) {
    for (std::size_t j = i + 1; j < s.materials.size(); ++j) {
      const DoubtScene::Material &a = s.materials[i], &b = s.materials[j];
      const auto may_be = [](const DoubtScene::Material& m) { return m.stores && m.body.kind != BodyKind::kSurface; };
      if (!may_be(a) || !may_be(b) || !is_near(a.body, b.body)) continue;
      Doubt d = between(s, a, b);
      const bool is_taken = std::any_of(s.balance.nodes.begin(), s.balance.nodes.end(),
                                        [&](const LumpedNode& n) { return n.name == d.added[0].place; });
      if (is_taken) continue;
      list.push_back(d);
      list.push_back(with_own_loss(d));
    }
  }
  return list;
}

}  // namespace driftwright::effects
