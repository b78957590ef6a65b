#include <cmath>

#include "effects/instrument_groups.hpp"
#include "effects/lasting.hpp"

namespace driftwright::effects::sensor_bias {

constexpr double kUsualFading = 1.0 / 12.0, kLongestFading = 1.0 / 3.0;  // as shares of the longest record
constexpr double kSlope = 0.03;  // 1 sigma of a wrong scale: a thermocouple of another class, a bridge of another resistor

void change_readings(const Effect& e, ReadingChain& chain) {
  const double fades_s = e.has("fades") ? 60.0 * e["fades"] : kNever_s;
  chain.add(ReadingStage::kError, [sensor = e.place, bias_K = e["bias"], slope = e["slope"], fades_s,
                                   turning = e.words.at("errs") == "while_spindle_turns"](Readings& r) {
    const Eigen::Index row = r.sensor(sensor);
    const std::vector<bool> turns = turning ? r.spindle_turns() : std::vector<bool>();
    for (Eigen::Index i = 0; i < r.n_times(); ++i) {
      if (turning && !turns[static_cast<std::size_t>(i)]) continue;
      r.value(row, i) += bias_K * std::exp(-r.time(i) / fades_s) + slope * r.value(row, i);
    }
  });
}

Doubt constant_error(const std::string& sensor) {
  return {.finding = "sensor_bias",
          .where = sensor,
          .law = "constant error",
          .added = {make_effect("sensor_bias", Place::kSensor, sensor)},
          .numbers = {doubted("bias", "K", 1.0, 0.2)},
          .trial = 0.3};
}

/// An error that fades: an amplifier that warms up, a reference junction that settles.
Doubt fading_error(const DoubtScene& s, const std::string& sensor) {
  Doubt d = constant_error(sensor);
  d.law = "error that fades from the start of each record on";
  DoubtedNumber fades{.name = "fades",
                      .unit = "min",
                      .nominal = kUsualFading * s.longest_s() / 60.0,
                      .prior_sd = 0.7,
                      .step = 0.05,
                      .is_log = true};
  fades.high = kLongestFading * s.longest_s() / 60.0;  // slower fading does not end within the record
  d.added[0].set("fades", fades.nominal);
  d.numbers.push_back(fades);
  d.grid = {{-1.0}, {0.0}, {1.0}};  // of the logarithm of its time constant
  return d;
}

Doubt wrong_scale(const std::string& sensor) {
  return {.finding = "sensor_bias",
          .where = sensor,
          .law = "error in proportion to what it is warmer than the reference",
          .added = {make_effect("sensor_bias", Place::kSensor, sensor, {{"bias", 0.0}})},
          .numbers = {doubted("slope", "1", kSlope, 0.1 * kSlope)},
          .trial = 0.3 * kSlope};
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const std::string& sensor : s.sensors) {
    add_in_some_runs(s, constant_error(sensor), list);
    list.push_back(wrong_scale(sensor));
    list.push_back(fading_error(s, sensor));
    if (!s.starts_and_stops) continue;
    Doubt picked_up{.finding = "sensor_bias",
                    .where = sensor,
                    .law = "error while the spindle turns",
                    .added = {make_effect("sensor_bias", Place::kSensor, sensor)},
                    .numbers = {doubted("bias", "K", 1.0, 0.2)},
                    .trial = 0.3};
    picked_up.added[0].words["errs"] = "while_spindle_turns";
    list.push_back(std::move(picked_up));
  }
  if (s.sensors.size() > 1) {
    add_in_groups(s.sensors, constant_error(s.sensors.front()), list);
    add_in_groups(s.sensors, wrong_scale(s.sensors.front()), list);
    add_in_groups(s.sensors, fading_error(s, s.sensors.front()), list);
  }
  return list;
}

EffectKind kind() {
  return {
      .key = "sensor_bias",
      .title =
          "sensor with a constant error, with one that fades, with one while the spindle turns (a lead that picks up the "
          "drive), or of a wrong "
          "scale",
      .law =
          "reading = T + bias + slope (T - T_reference), of an error that fades bias exp(-t/fades), t from the start of "
          "each cyclogram; at standstill T, where it errs while_spindle_turns",
      .places = {Place::kSensor},
      .parameters = {{"bias", "K", -100.0, 100.0, {}, "reading minus truth"},
                     {"fades", "min", 1e-3, 1e6, kNotGiven, "time in which 63 % of the bias are gone; left out: it stays"},
                     {"slope", "1", -0.9, 9.0, 0.0, "of a wrong scale: error for each K over the reference temperature"}},
      .timing = Timing::kInRecord,
      .change_readings = change_readings,
      .choices = {{"errs", {"always", "while_spindle_turns"}, "always", "when it errs"}},
      .doubts = doubts};
}

}  // namespace driftwright::effects::sensor_bias
