#include <algorithm>
#include <cmath>
#include <iterator>

#include "effects/body_between.hpp"
#include "effects/time_windows.hpp"

namespace driftwright::effects::hidden_body {

// Names of a body's node, and of one that exists in one record only.
constexpr const char *kSuffix = "_hidden", *kIn = " in ";
constexpr double kCapacitySd = 1.5;  // 1 sigma of the logarithm: from a fifth to five times its body's capacity
constexpr double kTrial = 0.1;       // of a typical conductance
constexpr double kRare = 4.0;  // nats; with little capacity it equals a path to the ambient, which is the simpler cause
constexpr double kTimeConstants[] = {0.03, 0.12, 0.5};  // tried first, as shares of the longest record
constexpr double kFollowTrial = 0.1, kLeast = 1e-4;     // shares of the capacity of its body
constexpr double kTimeSd = 2.0;                         // 1 sigma of the logarithm
constexpr double kTypicalTime = 0.1;                    // as a share of the longest record
constexpr double kFollowTimes[] = {0.01, 0.04, 0.15, 0.6};
// Time constant of a body while it is away: it arrives at the temperature of the ambient.
constexpr double kTakesTheAmbient_s = 60.0;
constexpr double kTrace = 1e-6;  // share of its exchange with the ambient while it is present

/// The node of a body; a body that exists in one record only has a separate node, because another record may have a similar
/// one.
std::string node_name(const Effect& e) {
  const bool stays = !e.in.empty() && !e.tables.contains(kWindows);
  return e.place + kSuffix + (stays ? kIn + e.in : "");
}

void contribute(const Effect& e, HeatBalance& balance) {
  const double link_W_K = e["conductance"];
  const double to_ambient_W_K = e.has("hall_conductance") ? e["hall_conductance"] : 0.0;
  const std::string own = node_name(e);
  balance.nodes.push_back({own, e["capacity"]});
  if (!e.tables.contains(kWindows)) {
    const auto is_there = [in = e.in](const Inputs& u) { return in.empty() || u.run == in; };
    balance.exchanges.push_back(make_link(
        e.name() + " - " + own, e.body(), [=](const Inputs& u) { return is_there(u) ? link_W_K : 0.0; }, own));
    const double trace_W_K = e.in.empty() ? 0.0 : kTrace * e["capacity"] / kTakesTheAmbient_s;
    if (trace_W_K > to_ambient_W_K || e.has("hall_conductance"))
      balance.exchanges.push_back(
          make_link(e.name() + " - ambient", node(own), [=](const Inputs&) { return std::max(to_ambient_W_K, trace_W_K); }));
  } else {
    const auto windows = windows_of(e);
    const auto is_there = [in = e.in, inside = within(windows, 1.0)](const Inputs& u) {
      return (in.empty() || u.run == in) && inside(u) > 0.0;
    };
    const double away_W_K = e["capacity"] / kTakesTheAmbient_s;
    // a small permanent exchange: a steady state must exist even if all other exchanges come and go
    const double always_W_K = std::max(to_ambient_W_K, kTrace * away_W_K);
    balance.exchanges.push_back(make_link(
        e.name() + " - " + own, e.body(), [=](const Inputs& u) { return is_there(u) ? link_W_K : 0.0; }, own));
    balance.exchanges.push_back(make_link(e.name() + " - ambient", node(own), [=](const Inputs&) { return always_W_K; }));
    balance.exchanges.push_back(make_link(e.name() + " - ambient while it is away", node(own),
                                          [=](const Inputs& u) { return is_there(u) ? 0.0 : away_W_K; }));
    add_change_times(windows, balance);
  }
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.tables.contains(kWindows)) {
    check_windows(e, in);
  } else if (e.has("every") || e.has("until_time")) {
    in.fail(kWindows, "`every` and `until_time` are allowed only for a body that comes and goes; write its `windows`, too");
  }
}

