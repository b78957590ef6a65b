#include <fmt/format.h>

#include "diagnosis/candidate_scene.hpp"

namespace driftwright::diagnosis {

void add_displacements(const Scene& s, std::vector<Candidate>& list) {
  for (const std::string& d : s.displacements) {
    const bool is_tilt = [&] {
      for (const auto& r : s.runs) {
        if (const MeasuredChannel* c = r.find(d)) return c->unit == "rad";
      }
      return false;
    }();
    const char* unit = is_tilt ? "urad" : "um";
    const auto growth = [&](double exponent, double lag_s) {
      return on_readings(
          knob("growth", unit, 15.0, 1.0, [d, exponent, lag_s, rpm = s.typical_rpm](TwinState& t, double value) {
            t.readings.growths.push_back({d, 1e-6 * value, rpm, exponent, lag_s});
          }));
    };
    Knob lag = on_readings(knob("lag", "min", 8.0, 0.5,
                                [](TwinState& t, double value) { t.readings.growths.back().lag_s = kMinute_s * value; }));
    lag.nominal = 8.0;
    lag.low = 0.3;
    lag.high = 120.0;
    Candidate g{"spindle_growth", d, {}};
    g.variants.push_back({fmt::format("follows speed with one lag, at {:.0f} rpm", s.typical_rpm),
                          {growth(1.0, 480.0), lag},
                          3.0,
                          {{-5.0}, {0.0}, {12.0}}});
    list.push_back(g);
    list.push_back({"centrifugal",
                    d,
                    {{fmt::format("with the square of speed, at {:.0f} rpm", s.typical_rpm), {growth(2.0, 0.0)}, 3.0}}});
    Candidate shift{"mount_shift", d, {}};
    for (const MeasuredRun& run : s.runs) {
      Knob amount = on_readings(knob("shift", unit, 15.0, 1.0, [d, in = run.name](TwinState& t, double value) {
        t.readings.shifts.push_back({d, 1e-6 * value, 0.0, in});
      }));
      shift.variants.push_back(
          {"step, in " + run.name,
           {amount, on_readings(time_knob("time", length_s(run),
                                          [](TwinState& t, double value) { t.readings.shifts.back().time_s = value; }))},
           3.0,
           time_grid(length_s(run), 40)});
    }
    list.push_back(shift);
    Knob scale_factor = on_readings(knob("factor", "1", 0.3, 0.02, [d](TwinState& t, double value) {
      t.readings.scales.push_back({d, value, 0.0});
    }));
    scale_factor.nominal = 1.0;
    Knob scale_lag = on_readings(knob("lag", "min", 8.0, 0.5, [d](TwinState& t, double value) {
      t.readings.scales.push_back({d, 1.0, kMinute_s * value});
    }));
    scale_lag.low = 0.0;
    list.push_back({"scale_expansion",
                    d,
                    {{"the scale's own expansion", {scale_factor}, 0.05}, {"the scale's lag", {scale_lag}, 2.0}}});
  }
}

void add_sensors(const Scene& s, std::vector<Candidate>& list) {
  for (const std::string& name : s.sensors) {
    const auto error = [name](double effects::ReadingChain::Error::*member, double scale) {
      return [name, member, scale](TwinState& t, double value) {
        effects::ReadingChain::Error e{name};
        e.*member = scale * value;
        t.readings.errors.push_back(e);
      };
    };
    using E = effects::ReadingChain::Error;
    list.push_back({"sensor_bias",
                    name,
                    {{"constant error", {on_readings(knob("bias", "K", 1.0, 0.2, error(&E::bias_K, 1.0)))}, 0.3}}});
    list.push_back({"sensor_drift",
                    name,
                    {{"error that grows with time",
                      {on_readings(knob("drift", "K/h", 0.5, 0.1, error(&E::drift_K_s, 1.0 / kHour_s)))},
                      0.2}}});
    Knob lag = on_readings(knob("lag", "min", 6.0, 0.5, [name](TwinState& t, double value) {
      t.readings.lags.push_back({name, kMinute_s * value});
    }));
    lag.low = 0.0;
    list.push_back({"sensor_lag", name, {{"first-order lag", {lag}, 2.0}}});
    Candidate detached{"sensor_detached", name, {}};
    for (const MeasuredRun& run : s.runs) {
      Knob share = on_readings(knob("share", "1", 0.5, 0.05, [name, in = run.name](TwinState& t, double value) {
        t.readings.detachments.push_back({name, value, 0.0, in});
      }));
      share.low = 0.0;
      share.high = 1.0;
      detached.variants.push_back(
          {"from a time on, in " + run.name,
           {share, on_readings(time_knob("time", length_s(run),
                                         [](TwinState& t, double value) { t.readings.detachments.back().time_s = value; }))},
           0.3,
           time_grid(length_s(run), 24)});
    }
    list.push_back(detached);
  }
  for (std::size_t i = 0; i < s.sensors.size(); ++i) {
    for (std::size_t j = i + 1; j < s.sensors.size(); ++j) {
      Knob swapped =
          on_readings(knob("swapped", "1", 1.0, 1.0, [a = s.sensors[i], b = s.sensors[j]](TwinState& t, double value) {
            if (value > 0.5) t.readings.swaps.push_back({a, b});
          }));
      Variant v{"wired to each other's channel", {swapped}, 1.0};
      v.all_or_nothing = true;
      list.push_back({"sensor_swap", s.sensors[i] + "," + s.sensors[j], {v}});
    }
  }
}

}  // namespace driftwright::diagnosis
