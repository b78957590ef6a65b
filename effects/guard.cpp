#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "effects/doubt.hpp"

namespace driftwright::effects::guard {

constexpr std::size_t kEveryChoice = 6;  // with up to this many bodies, any two or more may be inside one guard
constexpr std::size_t kMostBodies = 12;  // with up to this many bodies, any two
// Resistance of the guard, relative to that of its bodies' own exchange with the ambient at the typical speed.
constexpr double kSd = 1.0, kTrial = 0.1, kLeast = 1e-4, kMost = 50.0;
constexpr double kCapacitySd = 1.5;            // 1 sigma of the logarithm of its capacity
constexpr double kUsual_min = 10.0;            // usual time constant of the air and the sheets
constexpr double kTried[] = {-1.5, 0.0, 1.0};  // tried first, of the logarithm of that time
constexpr double kRare = 1.0;                  // nats, for the choice of bodies: less likely than a path of one body

bool is_meant(const Exchange& x, const Body& body) {
  return x.body == body && x.surrounding == kAmbientName && !x.medium_K;
}

void change_paths(const Effect& e, HeatBalance& balance) {
  const std::string& air = e.references.at("air").name;
  for (Exchange& x : balance.exchanges) {
    if (!is_meant(x, e.body())) continue;
    x.surrounding = air;
    for (Body& probe : x.coefficient.probes) {  // free convection uses the air that it flows to
      if (probe == ambient_node()) probe = node(air);
    }
  }
  for (Radiation& r : balance.radiations) {
    if (e.body() == surface(r.surface) && r.surrounding == kAmbientName) r.surrounding = air;
  }
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.references.at("air") == ambient_node())
    in.fail("air", "this must be a lumped node with an exchange of its own with the ambient");
  if (e.references.at("air") == e.body()) in.fail("air", "the air of a guard must be another node than the body in it");
}

/// Conductance between a body and the ambient at the typical speed [W/K].
double to_ambient_W_K(const DoubtScene& s, const Body& body) {
  double sum_W_K = 0.0;
  for (const Exchange& x : s.balance.exchanges) {
    if (!is_meant(x, body) || x.per != Per::kTotal) continue;
    Inputs u{.drive = {.speed_rpm = s.typical_rpm}};
    u.probe_K.assign(x.coefficient.probes.size(), s.reference_K);
    sum_W_K += x.coefficient(u);
  }
  return sum_W_K;
}

/// @param air  name of its air
Doubt around(const std::vector<Body>& bodies, const std::string& air, double sum_W_K) {
  const double usual_K_W = 1.0 / sum_W_K;
  Doubt d{.finding = "hidden_body",
          .where = {},
          .law = "the air of a guard around them, with a way of its own to the ambient",
          .added = {make_effect("node", node(air)), make_effect("link", node(air))},
          .numbers = {doubted("resistance", "K/W", kSd * usual_K_W, kTrial * usual_K_W),
                      doubted("capacity", "J/K", kCapacitySd, 0.1, 60.0 * kUsual_min * sum_W_K)},
          .trial = kTrial * usual_K_W,
          .grid = {}};
  std::vector<std::string> names;
  for (const Body& body : bodies) {
    names.push_back(body.name);
    d.added.push_back(make_effect("guard", body));
    d.added.back().references["air"] = node(air);
  }
  d.where = fmt::format("{}", fmt::join(names, ","));
  d.added[1].references["to"] = ambient_node();
  d.numbers[0].low = 0.0;
  d.numbers[0].high = kMost * usual_K_W;
  d.numbers[0].set = [least_K_W = kLeast * usual_K_W](std::span<Effect> added, double resistance_K_W) {
    added[1].set("conductance", 1.0 / std::max(resistance_K_W, least_K_W));  // there is always some way to the ambient
  };
  d.numbers[1].is_log = true;
  d.numbers[1].set = [](std::span<Effect> added, double value) { added[0].set("capacity", value); };
  d.numbers[0].set(d.added, 0.0);
  d.numbers[1].set(d.added, d.numbers[1].nominal);
  for (const double x : kTried) d.grid.push_back({x});
  return d;
}

/// The choices of bodies inside one guard, out of n: for few bodies every choice of two or more; else all, all but one, and,
/// for not too many, any two.
std::vector<std::vector<std::size_t>> choices_of(std::size_t n) {
  std::vector<std::vector<std::size_t>> list;
  const auto add = [&](const auto& is_in) {
    list.emplace_back();
    for (std::size_t i = 0; i < n; ++i) {
      if (is_in(i)) list.back().push_back(i);
    }
  };
  if (n < 2) return list;
  if (n <= kEveryChoice) {
    for (unsigned chosen = 1; chosen < 1U << n; ++chosen) {
      if (std::popcount(chosen) > 1) add([=](std::size_t i) { return (chosen >> i & 1U) != 0; });
    }
    return list;
  }
  add([](std::size_t) { return true; });
  for (std::size_t out = 0; out < n; ++out) add([=](std::size_t i) { return i != out; });
  for (std::size_t a = 0; n <= kMostBodies && a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) add([=](std::size_t i) { return i == a || i == b; });
  }
  return list;
}

/// A guard that the scenario lacks, around bodies that lose heat to the ambient. Its size is the resistance from its air to
/// the ambient; zero means no guard.
std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Body> bodies;
  std::vector<double> each_W_K;
  for (const Body& body : s.bodies) {
    const double sum_W_K = to_ambient_W_K(s, body);
    if (!(sum_W_K > 0.0)) continue;
    bodies.push_back(body);
    each_W_K.push_back(sum_W_K);
  }
  std::vector<Doubt> list;
  for (const std::vector<std::size_t>& choice : choices_of(bodies.size())) {
    std::vector<Body> chosen;
    std::string air = "air_around";
    double sum_W_K = 0.0;
    for (const std::size_t i : choice) {
      chosen.push_back(bodies[i]);
      air += "_" + bodies[i].name;
      sum_W_K += each_W_K[i];
    }
    const bool is_taken =
        std::any_of(s.balance.nodes.begin(), s.balance.nodes.end(), [&](const LumpedNode& n) { return n.name == air; });
    if (!is_taken) list.push_back(around(chosen, air, sum_W_K));
  }
  for (Doubt& d : list) d.rarity = kRare + std::log(static_cast<double>(list.size()));
  return list;
}

EffectKind kind() {
  return {.key = "guard",
          .title = "a body inside a guard: what it loses to the ambient goes to the air in the guard",
          .law =
              "films, links and radiation of the body to the ambient lead to `air`, a node with a link of its own to the "
              "ambient; one entry for each body inside the guard",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters = {},
          .change_paths = change_paths,
          .references = {{"air", {BodyKind::kNode}, {}, "lumped node: the air in the guard"}},
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects::guard
