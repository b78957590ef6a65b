#include "blind/drawn.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftwright::blind {
namespace {

using effects::Place;

/// Places of the nominal effects of a kind.
std::vector<std::string> places_of(const Subject& s, const std::string& key, bool of_ambient_alone = false) {
  std::vector<std::string> list;
  for (const effects::Effect& e : s.model.effects) {
    if (e.kind->key != key) continue;
    if (of_ambient_alone && e.references.contains("surrounding") &&
        e.references.at("surrounding").name != effects::kAmbientName)
      continue;
    list.push_back(e.place);
  }
  return list;
}

/// Joints, or the ends "a,b" of links.
std::vector<std::string> contacts_of(const Subject& s) {
  std::vector<std::string> list = places_of(s, "contact");
  for (const effects::Effect& e : s.model.effects) {
    if (e.kind->key == "link") list.push_back(e.place + "," + e.references.at("to").name);
  }
  return list;
}

/// Lumped bodies of known mass; the medium of a tank is a dimension.
std::vector<std::string> bodies_of(const Subject& s) {
  std::vector<std::string> list = places_of(s, "node");
  list.insert(list.end(), s.placed.mesh.regions.begin(), s.placed.mesh.regions.end());
  return list;
}

std::vector<std::string> without(std::vector<std::string> list, const std::vector<std::string>& taken) {
  std::erase_if(list, [&](const std::string& name) { return std::find(taken.begin(), taken.end(), name) != taken.end(); });
  return list;
}

/// All heat at 0.7 of the top speed [W].
double heat_W(const Subject& s) {
  double sum_W = 0.0;
  for (const effects::HeatInput& h : effects::heat_balance(s.model.effects).heats) {
    const effects::Inputs u{.drive = {.speed_rpm = 0.7 * s.top_speed_rpm},
                            .ambient_K = 0.0,
                            .time_s = 0.0,
                            .probe_K = std::vector<double>(h.power_W.probes.size(), 305.0)};
    sum_W += std::abs(h.power_W(u));
  }
  return sum_W;
}

Cyclogram draw_drive(const std::string& name, double top_rpm, Random& random) {
  Cyclogram drive{.name = name, .sections = {}};
  const int n = 4 + random.below(5), stop = 1 + random.below(n - 1);
  const double total_min = random.uniform(150.0, 360.0);
  std::vector<double> shares;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += shares.emplace_back(random.uniform(0.5, 1.5));
  double before_rpm = -1.0;
  for (int i = 0; i < n; ++i) {
    double speed_rpm = 0.0;
    if (i != stop && !(i > 0 && random.chance(0.1) && before_rpm > 0.0)) {
      do speed_rpm = top_rpm * std::round(random.uniform(0.2, 1.0) * 20.0) / 20.0;
      while (std::abs(speed_rpm - before_rpm) < 0.15 * top_rpm);
    }
    before_rpm = speed_rpm;
    const double length_s = 300.0 * std::max(2.0, std::round(total_min * shares[static_cast<std::size_t>(i)] / sum / 5.0));
    drive.sections.push_back({length_s, {.speed_rpm = speed_rpm}});
  }
  return drive;
}

/// A time within the middle of a record, on a full minute.
double draw_time_s(const CasePlan& plan, int record, Random& random) {
  return 60.0 *
         std::round(random.uniform(0.2, 0.7) * plan.records[static_cast<std::size_t>(record)].drive.duration_s() / 60.0);
}

}  // namespace

const char* class_name(CaseClass of) {
  constexpr std::array<const char*, 5> kNames = {"one", "two", "none", "outside", "confounded"};
  return kNames[static_cast<std::size_t>(of)];
}

CaseClass class_of(std::uint64_t seed) {
  // o: one, t: two, n: none, x: outside, c: confounded
  if (seed >= kFirstOfLater) return CaseClass::kOne;
  constexpr const char* kOrder = "otnoxtnocotntonxtonotcnotxnotonxtoncotxn";
  switch (kOrder[seed % 40]) {
    case 'o':
      return CaseClass::kOne;
    case 't':
      return CaseClass::kTwo;
    case 'n':
      return CaseClass::kNone;
    case 'x':
      return CaseClass::kOutside;
    default:
      return CaseClass::kConfounded;
  }
}

std::size_t subject_of(std::uint64_t seed) {
  if (seed >= kFirstOfLater) return 2 * (seed % 4);  // lumped machines
  return static_cast<std::size_t>((seed + seed / 40) % subject_names().size());
}

double AmbientCurve::at(double time_s) const {
  return start_K + ramp_K_s * time_s +
         sine_K * (std::sin(2.0 * std::numbers::pi * time_s / period_s + phase) - std::sin(phase));
}

