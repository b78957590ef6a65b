#include <fmt/format.h>

#include "effects/instrument_groups.hpp"
#include "effects/lasting.hpp"

namespace driftwright::effects::sensor_place {

// Nats: touching bodies also exchange heat; if the scenario has no path between them, two things would have to be wrong at
// once.
constexpr double kTouchWithoutPath = 2.0;

void change_readings(const Effect& e, ReadingChain& chain) {
  const bool turning = e.words.at("acts") == "while_spindle_turns";
  chain.add(ReadingStage::kDetachment,
            [sensor = e.place, share = e["share"], body = e.references.at("body"), turning](Readings& r) {
              const Eigen::Index row = r.sensor(sensor);
              const bool is_ambient = body == ambient_node();
              const Eigen::RowVectorXd there =
                  is_ambient ? Eigen::RowVectorXd() : Eigen::RowVectorXd(r.value.row(r.mean_of(body.name)));
              const std::vector<bool> turns = turning ? r.spindle_turns() : std::vector<bool>();
              for (Eigen::Index i = 0; i < r.n_times(); ++i) {
                if (turning && !turns[static_cast<std::size_t>(i)]) continue;
                r.value(row, i) += share * ((is_ambient ? r.ambient.at(r.time(i)) : there[i]) - r.value(row, i));
              }
            });
}

/// A label on the wrong cable, for sensors on lumped nodes: the sensor is on another body in all records.
Doubt mislabelled(const Effect& place) {
  Doubt d{.finding = "sensor_place",
          .where = place.place,
          .law = "sits on " + place.references.at("body").name + ", not at its place",
          .added = {place},
          .numbers = {doubted("share", "1", 1.0, 1.0)},
          .trial = 1.0,
          .all_or_nothing = true};
  d.added.front().set("share", 1.0);
  d.numbers.front().set = [](std::span<Effect>, double) {};
  return d;
}

/// One doubt per other body, in all records or from one of them on; also for the ambient: a thermometer that never had good
/// contact, or all of them.
std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const std::string& sensor : s.sensors) {
    std::vector<Body> bodies = {ambient_node()};
    for (const DoubtScene::Material& m : s.materials) {
      if (m.stores) bodies.push_back(m.body);
    }
    for (const Body& body : bodies) {
      Effect place = make_effect("sensor_place", Place::kSensor, sensor);
      place.references["body"] = body;
      DoubtedNumber share = doubted("share", "1", 0.4, 0.05);
      share.low = 0.0;
      share.high = 1.0;
      const auto at = s.sensor_bodies.find(sensor);
      const bool may_touch = body == ambient_node() || at == s.sensor_bodies.end() || are_joined(s, at->second, body);
      const Doubt always{.finding = "sensor_place",
                         .where = sensor,
                         .law = fmt::format("sits between its place and {}", body.name),
                         .added = {place},
                         .numbers = {share},
                         .trial = 0.3,
                         .rarity = may_touch ? 0.0 : kTouchWithoutPath};
      list.push_back(always);
      if (s.starts_and_stops) {  // a stream of air from the machine, or oil from another body
        Doubt flown_at = always;
        flown_at.law =
            fmt::format("reads a share of {} while the spindle turns", body == ambient_node() ? "the air" : body.name);
        flown_at.added.front().words["acts"] = "while_spindle_turns";
        flown_at.is_built_in = !(body == ambient_node());
        list.push_back(std::move(flown_at));
      }
      const bool is_elsewhere = at != s.sensor_bodies.end() && !(at->second == body);
      if (is_elsewhere && !(body == ambient_node())) list.push_back(mislabelled(place));
      if (body == ambient_node() && sensor == s.sensors.front()) add_in_groups(s.sensors, always, list);
      for (std::size_t run = 1; run < s.runs.size(); ++run) {  // mounted anew between two records
        Doubt moved = always;
        const bool is_last = run + 1 == s.runs.size();
        moved.when = fmt::format(fmt::runtime(is_last ? "in {}" : "from {} on"), s.runs[run].name);
        moved.added = in_this_and_later_runs(s, run, place);
        list.push_back(std::move(moved));
      }
    }
  }
  return list;
}

EffectKind kind() {
  return {
      .key = "sensor_place",
      .title = "sensor that sits elsewhere than stated: between its place and another body",
      .law =
          "reading = share T_body + (1 - share) T at its place, T_body: mean of the body; at standstill T, where it acts "
          "while_spindle_turns",
      .places = {Place::kSensor},
      .parameters = {{"share", "1", 0.0, 1.0, {}, "of the other body in the reading"}},
      .timing = Timing::kInRecord,
      .change_readings = change_readings,
      .references = {{"body", {BodyKind::kNode, BodyKind::kRegion}, {}, "the other body; `ambient`: the ambient air"}},
      .choices = {{"acts",
                   {"always", "while_spindle_turns"},
                   "always",
                   "when it does: air blows at it, or oil comes from the other body, while the spindle turns"}},
      .doubts = doubts};
}

}  // namespace driftwright::effects::sensor_place
