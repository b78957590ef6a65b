#include "diagnosis/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/scatter.hpp"

namespace driftwright::diagnosis {
namespace {

using Scale = Knob::Scale;

constexpr double kFactor = 0.7;  // 1 sigma of the logarithm of a factor that is an effect
constexpr double kMinute_s = 60.0, kHour_s = 3600.0;

/// What all candidates look at.
struct Scene {
  const Twin& twin;
  const std::vector<MeasuredRun>& runs;
  double top_rpm = 1.0, typical_rpm = 1.0, heat_W = 1.0, longest_s = 0.0;
  bool moves_axes = false;
  std::vector<std::string> sensors = {}, displacements = {};  ///< that were measured
  effects::HeatBalance own = {};
};

Knob knob(std::string name, std::string unit, double prior_sd, double step, std::function<void(TwinState&, double)> set) {
  Knob k;
  k.name = std::move(name);
  k.unit = std::move(unit);
  k.prior_sd = prior_sd;
  k.step = step;
  k.set = std::move(set);
  return k;
}

Knob factor(std::function<void(TwinState&, double)> set) {
  Knob k = knob("factor", "1", kFactor, 0.05, std::move(set));
  k.scale = Scale::kLog;
  k.nominal = 1.0;
  return k;
}

Knob on_readings(Knob k) {
  k.reading_only = true;
  return k;
}

/// Times at which something may have begun, and the knob for it.
Knob time_knob(std::string name, double run_length_s, std::function<void(TwinState&, double)> set) {
  Knob k = knob(std::move(name), "s", run_length_s / std::sqrt(12.0), 60.0, std::move(set));
  k.nominal = 0.5 * run_length_s;
  k.low = 0.0;
  k.high = run_length_s;
  k.is_time = true;
  return k;
}
std::vector<std::vector<double>> time_grid(double run_length_s, int n) {
  std::vector<std::vector<double>> grid;
  for (int i = 1; i < n; ++i) grid.push_back({run_length_s * (static_cast<double>(i) / n - 0.5)});
  return grid;
}

double length_s(const MeasuredRun& run) {
  return run.time_s.back();
}

/// Names as in the scenario's YAML for a body.
std::vector<effects::Body> bodies(const Scene& s) {
  std::vector<effects::Body> list;
  for (const auto& p : s.twin.machine().system.parts) {
    const bool is_node =
        std::any_of(s.own.nodes.begin(), s.own.nodes.end(), [&](const auto& n) { return n.name == p.body; });
    list.push_back(is_node ? effects::node(p.body) : effects::region(p.body));
  }
  return list;
}

void add_heat(const Scene& s, std::vector<Candidate>& list) {
  const double sd_W = std::max(20.0, 0.5 * s.heat_W), trial_W = 0.1 * sd_W;
  const auto power = [&](const effects::Body& body, AddedHeat::Shape shape) {
    return knob("power", "W", sd_W, trial_W, [body, shape, rpm = s.typical_rpm](TwinState& t, double value) {
      AddedHeat heat{.body = body, .power_W = value, .shape = shape};
      heat.at_speed_rpm = rpm;
      t.heats.push_back(heat);
    });
  };
  for (const effects::Body& body : bodies(s)) {
    Candidate c{"heat_source", body.name, {}};
    Knob constant = power(body, AddedHeat::Shape::kConstant);
    constant.low = 0.0;  // heat that is taken away is a coolant's
    c.variants.push_back({"constant heat", {constant}, trial_W});
    Knob exponent = knob("exponent", "1", 0.7, 0.05, [](TwinState& t, double value) { t.heats.back().exponent = value; });
    exponent.nominal = 1.5;
    exponent.low = 0.2;
    exponent.high = 3.5;
    c.variants.push_back({fmt::format("power law of speed, at {:.0f} rpm", s.typical_rpm),
                          {power(body, AddedHeat::Shape::kPower), exponent},
                          trial_W,
                          {{-0.5}, {0.0}, {0.5}}});
    double written_W = 0.0;
    for (const auto& h : s.own.heats) {
      if (h.body == body && h.power_W.probes.empty())
        written_W += h.power_W(effects::Inputs{.drive = {.speed_rpm = s.typical_rpm}});
    }
    if (written_W > 0.0) {
      c.variants.push_back({fmt::format("the law written, at {:.0f} rpm", s.typical_rpm),
                            {power(body, AddedHeat::Shape::kAsWritten)},
                            trial_W});
    }
    if (s.moves_axes) c.variants.push_back({"in proportion to the feeds", {power(body, AddedHeat::Shape::kFeed)}, trial_W});
    list.push_back(c);

    Candidate cooled{"coolant", body.name, {}};
    Knob removed = knob("power", "W", sd_W, trial_W,
                        [body](TwinState& t, double value) { t.heats.push_back({.body = body, .power_W = -value}); });
    removed.low = 0.0;
    cooled.variants.push_back({"heat removed at a constant rate", {removed}, trial_W});
    list.push_back(cooled);
  }
  for (const auto& h : effects::heat_balance(s.twin.augmented().model.effects).heats) {
    if (h.body.kind != effects::BodyKind::kSurface) continue;
    const bool listed = std::any_of(list.begin(), list.end(),
                                    [&](const Candidate& c) { return c.effect == "radiation" && c.where == h.body.name; });
    if (listed) continue;
    list.push_back(
        {"radiation",
         h.body.name,
         {{"constant heat from a hot body, or to a cold one", {power(h.body, AddedHeat::Shape::kConstant)}, trial_W}}});
  }
}

void add_friction(const Scene& s, std::vector<Candidate>& list) {
  for (const effects::Body& body : bodies(s)) {
    const bool rubs = std::any_of(s.own.heats.begin(), s.own.heats.end(), [&](const auto& h) { return h.body == body; });
    if (!rubs) continue;
    double low_W = 0.0, high_W = 0.0;
    for (const auto& h : s.own.heats) {
      if (!(h.body == body)) continue;
      const std::vector<double> warm_K(h.power_W.probes.size(), s.twin.reference_K() + 10.0);
      low_W += h.power_W(effects::Inputs{.drive = {.speed_rpm = 0.97 * s.typical_rpm}, .probe_K = warm_K});
      high_W += h.power_W(effects::Inputs{.drive = {.speed_rpm = 1.03 * s.typical_rpm}, .probe_K = warm_K});
    }
    const double written = low_W > 0.0 && high_W > 0.0 ? std::log(high_W / low_W) / std::log(1.03 / 0.97) : std::nan("");
    Candidate c{"friction_law", body.name, {}};
    const double rpm = s.typical_rpm, reference_K = s.twin.reference_K();
    if (written > 0.05) {
      Knob exponent = knob("exponent", "1", 0.5, 0.05, [body, rpm, written](TwinState& t, double value) {
        t.frictions.push_back({.body = body, .change_of_exponent = value - written, .at_speed_rpm = rpm});
      });
      exponent.nominal = written;
      c.variants.push_back({fmt::format("another growth with speed, the same at {:.0f} rpm", rpm), {exponent}, 0.2});
    }
    if (written > 0.05) {
      Knob size = factor([body, rpm](TwinState& t, double value) {
        ChangedFriction f{body};
        f.factor = value;
        f.at_speed_rpm = rpm;
        t.frictions.push_back(f);
      });
      Knob other = knob("exponent", "1", 0.5, 0.05,
                        [written](TwinState& t, double value) { t.frictions.back().change_of_exponent = value - written; });
      other.nominal = written;
      c.variants.push_back({fmt::format("another heat and another growth with speed, at {:.0f} rpm", rpm),
                            {size, other},
                            0.2,
                            {{0.0}, {0.4}, {-0.4}}});
    }
    Knob decay = knob("decay", "1/K", 0.02, 0.002, [body, rpm, reference_K](TwinState& t, double value) {
      t.frictions.push_back({.body = body, .at_speed_rpm = rpm, .decay_1_K = value, .at_K = reference_K});
    });
    c.variants.push_back({"heat that falls as its body warms", {decay}, 0.01});
    list.push_back(c);
  }
}

void add_exchanges(const Scene& s, std::vector<Candidate>& list) {
  const auto changed = [](const std::string& name, double ChangedExchange::*member) {
    return [name, member](TwinState& t, double value) {
      ChangedExchange c{name};
      c.*member = value;
      t.exchanges.push_back(c);
    };
  };
  const auto find = [&](const std::string& effect, const std::string& where) -> Candidate& {
    for (Candidate& c : list) {
      if (c.effect == effect && c.where == where) return c;
    }
    list.push_back({effect, where, {}});
    return list.back();
  };
  const effects::HeatBalance all = scenarios::reducible(effects::heat_balance(s.twin.augmented().model.effects));
  for (std::size_t i = 0; i < all.films.size(); ++i) {
    const effects::Film& f = all.films[i];
    const bool is_own = i < s.own.films.size();
    double standing = 0.0, turning = 0.0;
    if (is_own && f.htc_W_m2K.probes.empty()) {
      standing = f.htc_W_m2K(effects::Inputs{});
      turning = f.htc_W_m2K(effects::Inputs{.drive = {.speed_rpm = s.typical_rpm}});
    }
    const bool grows = turning > standing;
    const bool is_constant = is_own && (!grows || !f.htc_W_m2K.probes.empty());
    if (is_constant) {
      Candidate& c = find("convection", f.surface);
      c.variants.push_back({"another film", {factor(changed(f.name, &ChangedExchange::factor))}, 0.2});
      for (const MeasuredRun& run : s.runs) {
        Knob other = factor([name = f.name, in = run.name](TwinState& t, double value) {
          ChangedExchange e{name, value};
          e.in = in;
          t.exchanges.push_back(e);
        });
        c.variants.push_back(
            {"another film from a time on, in " + run.name,
             {other, time_knob("from", length_s(run),
                               [](TwinState& t, double value) { t.exchanges.back().from_s = std::max(1.0, value); })},
             0.3,
             time_grid(length_s(run), 8)});
      }
      const bool has_grown =
          std::any_of(all.films.begin(), all.films.begin() + static_cast<std::ptrdiff_t>(s.own.films.size()),
                      [&](const effects::Film& other) {
                        return other.surface == f.surface && other.htc_W_m2K.probes.empty() &&
                               other.htc_W_m2K(effects::Inputs{.drive = {.speed_rpm = s.typical_rpm}}) >
                                   other.htc_W_m2K(effects::Inputs{});
                      });
      if (!has_grown) {
        Knob growth =
            knob("growth", "W/(m^2 K)", 15.0, 2.0, [name = f.name, rpm = s.typical_rpm](TwinState& t, double value) {
              ChangedExchange e{name};
              e.growth = value;
              e.at_speed_rpm = rpm;
              t.exchanges.push_back(e);
            });
        growth.low = 0.0;
        Knob exponent =
            knob("exponent", "1", 0.2, 0.05, [](TwinState& t, double value) { t.exchanges.back().exponent = value; });
        exponent.nominal = 0.75;
        exponent.low = 0.3;
        exponent.high = 1.5;
        find("forced_convection", f.surface)
            .variants.push_back({fmt::format("a film that grows with speed, at {:.0f} rpm", s.typical_rpm),
                                 {growth, exponent},
                                 4.0,
                                 {{0.0}}});
      }
    } else if (is_own) {
      find("forced_convection", f.surface)
          .variants.push_back({"another growth of the film", {factor(changed(f.name, &ChangedExchange::factor))}, 0.2});
    } else {
      Knob film = knob("film", "W/(m^2 K)", 10.0, 1.0, changed(f.name, &ChangedExchange::added));
      film.low = 0.0;
      find("convection", f.surface).variants.push_back({"a film where the scenario has none", {film}, 3.0});
      Knob growth = knob("growth", "W/(m^2 K)", 15.0, 2.0, [name = f.name, rpm = s.typical_rpm](TwinState& t, double value) {
        ChangedExchange e{name};
        e.growth = value;
        e.at_speed_rpm = rpm;
        t.exchanges.push_back(e);
      });
      growth.low = 0.0;
      find("forced_convection", f.surface)
          .variants.push_back({fmt::format("a film that grows with speed, at {:.0f} rpm", s.typical_rpm), {growth}, 4.0});
    }
  }
  for (const effects::Contact& c : all.contacts) {
    find("contact", c.joint)
        .variants.push_back({"another conductance", {factor(changed(c.name, &ChangedExchange::factor))}, 0.2});
  }
  for (const effects::Effect& e : s.twin.augmented().model.effects) {
    if (e.kind->key != "link" && e.kind->key != "air_node") continue;
    const effects::HeatBalance alone = effects::heat_balance({e});
    const std::string where = e.kind->key == "link" ? where_of(e) : e.place + ",hall";
    for (const effects::Link& l : alone.links) {
      find("contact", where)
          .variants.push_back({"another conductance", {factor(changed(l.name, &ChangedExchange::factor))}, 0.2});
    }
  }
}

void add_materials(const Scene& s, std::vector<Candidate>& list) {
  for (const Knob& k : scatter(s.twin)) {
    const bool is_material = k.effect == "conductivity" || k.effect == "heat_capacity" || k.effect == "expansion";
    if (!is_material && k.effect != "coolant" && k.effect != "radiation") continue;
    Knob wide = k;
    wide.prior_sd = kFactor;
    wide.step = 0.05;
    const auto same = std::find_if(list.begin(), list.end(),
                                   [&](const Candidate& c) { return c.effect == k.effect && c.where == k.where; });
    const Variant variant{is_material ? "another value" : "another " + k.name, {wide}, 0.2};
    if (same != list.end()) {
      same->variants.push_back(variant);
    } else {
      list.push_back({k.effect, k.where, {variant}});
    }
  }
}

void add_hall(const Scene& s, std::vector<Candidate>& list) {
  Candidate c{"ambient", "hall", {}};
  const auto error = [](double effects::DriveChange::HallError::*member, std::string in) {
    return [member, in](TwinState& t, double value) {
      effects::DriveChange::HallError e{};
      e.*member = value;
      e.in = in;
      t.drive.hall.push_back(e);
    };
  };
  using E = effects::DriveChange::HallError;
  c.variants.push_back({"offset", {knob("offset", "K", 2.0, 0.3, error(&E::offset_K, ""))}, 0.5});
  c.variants.push_back({"ramp",
                        {knob("ramp", "K/h", 0.7, 0.1,
                              [in = std::string()](TwinState& t, double value) {
                                E e{};
                                e.ramp_K_s = value / kHour_s;
                                t.drive.hall.push_back(e);
                              })},
                        0.2});
  for (const MeasuredRun& run : s.runs) {
    c.variants.push_back(
        {"step, in " + run.name,
         {knob("step", "K", 2.0, 0.3, error(&E::offset_K, run.name)),
          time_knob("from", length_s(run), [](TwinState& t, double value) { t.drive.hall.back().from_s = value; })},
         0.5,
         time_grid(length_s(run), 10)});
    if (s.runs.size() > 1) {
      c.variants.push_back({"offset, in " + run.name, {knob("offset", "K", 2.0, 0.3, error(&E::offset_K, run.name))}, 0.5});
      c.variants.push_back({"ramp, in " + run.name,
                            {knob("ramp", "K/h", 0.7, 0.1,
                                  [in = run.name](TwinState& t, double value) {
                                    E e{};
                                    e.ramp_K_s = value / kHour_s;
                                    e.in = in;
                                    t.drive.hall.push_back(e);
                                  })},
                            0.2});
    }
  }
  list.push_back(c);
  const bool has_air = std::any_of(s.twin.machine().system.exchanges.begin(), s.twin.machine().system.exchanges.end(),
                                   [](const auto& e) { return e.offset.size() > 0; });
  if (!s.twin.augmented().has_own_gradient && has_air) {
    Knob gradient = knob("gradient", "K/m", 1.0, 0.2, [](TwinState& t, double value) { t.gradient_K_m += value; });
    Knob level = knob("level", "m", 0.6, 0.1, [](TwinState& t, double value) { t.level_m = value; });
    level.nominal = 1.0;  // about where one hangs a thermometer
    list.push_back({"stratification",
                    "hall",
                    {{"warmer above; the hall's thermometer hangs at a level", {gradient, level}, 0.5, {{-0.6}, {0.2}}}}});
  }
}

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
           {amount, on_readings(time_knob("at", length_s(run),
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
           {share, on_readings(time_knob("at", length_s(run),
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

void add_drive(const Scene& s, std::vector<Candidate>& list) {
  list.push_back({"clock_offset",
                  "clock",
                  {{"readings late or early",
                    {on_readings(knob("offset", "min", 5.0, 0.5,
                                      [](TwinState& t, double value) { t.readings.clock_offset_s += kMinute_s * value; }))},
                    1.0}}});
  Knob speed = factor([](TwinState& t, double value) { t.drive.speed_factor *= value; });
  speed.prior_sd = 0.3;
  list.push_back({"speed_override", "spindle", {{"true speed over the recorded one", {speed}, 0.1}}});
  Candidate stop{"missing_stop", "spindle", {}};
  for (const MeasuredRun& run : s.runs) {
    Knob length = knob("length", "min", 15.0, 1.0, [in = run.name](TwinState& t, double value) {
      t.drive.stops.push_back({0.0, kMinute_s * value, in});
    });
    length.low = 0.0;
    stop.variants.push_back({"in " + run.name,
                             {length, time_knob("start", length_s(run),
                                                [](TwinState& t, double value) { t.drive.stops.back().start_s = value; })},
                             10.0,
                             time_grid(length_s(run), 16)});
  }
  list.push_back(stop);
}

}  // namespace

std::vector<Candidate> candidates(const Twin& twin, const std::vector<MeasuredRun>& runs,
                                  const std::set<std::string>& without) {
  Scene s{.twin = twin, .runs = runs};
  s.own = twin.balance(twin.as_written());
  double turning_s = 0.0, turned = 0.0;
  for (const MeasuredRun& run : runs) {
    s.longest_s = std::max(s.longest_s, length_s(run));
    for (const auto& section : run.cyclogram.sections) {
      s.top_rpm = std::max(s.top_rpm, section.drive.speed_rpm);
      if (section.drive.speed_rpm > 0.0) turning_s += section.duration_s;
      turned += section.duration_s * section.drive.speed_rpm;
      for (double f : section.drive.feed_m_s) s.moves_axes = s.moves_axes || f > 0.0;
    }
    for (const MeasuredChannel& c : run.channels) {
      std::vector<std::string>& names = c.unit == "K" ? s.sensors : s.displacements;
      if (std::find(names.begin(), names.end(), c.name) == names.end()) names.push_back(c.name);
    }
  }
  if (turning_s > 0.0) {  // a round number near the mean speed: where laws of speed are stated
    const double mean_rpm = turned / turning_s, decade = std::pow(10.0, std::floor(std::log10(mean_rpm)));
    s.typical_rpm = std::max(1.0, std::round(mean_rpm / decade)) * decade;
  }
  s.heat_W = 0.0;
  for (const auto& h : s.own.heats) {
    if (h.power_W.probes.empty()) s.heat_W += std::abs(h.power_W(effects::Inputs{.drive = {.speed_rpm = s.top_rpm}}));
  }
  std::vector<Candidate> list;
  add_heat(s, list);
  add_friction(s, list);
  add_exchanges(s, list);
  add_materials(s, list);
  add_hall(s, list);
  add_displacements(s, list);
  add_sensors(s, list);
  add_drive(s, list);
  for (Candidate& c : list) {
    for (Variant& v : c.variants) {
      if (v.law.ends_with(" rpm")) v.at_speed_rpm = s.typical_rpm;
    }
  }
  std::erase_if(list, [&](const Candidate& c) { return without.contains(c.effect) || c.variants.empty(); });
  for (Candidate& c : list) {
    for (Variant& v : c.variants) {
      for (Knob& k : v.knobs) {
        k.effect = c.effect;
        k.where = c.where;
      }
    }
  }
  return list;
}

}  // namespace driftwright::diagnosis