AmbientCurve draw_ambient(double duration_s, Random& random) {
  const double range_K = random.uniform(1.0, 3.0);
  const double share = random.uniform(0.3, 0.8);
  return {.start_K = random.uniform(-0.4, 0.6),
          .ramp_K_s = random.sign() * share * range_K / duration_s,
          .sine_K = 0.5 * (1.0 - share) * range_K,
          .period_s = random.uniform(5400.0, 14400.0),
          .phase = random.uniform(0.0, 2.0 * std::numbers::pi)};
}

double Noise::total() const {
  return std::sqrt(white * white + slow * slow + quantum * quantum / 12.0);
}

double Noise::against_slow(double interval_s) const {
  const double kept = std::exp(-interval_s / slow_s);
  return std::sqrt(white * white + quantum * quantum / 12.0 + slow * slow * (1.0 + kept) / (1.0 - kept));
}

CasePlan draw_plan(const Subject& s, std::uint64_t seed) {
  CasePlan plan{.seed = seed, .of = class_of(seed), .records = {}, .noise = {}, .confusable = {}, .confusion = {}};
  Random drives(seed, 1), noises(seed, 2);
  for (const char* name : {"measured_1", "measured_2", "holdout"}) {
    RecordPlan record{name, draw_drive(name, s.top_speed_rpm, drives), {}};
    record.ambient = draw_ambient(record.drive.duration_s(), drives);
    plan.records.push_back(std::move(record));
  }
  const bool is_slow = noises.chance(1.0 / 3.0), is_rounded = noises.chance(1.0 / 3.0);
  const double um = noises.chance(0.5) ? 0.1 : 1.0;
  for (std::size_t i = 0; i < s.n_outputs(); ++i) {
    const bool is_temperature = i < s.n_sensors();
    Noise noise{.white = is_temperature ? noises.uniform(0.03, 0.1) : noises.uniform(0.2, 0.6)};
    if (is_slow) {
      noise.slow = is_temperature ? noises.uniform(0.02, 0.05) : noises.uniform(0.1, 0.3);
      noise.slow_s = noises.uniform(120.0, 360.0);
    }
    if (is_rounded) noise.quantum = is_temperature ? 0.1 : um;
    plan.noise.push_back(noise);
  }
  return plan;
}

namespace {

/// What may be hidden, by key of the catalogue: one vote per key, then per law.
std::vector<std::vector<Hide>> hideable(const Subject& s, const CasePlan& plan) {
  std::vector<std::vector<Hide>> keys = {{Hide::kHeatConstant, Hide::kHeatOfSpeed},
                                         {Hide::kFrictionExponent, Hide::kFrictionDecay},
                                         {Hide::kContactFactor},
                                         {Hide::kAmbientOffset, Hide::kAmbientRamp, Hide::kAmbientStep},
                                         {Hide::kCoolant},
                                         {Hide::kHeatCapacity},
                                         {Hide::kSpindleGrowth},
                                         {Hide::kCentrifugal},
                                         {Hide::kMountShift},
                                         {Hide::kSensorBias},
                                         {Hide::kSensorLag},
                                         {Hide::kSensorDrift},
                                         {Hide::kSensorDetached},
                                         {Hide::kSensorSwap},
                                         {Hide::kClockOffset},
                                         {Hide::kSpeedOverride},
                                         {Hide::kMissingStop}};
  if (!s.is_lumped()) {
    keys.push_back({Hide::kFilmFactor, Hide::kDraught});
    keys.push_back({Hide::kForcedFactor, Hide::kForcedNew});
    keys.push_back({Hide::kStratification});
    keys.push_back({Hide::kRadiation});
    keys.push_back({Hide::kConductivity});
    keys.push_back({Hide::kExpansion});
  }
  if (plan.seed >= kFirstOfLater) return {{Hide::kProbeLag}, {Hide::kCoolantHeld}, {Hide::kDoorOpen}};
  return keys;
}

/// A time in the longest section that turns [s]. @return 0 without one
double within_longest_turn_s(const Cyclogram& drive, Random& random) {
  double start_s = 0.0, longest_s = 0.0, time_s = 0.0;
  for (const auto& section : drive.sections) {
    if (section.drive.speed_rpm > 0.0 && section.duration_s > longest_s) {
      longest_s = section.duration_s;
      time_s = start_s + 60.0 * std::floor(random.uniform(0.2, 0.5) * longest_s / 60.0);
    }
    start_s += section.duration_s;
  }
  return time_s;
}

}  // namespace