/// A hidden body that is almost as warm as its body, or almost isolated. Readings show its capacity and its time constant;
/// its conductance may have any value, so the priors of heat paths do not apply.
Doubt following(const DoubtScene::Material& m, double longest_s) {
  DoubtedNumber capacity = doubted("capacity", "J/K", m.capacity_J_K, kFollowTrial * m.capacity_J_K);
  capacity.low = 0.0;
  capacity.set = [least_J_K = kLeast * m.capacity_J_K](std::span<Effect> added, double value) {
    added[0].set("capacity", std::max(value, least_J_K));  // a body always has some capacity
  };
  DoubtedNumber behind = doubted("time_constant", "min", kTimeSd, 0.1, kTypicalTime * longest_s / 60.0);
  behind.is_log = true;
  behind.set = [](std::span<Effect> added, double value) {
    added[0].set("conductance", added[0]["capacity"] / (60.0 * value));
  };
  Doubt d{.finding = "hidden_body",
          .where = m.body.name,
          .law = "a body that follows it with a time constant",
          .added = {make_effect("hidden_body", m.body, {{"capacity", kLeast * m.capacity_J_K}, {"conductance", 0.0}})},
          .numbers = {capacity, behind},
          .trial = kFollowTrial * m.capacity_J_K,
          .grid = {}};
  for (double share : kFollowTimes) d.grid.push_back({std::log(share / kTypicalTime)});
  return d;
}

/// A body at each region and node, with its exchange and capacity, and in a second law also its own exchange with the
/// ambient; and bodies between two others.
std::vector<Doubt> doubts(const DoubtScene& s) {
  const double typical_W_K = s.typical_conductance_W_K(), longest_s = s.longest_s();
  std::vector<Doubt> list;
  if (!(longest_s > 0.0)) return list;
  for (const DoubtScene::Material& m : s.materials) {
    const auto hides = [](const std::string& name, const std::string& behind) {
      return name == behind + kSuffix || name.starts_with(behind + kSuffix + kIn);
    };
    const bool has_one = std::any_of(s.balance.nodes.begin(), s.balance.nodes.end(), [&](const LumpedNode& n) {
      return hides(n.name, m.body.name) || hides(m.body.name, n.name);
    });
    const bool is_hidden = m.body.name.ends_with(kSuffix);
    if (has_one || is_hidden || !m.stores || m.body.kind == BodyKind::kSurface) continue;
    Doubt behind{.finding = "hidden_body",
                 .where = m.body.name,
                 .law = "a body connected to it alone, with no other way out",
                 .added = {make_effect("hidden_body", m.body, {{"capacity", m.capacity_J_K}, {"conductance", 0.0}})},
                 .numbers = {doubted("conductance", "W/K", typical_W_K, 0.05 * typical_W_K),
                             doubted("capacity", "J/K", kCapacitySd, 0.1, m.capacity_J_K)},
                 .trial = kTrial * typical_W_K,
                 .grid = {}};
    behind.numbers[0].low = 0.0;
    behind.numbers[1].is_log = true;
    behind.numbers[1].grows_with_size = true;
    for (double share : kTimeConstants) behind.grid.push_back({std::log(behind.trial * share * longest_s / m.capacity_J_K)});
    list.push_back(behind);
    list.push_back(following(m, longest_s));

    Doubt between = std::move(behind);
    between.law = "a body between it and the ambient";
    DoubtedNumber out = doubted("hall_conductance", "W/K", kCapacitySd, 0.1, typical_W_K);
    out.is_log = true;
    out.grows_with_size = true;
    between.numbers.push_back(out);
    between.added[0].set("hall_conductance", typical_W_K);
    for (auto& x : between.grid) x.push_back(std::log(kTrial));
    between.rarity = kRare;
    list.push_back(std::move(between));
  }
  std::vector<Doubt> between_two = bodies_between(s);
  std::move(between_two.begin(), between_two.end(), std::back_inserter(list));
  return list;
}

EffectKind kind() {
  return {
      .key = "hidden_body",
      .title = "body connected to another: a cover, a tank, a clamped part, which no node or region of the machine is",
      .law =
          "capacity dT_hidden/dt = conductance (T - T_hidden) - hall_conductance (T_hidden - T_ambient); it makes the node "
          "<its body>_hidden, and takes its heat evenly from the region; with windows it is there within them, and as warm "
          "as the ambient else; `in` a record without windows it is there all along in that one, and in no other",
      .places = {Place::kRegion, Place::kNode},
      .parameters = repeating({{"capacity", "J/K", 1e-6, 1e12, {}, "heat capacity of the hidden body"},
                               {"conductance", "W/K", 0.0, 1e9, {}, "between the two", 0.1, "hidden_body", Doubted::kFactor},
                               {"hall_conductance", "W/K", 0.0, 1e9, kNotGiven, "from the hidden body to the ambient", 0.1,
                                "hidden_body", Doubted::kFactor}}),
      .timing = Timing::kInRecord,
      .keeps_time_itself = true,
      .contribute = contribute,
      .tables = {windows_table(false)},
      .check = check,
      .doubts = doubts};
}

}  // namespace driftwright::effects::hidden_body
