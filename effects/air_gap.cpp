#include "effects/effect.hpp"
#include "effects/film_formulas.hpp"

namespace driftwright::effects::air_gap {

void contribute(const Effect& e, HeatBalance& balance) {
  const double diameter_m = e["diameter"], gap_m = e["gap"], factor = e["factor"];
  const Air air = air_at(e["air"]);
  const auto conductance_W_m2K = [=](const Inputs& u) {
    const double taylor = taylor_number(diameter_m, gap_m, u.drive.speed_rpm, air.viscosity_m2_s);
    return factor * nusselt_gap(taylor) * air.conductivity_W_mK / (2.0 * gap_m);
  };
  balance.exchanges.push_back(make_contact(e.name(), e.place, conductance_W_m2K));
}

void check(const Effect& e, const ConfigMap& in) {
  if (!(e["gap"] < 0.1 * e["diameter"])) in.fail("gap", "the law is one of narrow gaps: less than a tenth of the diameter");
}

EffectKind kind() {
  return {
      .key = "air_gap",
      .title = "gap of air between a rotor and what surrounds it",
      .law =
          "q = Nu k / (2 gap) (T_a - T_b); Nu = 2, 0.128 Ta^0.367, 0.409 Ta^0.241 from Ta = omega^2 r gap^3 / nu^2 up to "
          "1e7 (Becker & Kaye 1962, no axial flow); k and nu of air at a fixed temperature",
      .places = {Place::kJoint},
      .parameters = {{"diameter", "m", 1e-3, 5.0, {}, "of the rotor"},
                     {"gap", "m", 1e-5, 0.1, {}, "radial"},
                     {"air", "degC", 200.0, 500.0, 313.15, "temperature of the air in the gap"},
                     {"factor", "1", 0.0, 1e3, 1.0, "on the formula's conductance", 0.1, "forced_convection"}},
      .timing = Timing::kInTime,
      .contribute = contribute,
      .check = check,
      .exchange_finding = "contact"};
}

}  // namespace driftwright::effects::air_gap