// One case a law, each with its places and its sizes: a table, which is longer than a screen.
Hidden draw_hidden(const Subject& s, const CasePlan& plan, Random& random) {
  const std::vector<std::string> bodies = bodies_of(s), bearings = places_of(s, "bearing_friction"),
                                 films = places_of(s, "convection"), open_films = places_of(s, "convection", true),
                                 forced = places_of(s, "forced_convection"), still = without(open_films, forced),
                                 contacts = contacts_of(s);
  std::vector<std::string> sensors, displacements;
  for (const auto& sensor : s.model.sensors) sensors.push_back(sensor.name);
  for (const auto& d : s.model.displacements) displacements.push_back(d.name);
  const double all_W = heat_W(s), ln_least = std::log(1.0 / 0.65);

  Hidden h;
  h.what = random.one_of(random.one_of(hideable(s, plan)));
  const auto sized = [&](const std::vector<std::string>& places, double low, double high, double sign) {
    h.where = random.one_of(places);
    h.low = low;
    h.high = high;
    h.size = sign * std::sqrt(low * high);
  };
  const auto at_a_time = [&] {
    h.record = random.below(static_cast<int>(plan.n_measured()));
    h.time_s = draw_time_s(plan, h.record, random);
  };
  const double sign = random.sign();
  switch (h.what) {
    case Hide::kHeatConstant:
      sized(bodies, 2.0, all_W, 1.0);
      break;
    case Hide::kHeatOfSpeed:
      sized(bodies, 2.0, 1.5 * all_W, 1.0);
      h.at_speed_rpm = s.top_speed_rpm;
      h.exponent = random.uniform(0.8, 2.2);
      break;
    case Hide::kFrictionExponent:
      sized(bearings, 0.25, 1.2, sign);
      h.at_speed_rpm = 0.5 * s.top_speed_rpm;
      break;
    case Hide::kFrictionDecay:
      sized(bearings, 0.004, 0.08, 1.0);
      break;
    case Hide::kFilmFactor:
      sized(films, ln_least, 1.6, sign);
      break;
    case Hide::kDraught:
      sized(open_films, 2.0, 80.0, 1.0);
      at_a_time();
      break;
    case Hide::kForcedFactor:
      sized(forced, ln_least, 1.6, sign);
      break;
    case Hide::kForcedNew:
      sized(still, 2.0, 80.0, 1.0);
      h.at_speed_rpm = s.top_speed_rpm;
      h.exponent = random.uniform(0.6, 0.9);
      break;
    case Hide::kContactFactor:
      sized(contacts, ln_least, 2.0, sign);
      break;
    case Hide::kAmbientOffset:
      sized({effects::kAmbientName}, 0.2, 6.0, sign);
      break;
    case Hide::kAmbientRamp:
      sized({effects::kAmbientName}, 0.1, 3.0, sign);
      break;
    case Hide::kAmbientStep:
      sized({effects::kAmbientName}, 0.3, 6.0, sign);
      at_a_time();
      break;
    case Hide::kStratification:
      sized({effects::kAmbientName}, 0.2, 6.0, 1.0);
      break;
    case Hide::kRadiation:
      sized(open_films, 3.0, 0.8 * all_W, 1.0);
      break;
    case Hide::kCoolant:
      sized(bodies, 2.0, 0.8 * all_W, 1.0);
      break;
    case Hide::kConductivity:
      sized(s.placed.mesh.regions, ln_least, 1.2, sign);
      break;
    case Hide::kHeatCapacity:
      sized(bodies, ln_least, 1.2, sign);
      break;
    case Hide::kExpansion:
      sized(s.placed.mesh.regions, ln_least, 0.9, sign);
      break;
    case Hide::kSpindleGrowth:
      sized(displacements, 0.3, 60.0, sign);
      h.at_speed_rpm = s.top_speed_rpm;
      h.lag_s = random.uniform(300.0, 1500.0);
      break;
    case Hide::kCentrifugal:
      sized(displacements, 0.3, 50.0, sign);
      h.at_speed_rpm = s.top_speed_rpm;
      break;
    case Hide::kMountShift:
      sized(displacements, 0.3, 60.0, sign);
      at_a_time();
      break;
    case Hide::kProbeLag:
      sized(displacements, 0.3, 60.0, sign);
      break;
    case Hide::kCoolantHeld:
      sized(bodies, 0.2, 0.2 * all_W, 1.0);
      h.lag_s = random.uniform(0.0, 8.0);
      break;
    case Hide::kDoorOpen:
      sized(places_of(s, "node"), 0.2, 0.4 * all_W, 1.0);
      at_a_time();
      h.lag_s = 60.0 * std::round(random.uniform(15.0, 60.0));
      break;
    case Hide::kSensorBias:
      sized(sensors, 0.05, 5.0, sign);
      break;
    case Hide::kSensorLag:
      sized(sensors, 30.0, 1200.0, 1.0);
      break;
    case Hide::kSensorDrift:
      sized(sensors, 0.02, 2.0, sign);
      break;
    case Hide::kSensorDetached:
      sized(sensors, 0.05, 0.9, 1.0);
      at_a_time();
      break;
    case Hide::kSensorSwap: {
      const std::string a = random.one_of(sensors), b = random.one_of(without(sensors, {a}));
      sized({std::min(a, b) + "," + std::max(a, b)}, 1.0, 1.0, 1.0);
      break;
    }
    case Hide::kClockOffset:
      sized({"clock"}, 20.0, 590.0, sign);
      break;
    case Hide::kSpeedOverride:
      sized({"spindle"}, 0.03, 0.35, sign);
      break;
    default:  // a stop while it turns: the longest section that does
      sized({"spindle"}, 120.0, 2400.0, 1.0);
      h.what = Hide::kMissingStop;
      h.record = random.below(static_cast<int>(plan.n_measured()));
      h.time_s = within_longest_turn_s(plan.records[static_cast<std::size_t>(h.record)].drive, random);
  }
  return h;
}

