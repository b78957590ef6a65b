#include <fmt/format.h>

#include <memory>

#include "effects/axis.hpp"
#include "effects/bearing_formulas.hpp"
#include "effects/law_steps.hpp"

namespace driftwright::effects::bearing_friction {

constexpr const char* kSpindle = "spindle";

/// Speed [rpm] of the inner rings.
std::function<double(const Drive&)> speed_of(const Effect& e) {
  const std::string& turned_by = e.words.at("turned_by");
  if (turned_by == kSpindle) return [](const Drive& d) { return d.speed_rpm; };
  return [axis = static_cast<std::size_t>(turned_by[0] - 'x'), lead_m = 1e-3 * e["lead"]](const Drive& d) {
    return screw_speed_rpm(d.feed_m_s[axis], lead_m);
  };
}

/// The power as a formula of the drive and of the probes of contribute().
std::string formula_of(const Effect& e) {
  const bool thins = !e.has("viscosity"), tightens = e.has("preload_growth");
  const std::string& turned_by = e.words.at("turned_by");
  const std::string speed =
      turned_by == kSpindle ? "n" : fmt::format("(v_{}*{})", turned_by, written(screw_speed_rpm(1.0, 1e-3 * e["lead"])));
  const std::string nu = thins ? walther_formula(e["viscosity_40"], e["viscosity_100"], "T0") : written(e["viscosity"]);
  const std::string load = tightens ? fmt::format("max(0, {} + {}*(T{} - T{}))", written(e["load"]),
                                                  written(e["preload_growth"]), thins ? 1 : 0, thins ? 2 : 1)
                                    : written(e["load"]);
  return fmt::format("if({0} > 0, {1}*({2} + {3}*{4})*{0}, 0)", speed, written(e["count"] * friction_power_W(1.0, 1.0)),
                     palmgren_viscous_formula(e["f0"], fmt::format("({}*{})", nu, speed), e["mean_diameter"]),
                     written(e["f1"] * e["mean_diameter"]), load);
}

void contribute(const Effect& e, HeatBalance& balance) {
  const double f0 = e["f0"], f1 = e["f1"], preload_N = e["load"], d_mm = e["mean_diameter"], count = e["count"];
  const bool thins = !e.has("viscosity"), tightens = e.has("preload_growth");
  const double nu = e["viscosity"], nu_40 = e["viscosity_40"], nu_100 = e["viscosity_100"], growth_N_K = e["preload_growth"];
  std::vector<Body> probes;
  if (thins) probes.push_back(e.references.contains("oil") ? e.references.at("oil") : e.body());
  if (tightens) {
    probes.push_back(e.references.at("inner"));
    probes.push_back(e.references.at("outer"));
  }
  const auto power_W = [=, speed = speed_of(e)](const Inputs& u) {
    const double speed_rpm = speed(u.drive);
    if (speed_rpm <= 0.0) return 0.0;
    const double nu_now = thins ? walther_viscosity_mm2_s(nu_40, nu_100, u.probe_K.at(0)) : nu;
    const std::size_t inner = thins ? 1 : 0;
    const double load_N =
        tightens ? thermal_preload_N(preload_N, growth_N_K, u.probe_K.at(inner), u.probe_K.at(inner + 1)) : preload_N;
    const double torque_Nmm =
        palmgren_viscous_torque_Nmm(f0, nu_now, speed_rpm, d_mm) + palmgren_load_torque_Nmm(f1, load_N, d_mm);
    return count * friction_power_W(torque_Nmm, speed_rpm);
  };
  Law power(power_W, probes);
  if (thins || tightens)
    power.steps = [e = std::make_shared<const Effect>(e), n = probes.size()] { return law_steps(formula_of(*e), n); };
  balance.heats.push_back({e.name(), e.body(), std::move(power)});
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.has("lead") != (e.words.at("turned_by") != kSpindle))
    in.fail("lead", "bearings of a screw require both: the axis that they are `turned_by`, and the screw's `lead`");
  const bool at_40 = e.has("viscosity_40"), at_100 = e.has("viscosity_100");
  if (e.has("viscosity") == (at_40 || at_100)) {
    in.fail("viscosity",
            "exactly one of the two is required: `viscosity`, held constant, or `viscosity_40` with `viscosity_100`");
  }
  if (at_40 != at_100)
    in.fail(at_40 ? "viscosity_40" : "viscosity_100", "`viscosity_40` and `viscosity_100` must be given together");
  if (at_40 && !(e["viscosity_40"] > e["viscosity_100"])) {
    in.fail("viscosity_100", "an oil is thinner at 100 degC than at 40 degC");
  }
  if (e.references.contains("oil") && !at_40) in.fail("oil", "only `viscosity_40` with `viscosity_100` looks at the oil");
  for (const char* ring : {"inner", "outer"}) {
    if (e.references.contains(ring) != e.has("preload_growth")) {
      in.fail(e.references.contains(ring) ? ring : "preload_growth",
              "`preload_growth`, `inner` and `outer` must be given together");
    }
  }
}

EffectKind kind() {
  return {
      .key = "bearing_friction",
      .title = "friction of a rolling bearing",
      .law =
          "P = count (M0 + M1) omega; M0 = f0 1e-7 (nu n)^(2/3) d_m^3, M1 = f1 P1 d_m [N mm] (Palmgren 1957); lg lg(nu + "
          "0.8) = A - B lg T (Ubbelohde-Walther, DIN 51563); P1 = max(0, load + preload_growth (T_inner - T_outer))",
      .places = {Place::kRegion, Place::kNode},
      .parameters = {{"f0", "1", 1e-3, 20.0, {}, "lubrication factor", 0.1, "heat_source"},
                     {"viscosity", "mm^2/s", 1.0, 1000.0, kNotGiven, "kinematic viscosity of the lubricant, held constant"},
                     {"viscosity_40", "mm^2/s", 1.0, 1000.0, kNotGiven, "or: that at 40 degC of an oil that thins"},
                     {"viscosity_100", "mm^2/s", 0.3, 1000.0, kNotGiven, "and that at 100 degC"},
                     {"mean_diameter", "mm", 1.0, 2000.0, {}, "mean of bore and outer diameter"},
                     {"f1", "1", 0.0, 0.1, 0.0, "load factor", 0.1, "heat_source"},
                     {"load", "N", 0.0, 1e6, 0.0, "load that decides friction: the preload at idle"},
                     {"preload_growth", "N/K", 0.0, 1e5, kNotGiven, "load gained where `inner` is warmer than `outer`", 0.1,
                      "friction_law"},
                     {"count", "1", 1.0, 20.0, 1.0, "equal bearings in this place"},
                     {"lead", "mm", 0.1, 1000.0, kNotGiven, "of the screw that turns them: travel per turn"}},
      .timing = Timing::kInTime,
      .contribute = contribute,
      .references = {{"oil", {BodyKind::kNode, BodyKind::kRegion}, "", "body as warm as the oil; else the bearing's place"},
                     {"inner", {BodyKind::kRegion, BodyKind::kNode}, "", "body of the inner rings"},
                     {"outer", {BodyKind::kRegion, BodyKind::kNode}, "", "body of the outer rings"}},
      .choices =
          {{"turned_by", {kSpindle, "x", "y", "z"}, kSpindle, "the spindle, or the screw of an axis, by its mean feed"}},
      .check = check};
}

}  // namespace driftwright::effects::bearing_friction
