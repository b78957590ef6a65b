#include "effects/coolant_tank.hpp"

namespace driftwright::effects {
namespace {

constexpr const char* kOfTank[] = {"volume", "tank_exchange", "pump_power", "cooling_power", "hysteresis"};

}  // namespace

std::vector<Parameter> tank_parameters() {
  return {{"volume", "L", 1e-3, 1e6, kNotGiven, "of the medium in the tank"},
          {"tank_exchange", "W/K", 0.0, 1e6, 0.0, "between tank and ambient", 0.1, "coolant", Doubted::kFactor},
          {"pump_power", "W", 0.0, 1e6, 0.0, "heat of the pump, while it runs", 0.1, "coolant", Doubted::kFactor},
          {"cooling_power", "W", 0.0, 1e6, 0.0, "of the chiller while it is on; it obeys its thermostat alone", 0.1,
           "coolant", Doubted::kFactor},
          {"set_point", "degC", 230.0, 400.0, kNotGiven, "of the tank", 0.0, "coolant", Doubted::kShift, 2.0},
          {"hysteresis", "K", 1e-3, 100.0, 1.0, "between on and off", 0.0, "coolant", Doubted::kFactor}};
}

Reference tank_reference(std::string meaning) {
  return {"tank", {BodyKind::kNode}, "", std::move(meaning)};
}

Choice runs_choice() {
  return {"runs", {"always", "while_spindle_turns"}, "always", "when the pump runs"};
}

void add_tank(const Effect& e, double heat_capacity_J_L_K, const std::function<double(const Inputs&)>& pump_runs,
              HeatBalance& balance) {
  const std::string tank = e.references.at("tank").name;
  const double exchange_W_K = e["tank_exchange"], cooling_W = e["cooling_power"], pump_W = e["pump_power"];
  balance.nodes.push_back({tank, e["volume"] * heat_capacity_J_L_K});
  balance.exchanges.push_back({.name = "coolant tank " + tank,
                               .body = node(tank),
                               .coefficient = [=](const Inputs&) { return exchange_W_K; },
                               .per = Per::kTotal});
  balance.heats.push_back({"coolant pump " + tank, node(tank), [=](const Inputs& u) { return pump_W * pump_runs(u); }});
  if (!(cooling_W > 0.0)) return;
  const double half_K = 0.5 * e["hysteresis"];
  balance.thermostats.push_back({tank, node(tank), e["set_point"] + half_K, e["set_point"] - half_K});
  balance.heats.push_back({"coolant chiller " + tank, node(tank), Law([=](const Inputs&) { return -cooling_W; }, {}, tank)});
}

void check_tank(const Effect& e, const ConfigMap& in, bool may_be_of_another) {
  if (!e.references.contains("tank")) {
    if (!e.has("set_point")) in.fail("set_point", "a circuit without `tank` is held at its `set_point`");
    for (const char* of_tank : kOfTank) {
      if (in.has(of_tank))
        in.fail(of_tank, std::string("`") + of_tank + "` is allowed only with a `tank`, which is missing");
    }
    return;
  }
  if (e.references.at("tank").name == kAmbientName)
    in.fail("tank", "the tank must have a name of its own; the ambient is no tank");
  if (!e.has("volume")) {
    if (!may_be_of_another) in.fail("volume", "`tank` and `volume` must be given together");
    for (const char* of_tank : kOfTank) {
      if (in.has(of_tank))
        in.fail(of_tank, std::string("`") + of_tank +
                             "` requires the `volume` of the tank; without it the tank is the node of another entry, which "
                             "has this key");
    }
    if (e.has("set_point"))
      in.fail("set_point", "without `volume` the tank is the node of another entry, which has its `set_point`");
    return;
  }
  if (e.has("set_point") != (e["cooling_power"] > 0.0))
    in.fail("set_point", "`set_point` and `cooling_power` must be given together");
}

}  // namespace driftwright::effects
