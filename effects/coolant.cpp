#include <cmath>

#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const std::string tank = e.references.at("tank").name;
  const double stream_W_K = e["flow"] / 60.0 * e["medium_heat_capacity"];  // L/s times J/(L K)
  // Medium that enters at the tank's temperature and runs along a wall of one temperature leaves it by this much of the way.
  const double passage_W_K = -stream_W_K * std::expm1(-e["passage_conductance"] / stream_W_K);
  const bool with_spindle = e.words.at("runs") == "while_spindle_turns";
  const auto while_running = [=](double value) {
    return [=](const Inputs& u) { return with_spindle && !(u.drive.speed_rpm > 0.0) ? 0.0 : value; };
  };
  const double exchange_W_K = e["tank_exchange"], cooling_W = e["cooling_power"];
  balance.nodes.push_back({tank, e["volume"] * e["medium_heat_capacity"]});
  balance.links.push_back({e.name() + " - " + tank, e.body(), while_running(passage_W_K), tank});
  balance.links.push_back({"coolant tank " + tank, node(tank), [=](const Inputs&) { return exchange_W_K; }});
  balance.heats.push_back({"coolant pump " + tank, node(tank), while_running(e["pump_power"])});
  if (!(cooling_W > 0.0)) return;
  const double half_K = 0.5 * e["hysteresis"];
  balance.thermostats.push_back({tank, node(tank), e["set_point"] + half_K, e["set_point"] - half_K});
  balance.heats.push_back({"coolant chiller " + tank, node(tank), Law([=](const Inputs&) { return -cooling_W; }, {}, tank)});
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.references.at("tank").name == kHallName) in.fail("tank", "a name of its own is wanted; the hall is no tank");
  if (e.has("set_point") != (e["cooling_power"] > 0.0)) in.fail("set_point", "`set_point` and `cooling_power` go together");
}

}  // namespace

EffectKind coolant() {
  return {
      .key = "coolant",
      .title = "circuit of coolant or oil with tank, pump and a chiller on a thermostat",
      .law =
          "Q = W (1 - exp(-passage_conductance / W)) (T - T_tank), W = flow medium_heat_capacity (stream along a wall of "
          "one "
          "temperature: Incropera & DeWitt, ch. 8.3); C_tank dT_tank/dt = Q + pump_power - tank_exchange (T_tank - T_hall) "
          "- cooling_power from set_point + hysteresis/2 down to set_point - hysteresis/2. It makes the tank's node",
      .places = {Place::kRegion, Place::kSurface, Place::kNode},
      .parameters =
          {{"flow", "L/min", 1e-3, 1e5, {}, "through the passage", 0.1, "coolant"},
           {"medium_heat_capacity", "J/(L K)", 100.0, 1e4, 3800.0,
            "per volume; water with 30 % of ethylene glycol at 20 degC: 1.046 kg/L times 3.65 kJ/(kg K) (ASHRAE Handbook "
            "Fundamentals, secondary coolants); water: 4170, mineral oil: 1650"},
           {"passage_conductance", "W/K", 0.0, 1e7, {}, "film times area of the passage", 0.1, "coolant"},
           {"volume", "L", 1e-3, 1e6, {}, "of the medium in the tank"},
           {"tank_exchange", "W/K", 0.0, 1e6, 0.0, "between tank and hall", 0.1, "coolant"},
           {"pump_power", "W", 0.0, 1e6, 0.0, "heat of the pump, while it runs", 0.1, "coolant"},
           {"cooling_power", "W", 0.0, 1e6, 0.0, "of the chiller while it is on; it obeys its thermostat alone", 0.1,
            "coolant"},
           {"set_point", "degC", 230.0, 400.0, kNotGiven, "of the tank"},
           {"hysteresis", "K", 1e-3, 100.0, 1.0, "between on and off"}},
      .contribute = contribute,
      .references = {{"tank", {BodyKind::kNode}, {}, "name of the tank's node, which comes about here"}},
      .choices = {{"runs", {"always", "while_spindle_turns"}, "always", "when the pump runs"}},
      .check = check};
}

}  // namespace driftwright::effects
