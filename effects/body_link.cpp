#include <algorithm>

#include "effects/doubt.hpp"
#include "effects/run_on.hpp"

namespace driftwright::effects::body_link {

// With up to this many bodies any two may be joined; with more, those that a third one already joins.
constexpr std::size_t kFewBodies = 12;
constexpr double kTrial = 0.1;  // of a typical conductance
constexpr double kUsualRunOn_min = 5.0;
constexpr double kRare = 1.0;  // nats: less likely than a path that always exists

bool goes_with_spindle(const Effect& e) {
  return e.words.at("runs") == "while_spindle_turns";
}

void contribute(const Effect& e, HeatBalance& balance) {
  const double conductance_W_K = e["conductance"];
  const std::string to = e.references.at("to").name;
  Law conductance([=](const Inputs&) { return conductance_W_K; });
  if (goes_with_spindle(e)) {
    conductance.value = [=, turns = turns_or_has(60.0 * e["runs_on"])](const Inputs& u) {
      return turns(u.drive) ? conductance_W_K : 0.0;
    };
  }
  const std::string name = e.name() + " - " + to + (goes_with_spindle(e) ? " with the spindle" : "");
  balance.exchanges.push_back(make_link(name, e.body(), std::move(conductance), to));
}

void change_drive(const Effect& e, DriveChange& change) {
  if (goes_with_spindle(e)) add_run_on(60.0 * e["runs_on"], change);
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.body() == e.references.at("to")) in.fail("to", "a link joins two bodies");
  if (e["runs_on"] > 0.0 && !goes_with_spindle(e))
    in.fail("runs_on", "this key is allowed only for what goes with the spindle: `runs: while_spindle_turns`");
}

/// True for air that films exchange heat with. Regions exchange heat with it by films of their surfaces, which have their
/// own doubts.
bool is_air_of_films(const DoubtScene& s, const Body& body) {
  return std::any_of(s.balance.exchanges.begin(), s.balance.exchanges.end(),
                     [&](const Exchange& e) { return e.body.kind == BodyKind::kSurface && node(e.surrounding) == body; });
}

/// A fan that runs with the spindle, and perhaps for a while after it has stopped.
void doubt_fan(const DoubtScene& s, const Body& body, std::vector<Doubt>& list) {
  const double typical_W_K = s.typical_conductance_W_K();
  Doubt fan{.finding = "forced_convection",
            .where = {},
            .law = "a fan that runs while the spindle turns",
            .added = {make_effect("link", body, {{"conductance", 0.0}})},
            .numbers = {doubted("conductance", "W/K", 2.0 * typical_W_K, 0.05 * typical_W_K)},
            .trial = kTrial * typical_W_K};
  fan.numbers[0].low = 0.0;
  fan.added[0].references["to"] = ambient_node();
  fan.added[0].words["runs"] = "while_spindle_turns";
  fan.where = where_of(fan.added[0]);
  list.push_back(fan);
  fan.law += " and some minutes more";
  fan.added[0].set("runs_on", kUsualRunOn_min);
  fan.numbers.push_back(doubted_run_on(kUsualRunOn_min));
  fan.grid = {{-1.0}, {0.0}, {1.0}};
  list.push_back(std::move(fan));
}

/// Oil, chips or a belt that carry heat from one body to another while the spindle turns.
Doubt carried(const DoubtScene& s, const Body& from, const Body& to) {
  const double typical_W_K = s.typical_conductance_W_K();
  Doubt d{.finding = "link",
          .where = {},
          .law = "a path of heat while the spindle turns",
          .added = {make_effect("link", from, {{"conductance", 0.0}})},
          .numbers = {doubted("conductance", "W/K", 2.0 * typical_W_K, 0.05 * typical_W_K)},
          .trial = kTrial * typical_W_K,
          .rarity = kRare,
          .is_built_in = true};
  d.numbers[0].low = 0.0;
  d.added[0].references["to"] = to;
  d.added[0].words["runs"] = "while_spindle_turns";
  d.where = where_of(d.added[0]);
  return d;
}

/// Paths between two bodies that are not joined: nodes with each other, with the ambient, and with regions; paths between
/// any two nodes that exist while the spindle turns; and fans.
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
      if (is_node && to.kind == BodyKind::kNode && is_small && s.starts_and_stops) list.push_back(carried(s, from, to));
      if (to.kind != BodyKind::kNode || are_joined(s, from, to)) continue;
      if (!is_node && is_air_of_films(s, to)) continue;
      if (is_small || have_common_neighbour(s, from, to)) add(from, to);
    }
    // A region loses heat to the ambient by films.
    if (is_node && !are_joined(s, from, ambient_node())) add(from, ambient_node());
    if (is_node && s.starts_and_stops) doubt_fan(s, from, list);
  }
  return list;
}

EffectKind kind() {
  return {.key = "link",
          .title = "conductance between a body and a lumped node or the ambient",
          .law =
              "Q = conductance (T - T_to), spread evenly over the region or surface; of a fan, while the spindle turns and "
              "for runs_on after it has stopped",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters = {{"conductance", "W/K", 0.0, 1e9, {}, "total conductance", 0.1, "contact"},
                         {"runs_on", "min", 0.0, 1e4, 0.0, "for how long a fan runs on when the spindle has stopped"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .change_drive = change_drive,
          .references = {{"to", {BodyKind::kNode}, {}, "lumped node at the other end, or ambient"}},
          .choices =
              {{"runs", {"always", "while_spindle_turns"}, "always", "when it exchanges: a fan that goes with the spindle"}},
          .check = check,
          .doubts = doubts,
          .exchange_finding = "contact"};
}

}  // namespace driftwright::effects::body_link
