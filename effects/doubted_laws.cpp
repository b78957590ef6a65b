#include "effects/doubted_laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "effects/lasting.hpp"

namespace driftwright::effects::changed_law {

constexpr double kOfSolids =
    2.0;                        // nats: a joint of solid bodies does not change within a record, unless someone works on it
constexpr double kLess = -0.4;  // first trial of the logarithm of an exchange's factor
constexpr double kShortest_min = 0.5;  // shortest duration
constexpr double kStirred = 0.75;      // exponent of speed: a film on a turning part, between laminar 0.5 and turbulent 0.8
constexpr double kAtDifference_K = 10.0;
// Exponent of free convection on a plate; the largest, because hot bodies also radiate.
constexpr double kFree = 0.25, kMostOfDifference = 1.5;
constexpr double kLowestExponent = -1.0, kHighestExponent = 4.0;  // limits of the exponent of speed, all laws together

Effect changed(const std::string& law) {
  return make_effect("changed_law", Place::kLaw, law);
}

/// True if a heat follows from a recorded power or column, independent of the spindle: it has its own gain, and no exponent
/// of speed.
bool is_of_record(const DoubtScene& s, const HeatInput& heat) {
  return std::any_of(s.own.begin(), s.own.end(), [&](const Effect& e) {
    return heat.name.starts_with(e.name()) && (e.kind->key == "recorded_drive" || e.kind->key == "cutting_heat");
  });
}

/// True if a heat represents a medium that is warmer than its exchange says.
bool is_of_medium(const DoubtScene& s, const HeatInput& heat) {
  return std::any_of(s.balance.exchanges.begin(), s.balance.exchanges.end(),
                     [&](const Exchange& x) { return heat.name == of_medium(x.name); });
}

/// The heats of a body as written.
struct WrittenHeats {
  std::vector<Effect> all, known;  ///< a change of each; of those that depend on the drive alone
  double known_W = 0.0;            ///< of the latter, at the typical speed
  double exponent = 0.0;           ///< of all together, of speed
};

WrittenHeats written_heats(const DoubtScene& s, const Body& body) {
  WrittenHeats heats;
  double low_W = 0.0, high_W = 0.0;
  const auto power_W = [&](const HeatInput& h, double rpm) {
    return h.power_W(
        Inputs{.drive = {.speed_rpm = rpm}, .probe_K = std::vector<double>(h.power_W.probes.size(), s.reference_K + 10.0)});
  };
  const auto add = [](std::vector<Effect>& to, const std::string& law) {
    if (std::none_of(to.begin(), to.end(), [&](const Effect& e) { return e.place == law; })) to.push_back(changed(law));
  };
  for (const HeatInput& h : s.balance.heats) {
    if (!(h.body == body) || !h.power_W.thermostat.empty() || is_of_record(s, h) || is_of_medium(s, h)) continue;
    add(heats.all, h.name);
    low_W += power_W(h, 0.97 * s.typical_rpm);
    high_W += power_W(h, 1.03 * s.typical_rpm);
    if (!h.power_W.probes.empty()) continue;
    add(heats.known, h.name);
    heats.known_W += power_W(h, s.typical_rpm);
  }
  for (Effect& e : heats.all) {
    e.set("at_speed", s.typical_rpm);
    e.set("at_temperature", s.reference_K);
  }
  if (low_W > 0.0 && high_W > 0.0) heats.exponent = std::log(high_W / low_W) / std::log(1.03 / 0.97);
  return heats;
}

/// Another power of the heats that depend on the drive alone.
Doubt of_power(const DoubtScene& s, const Body& body, const WrittenHeats& heats) {
  DoubtedNumber more = doubted("power", "W", s.unknown_heat_W(), 0.1 * s.unknown_heat_W());
  more.low = -0.95 * heats.known_W;
  more.set = [written_W = heats.known_W](std::span<Effect> added, double value) {
    for (Effect& e : added) e.set("factor", 1.0 + value / written_W);
  };
  return {.finding = "heat_source",
          .where = body.name,
          .law = fmt::format("the law written, at {:.0f} rpm", s.typical_rpm),
          .added = heats.known,
          .numbers = {more},
          .trial = more.step,
          .at_speed_rpm = s.typical_rpm};
}

/// Another exponent of speed, with the size as written and with another.
void add_growth_with_speed(const DoubtScene& s, Doubt friction, double written, std::vector<Doubt>& list) {
  DoubtedNumber exponent = doubted("exponent", "1", 0.5, 0.05, written);
  exponent.low = kLowestExponent;
  exponent.high = kHighestExponent;
  exponent.set = [written](std::span<Effect> added, double value) {
    for (Effect& e : added) e.set("exponent", value - written);
  };
  friction.at_speed_rpm = s.typical_rpm;
  friction.law = fmt::format("another growth with speed, the same at {:.0f} rpm", s.typical_rpm);
  friction.numbers = {exponent};
  list.push_back(friction);
  friction.law = fmt::format("another heat and another growth with speed, at {:.0f} rpm", s.typical_rpm);
  friction.numbers = {doubted_factor(), exponent};
  friction.grid = {{0.0}, {0.4}, {-0.4}};
  list.push_back(friction);
}

/// Another growth beyond a speed: a film that starves, a motor above its base speed, a seal that lifts off.
Doubt that_bends(const DoubtScene& s, const Doubt& friction) {
  Doubt bends = friction;
  bends.law = "heat that grows by another share beyond a speed; 0: it levels off";
  bends.at_speed_rpm = 0.0;
  DoubtedNumber share = doubted("growth_beyond", "1", 1.0, 0.1, 1.0);
  share.low = -3.0;
  share.high = 5.0;
  DoubtedNumber beyond = doubted("beyond", "rpm", 0.3 * s.top_rpm, 0.01 * s.top_rpm, 0.6 * s.top_rpm);
  beyond.low = 0.1 * s.top_rpm;
  beyond.high = 0.95 * s.top_rpm;
  bends.numbers = {share, beyond};
  bends.trial = -0.5;
  bends.grid.clear();
  for (const double of_top : {0.25, 0.4, 0.55, 0.7, 0.85}) bends.grid.push_back({(of_top - 0.6) * s.top_rpm});
  return bends;
}

/// Another size below a speed: a gear stage, a switched winding, a geared pump.
void add_stages(const DoubtScene& s, const Doubt& friction, std::vector<Doubt>& list) {
  for (const double rpm : s.speed_steps_rpm) {
    Doubt stage = friction;
    stage.law = fmt::format("heat by another factor below {:.0f} rpm", rpm);
    stage.at_speed_rpm = 0.0;
    for (Effect& e : stage.added) e.set("below", rpm);
    stage.numbers = {doubted_factor()};
    stage.numbers.front().name = "factor_below";
    stage.grid = {{}};
    list.push_back(std::move(stage));
  }
}

/// Preload that grows, or is lost, when the inner ring is warmer than the housing.
void add_preloads(const DoubtScene& s, const Body& body, const Doubt& friction, std::vector<Doubt>& list) {
  std::vector<Body> neighbours;
  std::copy_if(s.bodies.begin(), s.bodies.end(), std::back_inserter(neighbours),
               [&](const Body& other) { return !(other == body) && are_joined(s, body, other); });
  for (const Body& other : neighbours) {
    Doubt preload = friction;
    preload.law = fmt::format("heat that falls as its body becomes warmer than {}; < 0: it grows", other.name);
    preload.rarity = std::log(static_cast<double>(neighbours.size()));
    for (Effect& e : preload.added) {
      e = changed(e.place);
      e.references["over"] = other;
    }
    list.push_back(std::move(preload));
  }
}

/// Another size, growth with speed or decay of the heats of a body.
void doubt_heat(const DoubtScene& s, const Body& body, std::vector<Doubt>& list) {
  constexpr double kLeastExponent = 0.05;  // below it a heat does not depend on speed
  const WrittenHeats heats = written_heats(s, body);
  if (heats.all.empty()) return;
  if (heats.known_W > 0.0) list.push_back(of_power(s, body, heats));
  const bool grows = heats.exponent > kLeastExponent;
  Doubt friction{.finding = "friction_law", .where = body.name, .law = {}, .added = heats.all, .numbers = {}};
  if (grows) {
    add_growth_with_speed(s, friction, heats.exponent, list);
    list.push_back(that_bends(s, friction));
  }
  add_stages(s, friction, list);
  friction.law = "heat that falls as its body warms";
  friction.at_speed_rpm = 0.0;
  friction.numbers = {doubted("decay", "1/K", 0.02, 0.002)};
  friction.trial = 0.01;
  friction.grid = {{}};
  list.push_back(friction);
  if (grows) add_preloads(s, body, friction, list);
}

/// True if air or a medium takes part, which a door, a fan or a valve changes within minutes.
bool is_of_air(const DoubtScene& s, const Exchange& exchange) {
  if (exchange.surrounding == kAmbientName || exchange.medium_K || exchange.body.kind == BodyKind::kSurface) return true;
  return std::any_of(s.own.begin(), s.own.end(), [&](const Effect& e) {
    return e.kind->key == "air_node" && (e.place == exchange.surrounding || e.place == exchange.body.name);
  });
}

/// Less of an exchange for a while: a fan that is off, a circuit with less flow, a cover. More of one is an
/// `exchange_window`.
void add_less_for_a_while(const DoubtScene& s, const Doubt& other, std::vector<Doubt>& list) {
  for (const DoubtScene::Run& run : s.runs) {
    Doubt less = other;
    less.law = fmt::format("less of it for a while, in {}", run.name);
    less.added.front().in = run.name;
    less.numbers.front().high = 1.0;
    less.trial = kLess;
    less.numbers.push_back(
        doubted_time("begin", run.length_s, [](std::span<Effect> added, double value) { added[0].from_s = value; }));
    const double usual_min = run.length_s / 60.0 / 6.0;
    DoubtedNumber length{
        .name = "length", .unit = "min", .nominal = usual_min, .prior_sd = 1.0, .step = 0.05, .is_log = true};
    length.set = [](std::span<Effect> added, double value) {
      added[0].until_s = added[0].from_s + 60.0 * std::max(kShortest_min, value);
    };
    less.numbers.push_back(std::move(length));
    less.grid.clear();
    for (const std::vector<double>& begin : time_grid(run.length_s, 10)) {
      for (const double x : {-0.5, 0.6}) less.grid.push_back({begin.front(), x});
    }
    list.push_back(std::move(less));
  }
}

/// Another coefficient of an exchange: in all records, in one or from one on, or in one record from a time on.
void doubt_exchange(const DoubtScene& s, const std::string& finding, const Exchange& exchange, std::vector<Doubt>& list) {
  const bool is_growth = finding == "forced_convection";
  const std::string what = is_growth                                  ? "another growth of the film"
                           : exchange.body.kind == BodyKind::kSurface ? "another film"
                                                                      : "another conductance";
  const bool is_listed =
      std::any_of(list.begin(), list.end(), [&](const Doubt& d) {  // exchanges of one name change together
        return d.finding == finding && d.added.front().place == exchange.name && d.law == what;
      });
  if (is_listed) return;
  Doubt other{.finding = finding,
              .where = where_of(exchange),
              .law = what,
              .added = {changed(exchange.name)},
              .numbers = {doubted_factor()}};
  if (is_growth) {
    list.push_back(other);
    return;
  }
  add_in_some_runs(s, other, list);  // changed between two records
  add_from_a_time_on(s, other, "time", is_of_air(s, exchange) ? 0.0 : kOfSolids, list);
  if (is_of_air(s, exchange)) add_less_for_a_while(s, other, list);
}

/// True if the heat of a turning part enters one of the two: a bearing, whose film conducts better at higher speed.
bool has_heat_of_speed(const DoubtScene& s, const Exchange& exchange) {
  return std::any_of(s.balance.heats.begin(), s.balance.heats.end(), [&](const HeatInput& h) {
    if (!(h.body == exchange.body) && h.body.name != exchange.surrounding) return false;
    const auto power_W = [&](double rpm) {
      return h.power_W(
          Inputs{.drive = {.speed_rpm = rpm}, .probe_K = std::vector<double>(h.power_W.probes.size(), s.reference_K)});
    };
    return h.power_W.thermostat.empty() && power_W(s.typical_rpm) != power_W(0.0);
  });
}

/// Air stirred by a turning part, or the film in a bearing: an exchange written as constant that grows with speed. The
/// growth is added to its value at standstill, or, for air, is a power of the speed while it turns. Films of surfaces have
/// `forced_convection`.
void doubt_stirred(const DoubtScene& s, const std::string& finding, const Exchange& exchange, std::vector<Doubt>& list) {
  const bool is_of_air_there = is_of_air(s, exchange);
  if (!s.turns || exchange.body.kind == BodyKind::kSurface || exchange.per == Per::kArea ||
      !exchange.coefficient.probes.empty() ||
      exchange.coefficient(Inputs{.drive = {.speed_rpm = s.typical_rpm}}) != exchange.coefficient(Inputs{})) {
    return;
  }
  Doubt grows{.finding = is_of_air_there ? "forced_convection" : finding,
              .where = where_of(exchange),
              .law = fmt::format("a conductance that grows with speed, by so much of itself at {:.0f} rpm", s.typical_rpm),
              .added = {changed(exchange.name)},
              .numbers = {doubted("growth", "1", 1.0, 0.1), doubted("exponent", "1", 0.5, 0.05, kStirred)},
              .trial = 0.2,
              .grid = {{0.0}, {kStirred}},
              .at_speed_rpm = s.typical_rpm,
              .rarity = is_of_air_there || has_heat_of_speed(s, exchange) ? 0.0 : kOfSolids};
  const bool is_listed = std::any_of(list.begin(), list.end(), [&](const Doubt& d) {
    return d.finding == grows.finding && d.added.front().place == exchange.name && d.law == grows.law;
  });
  if (is_listed) return;
  grows.added[0].set("at_speed", s.typical_rpm);
  grows.numbers[0].low = 0.0;
  grows.numbers[1].low = 0.3;
  grows.numbers[1].high = 3.0;
  grows.numbers[1].set = [](std::span<Effect> added, double value) { added[0].set("growth_exponent", value); };
  list.push_back(grows);
  if (!is_of_air_there) return;
  grows.law =
      fmt::format("a conductance that follows a power of the speed while it turns, the same but for a factor at {:.0f} rpm",
                  s.typical_rpm);
  grows.numbers = {doubted("exponent", "1", 0.5, 0.05), doubted_factor()};
  grows.numbers[0].low = kLowestExponent;
  grows.numbers[0].high = kHighestExponent;
  grows.grid = {{0.0}, {0.4}, {-0.4}};
  list.push_back(std::move(grows));
}

/// A fit that tightens when its inner part is warmer than its outer one: an exchange of two bodies written as constant that
/// depends on their difference.
void doubt_fit(const DoubtScene& s, const std::string& finding, const Exchange& exchange, std::vector<Doubt>& list) {
  if (is_of_air(s, exchange) || exchange.body.kind != BodyKind::kNode || !exchange.coefficient.probes.empty() ||
      exchange.coefficient(Inputs{.drive = {.speed_rpm = s.typical_rpm}}) != exchange.coefficient(Inputs{}))
    return;
  Doubt tightens{.finding = finding,
                 .where = where_of(exchange),
                 .law = fmt::format("a conductance that falls as {} becomes warmer than {}; < 0: it grows",
                                    exchange.body.name, exchange.surrounding),
                 .added = {changed(exchange.name)},
                 .numbers = {doubted("decay", "1/K", 0.02, 0.002)},
                 .trial = 0.01,
                 .rarity = kOfSolids};
  tightens.added[0].references["over"] = node(exchange.surrounding);
  const bool is_listed = std::any_of(list.begin(), list.end(), [&](const Doubt& d) {
    return d.finding == finding && d.added.front().place == exchange.name && d.law == tightens.law;
  });
  if (!is_listed) list.push_back(std::move(tightens));
}

/// Free convection or radiation: an exchange of a lumped body with the ambient, written as constant, that grows with the
/// temperature difference.
void doubt_free(const Exchange& exchange, std::vector<Doubt>& list) {
  if (exchange.surrounding != kAmbientName || exchange.medium_K || exchange.per == Per::kArea ||
      exchange.body.kind != BodyKind::kNode || !exchange.coefficient.probes.empty())
    return;
  Doubt free{
      .finding = "natural_convection",
      .where = where_of(exchange),
      .law = fmt::format("a conductance that follows a power of the temperature difference, the same but for a factor at "
                         "{:.0f} K",
                         kAtDifference_K),
      .added = {changed(exchange.name)},
      .numbers = {doubted("difference_exponent", "1", kFree, 0.1 * kFree), doubted_factor()},
      .trial = 0.4 * kFree,
      .rarity = kOfSolids};
  free.added[0].set("at_difference", kAtDifference_K);
  free.numbers[0].low = 0.0;
  free.numbers[0].high = kMostOfDifference;
  const bool is_listed = std::any_of(list.begin(), list.end(), [&](const Doubt& d) {
    return d.finding == free.finding && d.added.front().place == exchange.name;
  });
  if (!is_listed) list.push_back(std::move(free));
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const Body& body : s.bodies) doubt_heat(s, body, list);
  for (const Effect& e : s.own) {
    if (e.kind->exchange_finding.empty()) continue;
    bool is_doubted = false;
    for (const Exchange& x : heat_balance({e}).exchanges) {
      if (is_doubted && !x.part.is_even()) continue;  // one law, whatever patterns it is made of
      is_doubted = true;
      doubt_exchange(s, e.kind->exchange_finding, x, list);
      doubt_stirred(s, e.kind->exchange_finding, x, list);
      doubt_free(x, list);
      doubt_fit(s, e.kind->exchange_finding, x, list);
    }
  }
  return list;
}

}  // namespace driftwright::effects::changed_law
