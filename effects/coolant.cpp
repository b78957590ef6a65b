#include <cmath>

#include "base/quantity.hpp"
#include "effects/coolant_tank.hpp"
#include "effects/lasting.hpp"

namespace driftwright::effects::coolant {

constexpr double kAmple_L_min = 100.0;               // flow of a doubted circuit: so large that it does not limit the heat
constexpr double kColder_K = 10.0, kWarmer_K = 3.0;  // largest difference of its medium from the reference
constexpr double kSetPoint_K = 2.0;                  // 1 sigma of a changed set point of a chiller

/// Heat per kelvin between a medium at its inlet temperature and a wall of uniform temperature along which it flows.
double passage_at(const Effect& e, double flow_L_min) {
  const double stream_W_K = flow_L_min / 60.0 * e["medium_heat_capacity"];  // L/s times J/(L K)
  return -stream_W_K * std::expm1(-e["passage_conductance"] / stream_W_K);
}

void contribute(const Effect& e, HeatBalance& balance) {
  const double passage_W_K = passage_at(e, e["flow"]);
  const bool with_spindle = e.words.at("runs") == "while_spindle_turns";
  const auto runs = [=](const Inputs& u) { return with_spindle && !(u.drive.speed_rpm > 0.0) ? 0.0 : 1.0; };
  Exchange passage{.name = e.name(),
                   .body = e.body(),
                   .coefficient = [=](const Inputs& u) { return passage_W_K * runs(u); },
                   .per = Per::kTotal};
  if (!e.references.contains("tank")) {
    passage.medium_K = e["set_point"];
    balance.exchanges.push_back(passage);
    return;
  }
  passage.surrounding = e.references.at("tank").name;
  passage.name += " - " + passage.surrounding;
  balance.exchanges.push_back(passage);
  add_tank(e, e["medium_heat_capacity"], runs, balance);
}

void check(const Effect& e, const ConfigMap& in) {
  check_tank(e, in, false);
}

/// A circuit in the scenario with another set point or another flow, in some records or from a time on.
void doubt_circuit(const DoubtScene& s, const Effect& circuit, std::vector<Doubt>& list) {
  const double written_C = circuit["set_point"] - kZeroCelsius_K;
  DoubtedNumber set_point = doubted("set_point", "degC", kSetPoint_K, 0.1 * kSetPoint_K, written_C);
  set_point.set = [written_C](std::span<Effect> added, double value) {
    for (Effect& e : added) e.set("warmer", value - written_C);
  };
  Doubt other{.finding = "coolant",
              .where = where_of(circuit),
              .law = "another set point",
              .added = {make_effect("changed_law", Place::kLaw, circuit.name())},
              .numbers = {set_point},
              .trial = 0.25 * kSetPoint_K};
  add_changes(s, other, list);
  other.law = "another flow";
  DoubtedNumber flow{
      .name = "flow", .unit = "L/min", .nominal = circuit["flow"], .prior_sd = kFactorSd, .step = 0.05, .is_log = true};
  flow.set = [circuit](std::span<Effect> added, double value) {
    for (Effect& e : added) e.set("factor", passage_at(circuit, value) / passage_at(circuit, circuit["flow"]));
  };
  other.numbers = {flow};
  other.trial = kFactorTrial;
  add_changes(s, other, list);
}

/// Circuits that the scenario lacks: one that removes a constant heat, and one with a medium at a fixed temperature, always
/// or while the spindle turns; and changes of those in the scenario.
std::vector<Doubt> doubts(const DoubtScene& s) {
  const double sd_W = s.unknown_heat_W(), trial_W = 0.1 * sd_W;
  std::vector<Doubt> list;
  for (const Effect& e : s.own) {
    if (e.kind->key == "coolant" && !e.references.contains("tank")) doubt_circuit(s, e, list);
  }
  for (const Body& body : s.bodies) {
    Doubt removed{.finding = "coolant",
                  .where = body.name,
                  .law = "heat removed at a constant rate",
                  .added = {make_effect("heat_source", body)},
                  .numbers = {doubted("power", "W", sd_W, trial_W)},
                  .trial = trial_W};
    removed.numbers[0].low = 0.0;
    removed.numbers[0].set = [](std::span<Effect> added, double value) { added[0].set("power", -value); };
    list.push_back(std::move(removed));

    const double sd_W_K = 0.2 * sd_W, nominal_C = s.reference_K - kZeroCelsius_K;
    Doubt held{.finding = "coolant",
               .where = body.name,
               .law = "a circuit whose medium is held at its set point",
               .added = {make_effect("coolant", body, {{"flow", kAmple_L_min}, {"set_point", s.reference_K}})},
               .numbers = {doubted("passage_conductance", "W/K", sd_W_K, 0.1 * sd_W_K),
                           doubted("set_point", "degC", 5.0, 0.5, nominal_C)},
               .trial = 0.1 * sd_W_K,
               .grid = {{-5.0}, {0.0}, {5.0}}};  // a well, a tank, a warm floor
    held.numbers[0].low = 0.0;
    held.numbers[1].low = nominal_C - kColder_K;
    held.numbers[1].high = nominal_C + kWarmer_K;
    held.numbers[1].set = [](std::span<Effect> added, double value) { added[0].set("set_point", value + kZeroCelsius_K); };
    list.push_back(held);
    if (!s.starts_and_stops) continue;
    held.law += ", which runs while the spindle turns";
    held.added[0].words["runs"] = "while_spindle_turns";
    list.push_back(std::move(held));
  }
  return list;
}

EffectKind kind() {
  EffectKind kind{
      .key = "coolant",
      .title = "circuit of coolant or oil with tank, pump and a chiller on a thermostat",
      .law =
          "Q = W (1 - exp(-passage_conductance / W)) (T - T_tank), W = flow medium_heat_capacity (stream along a wall of "
          "one "
          "temperature: Incropera & DeWitt, ch. 8.3); C_tank dT_tank/dt = Q + pump_power - tank_exchange (T_tank - "
          "T_ambient) "
          "- cooling_power from set_point + hysteresis/2 down to set_point - hysteresis/2. It makes the tank's node. "
          "Without `tank`, "
          "T_tank = set_point: a chiller far stronger than the heat",
      .places = {Place::kRegion, Place::kSurface, Place::kNode},
      .parameters =
          {{"flow", "L/min", 1e-3, 1e5, {}, "through the passage", 0.1, "coolant", Doubted::kFactor},
           {"medium_heat_capacity", "J/(L K)", 100.0, 1e4, 3800.0,
            "per volume; water with 30 % of ethylene glycol at 20 degC: 1.046 kg/L times 3.65 kJ/(kg K) (ASHRAE Handbook "
            "Fundamentals, secondary coolants); water: 4170, mineral oil: 1650"},
           {"passage_conductance", "W/K", 0.0, 1e7, {}, "film times area of the passage", 0.1, "coolant", Doubted::kFactor}},
      .timing = Timing::kInTime,
      .contribute = contribute,
      .references = {tank_reference("name of the tank's node, which comes about here; left out: held at the set point")},
      .choices = {runs_choice()},
      .check = check,
      .doubts = doubts};
  for (Parameter& of_tank : tank_parameters()) kind.parameters.push_back(std::move(of_tank));
  return kind;
}

}  // namespace driftwright::effects::coolant