Hidden draw_foreign(const Subject& s, Random& random) {
  Hidden h;
  h.what = random.one_of<Hide>({Hide::kOscillatingHeat, Hide::kTravelCreep, Hide::kAcceleratingHeat});
  const double all_W = heat_W(s);
  if (h.what == Hide::kTravelCreep) {
    h.where = random.one_of(s.model.displacements).name;
    h.low = 0.3;
    h.high = 40.0;
  } else {
    h.where = random.one_of(bodies_of(s));
    h.lag_s = 60.0 * std::round(random.uniform(25.0, 70.0));
    const bool oscillates = h.what == Hide::kOscillatingHeat;
    h.low = oscillates ? 2.0 : 100.0 / s.top_speed_rpm;
    h.high = oscillates ? 2.0 * all_W : 3600.0 * all_W / s.top_speed_rpm;
  }
  h.size = std::sqrt(h.low * h.high);
  return h;
}

std::vector<Hidden> draw_confounded(const Subject& s, CasePlan& plan, Random& random) {
  const double least = std::log(1.0 / 0.65), ln_size = random.sign() * random.uniform(least, 0.9);
  const auto factor = [&](Hide what, const std::string& where) {
    return Hidden{.what = what, .where = where, .size = ln_size, .low = least, .high = 1.6};
  };
  const auto one_speed = [&] {  // one long record without a stop; the holdout stays as it is
    RecordPlan& record = plan.records.front();
    const double speed_rpm = s.top_speed_rpm * std::round(random.uniform(0.4, 1.0) * 20.0) / 20.0;
    record.drive.sections = {{360.0 * 60.0, {.speed_rpm = speed_rpm}}};
    plan.records.erase(plan.records.begin() + 1);
  };
  const auto bodies = bodies_of(s);
  const int kind = random.below(s.is_lumped() ? 3 : 5);
  if (kind == 0) {
    one_speed();
    plan.confusion = "heat or its way out, at one speed";
    const std::string body = random.one_of(bodies);
    Hidden h{.what = Hide::kHeatConstant, .where = body, .low = 2.0, .high = heat_W(s)};
    h.size = std::sqrt(h.low * h.high);
    plan.confusable = {"convection *",   "contact *",           "heat_source *",
                       "friction_law *", "forced_convection *", "speed_override spindle"};
    return {h};
  }
  if (kind == 1) {
    one_speed();
    plan.confusion = "load or viscosity of a bearing, at one speed";
    const std::string bearing = random.one_of(places_of(s, "bearing_friction"));
    Hidden h{
        .what = Hide::kFrictionExponent, .where = bearing, .low = 0.25, .high = 1.2, .at_speed_rpm = 0.4 * s.top_speed_rpm};
    h.size = random.sign() * 0.6;
    plan.confusable = {"heat_source " + bearing, "coolant " + bearing, "speed_override spindle"};
    return {h};
  }
  if (kind == 2) {
    plan.confusion = "a joint or its neighbour";
    const std::string bearing = random.one_of(places_of(s, "bearing_friction"));
    std::vector<std::string> near;
    for (const std::string& c : contacts_of(s)) {
      const auto cut = c.find_first_of(",/");
      if (c.substr(0, cut) == bearing || c.substr(cut + 1) == bearing) near.push_back(c);
    }
    const std::string joint = random.one_of(near);
    for (const std::string& c : without(near, {joint})) plan.confusable.push_back("contact " + c);
    return {factor(Hide::kContactFactor, joint)};
  }
  const std::string region = random.one_of(s.placed.mesh.regions);
  if (kind == 3) {
    plan.confusion = "capacity and conductivity by one factor";
    plan.confusable = {"conductivity " + region, "heat_capacity " + region};
    return {factor(Hide::kConductivity, region), factor(Hide::kHeatCapacity, region)};
  }
  plan.confusion = "expansion seen by displacements alone";
  plan.displacements_only = true;
  plan.confusable = {"expansion *", "heat_source *", "coolant *", "conductivity *", "convection *", "contact *"};
  return {factor(Hide::kExpansion, region)};
}

}  // namespace driftwright::blind
