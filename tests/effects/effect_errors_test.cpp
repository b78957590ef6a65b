// What effects refuse, as the user writes them, and what the message says.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "effects/effect.hpp"
#include "tests/effects/read_entry.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::effects::effect_errors_test {
namespace {

struct Bad {
  const char* text;
  const char* message;
};
class LawErrors : public ::testing::TestWithParam<Bad> {};

TEST_P(LawErrors, NameWhatIsWrong) {
  EXPECT_REFUSED(read(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, LawErrors,
    ::testing::Values(
        Bad{"{type: bearing_friction, region: a, f0: 2, mean_diameter: 90 mm}", "exactly one of the two is required"},
        Bad{"{type: bearing_friction, region: a, f0: 2, mean_diameter: 90 mm, viscosity: 32 mm^2/s, viscosity_40: 32 "
            "mm^2/s, "
            "viscosity_100: 5 mm^2/s}",
            "exactly one of the two is required"},
        Bad{"{type: bearing_friction, region: a, f0: 2, mean_diameter: 90 mm, viscosity_40: 32 mm^2/s}",
            "must be given together"},
        Bad{"{type: bearing_friction, region: a, f0: 2, mean_diameter: 90 mm, viscosity_100: 5 mm^2/s}",
            "must be given together"},
        Bad{"{type: bearing_friction, region: a, f0: 2, mean_diameter: 90 mm, viscosity_40: 5 mm^2/s, viscosity_100: 5 "
            "mm^2/s}",
            "thinner at 100 degC"},
        Bad{"{type: bearing_friction, region: a, f0: 2, mean_diameter: 90 mm, viscosity: 32 mm^2/s, oil: tank}",
            "looks at the oil"},
        Bad{"{type: bearing_friction, region: a, f0: 2, mean_diameter: 90 mm, viscosity: 32 mm^2/s, preload_growth: 5 N/K, "
            "inner: a}",
            "must be given together"},
        Bad{"{type: bearing_friction, region: a, f0: 2, mean_diameter: 90 mm, viscosity: 32 mm^2/s, inner: a, outer: b}",
            "must be given together"},
        Bad{"{type: servo_loss, region: m, axis: w, power: 1 W, at_feed: 1 m/s}", "'w' is not known here"},
        Bad{"{type: servo_loss, region: m, axis: x, power: 1 W, at_feed: 0 m/s}", "outside what is allowed"},
        Bad{"{type: ball_screw, region: n, axis: x, torque: 1 N m, lead: 0 mm}", "outside what is allowed"},
        Bad{"{type: ball_screw, region: n, axis: x, torque: 1 N m, lead: 5 mm, efficiency: 0}", "outside what is allowed"},
        Bad{"{type: guideway_friction, region: n, axis: x, friction: 2, load: 1 N}", "outside what is allowed"},
        Bad{"{type: cutting_heat, region: n, share: 1.2}", "outside what is allowed"},
        Bad{"{type: heat_source, region: n, power: 1 W, from: 20 s, until: 20 s}", "later than `from`"},
        Bad{"{type: heat_source, region: n, power: 1 W, period: 20 min}", "`until` is required"},
        Bad{"{type: heat_source, region: n, power: 1 W, period: 1 min, until: 1e7 s}", "at most 10000 periods"},
        Bad{"{type: heat_source, region: n, power: 1 W, runs: while_spindle_stands, exponent: 1}",
            "does not grow with speed"},
        Bad{"{type: heat_source, region: n, power: 1 W, fades: 3 min, period: 1 min, until: 1 h}", "exclude each other"},
        Bad{"{type: recorded_drive, node: n, column: a_1, gain: 1, medium: 20 degC}", "requires an `opening`"},
        Bad{"{type: recorded_drive, node: n, column: a_1, opening: 1, medium: 20 degC, surrounding: b}",
            "exactly one of the two is required"},
        Bad{"{type: changed_law, law: coolant a}", "the entry changes nothing"},
        Bad{"{type: changed_law, law: coolant a, factor: 2, over: b}", "where there is a `decay`"},
        Bad{"{type: changed_law, law: coolant a, decay: 0.01 1/K, at_temperature: 30 degC, over: b}", "leave this out"},
        Bad{"{type: heat_source, node: a, power: 1 W, runs_on: 5 min}", "goes with the spindle"},
        Bad{"{type: heat_source, node: a, power: 1 W, lasts: 5 min}", "after each stop"},
        Bad{"{type: heat_source, node: a, power: 1 W, runs: while_spindle_stands, lasts: 5 min, fades: 9 min}",
            "neither fades nor"},
        Bad{"{type: heat_source, node: a, power: 1 W, runs: while_spindle_stands, exponent: 2}", "does not grow with speed"},
        Bad{"{type: changed_law, law: coolant a, growth_beyond: 0}", "must be given together"},
        Bad{"{type: changed_law, law: coolant a, factor_below: 2}", "must be given together"},
        Bad{"{type: link, node: a, to: ambient, conductance: 1 W/K, runs_on: 3 min}", "goes with the spindle"},
        Bad{"{type: contact, joint: j, conductance: 1 W/(m^2 K), from: 20 s, until: 10 s}", "later than `from`"},
        Bad{"{type: link, node: n, to: ambient, conductance: 1 W/K, from: 20 s, until: 10 s}", "later than `from`"},
        Bad{"{type: convection, surface: s, film: 1 W/(m^2 K), from: -1 s}", "outside what is allowed"},
        Bad{"{type: natural_convection, surface: s, length: 1 m}", "key 'orientation' is missing"},
        Bad{"{type: natural_convection, surface: s, orientation: up, length: 0 m}", "outside what is allowed"},
        Bad{"{type: radiation, surface: s, emissivity: 1.1}", "outside what is allowed"},
        Bad{"{type: fixed_temperature, surface: s}", "exactly one of the two is required"},
        Bad{"{type: fixed_temperature, surface: s, temperature: 20 degC, follows: ambient}",
            "exactly one of the two is required"},
        Bad{"{type: fixed_temperature, surface: s, temperature: [[0 s, 20 degC], [0 s, 30 degC]]}", "must increase"},
        Bad{"{type: contact, joint: j}", "exactly one of the two is required"},
        Bad{"{type: contact, joint: j, conductance: 1 W/(m^2 K), conductance_over_pressure: [[0 Pa, 1 W/(m^2 K)]], "
            "pressure: 0 "
            "Pa}",
            "exactly one of the two is required"},
        Bad{"{type: contact, joint: j, conductance_over_pressure: [[0 Pa, 1 W/(m^2 K)]]}", "must be given together"},
        Bad{"{type: contact, joint: j, conductance: 1 W/(m^2 K), pressure: 1 Pa}", "must be given together"},
        Bad{"{type: contact, joint: j, conductance_over_pressure: [[0 Pa, 1 W/(m^2 K)], [2 Pa, 3 W/(m^2 K)]], pressure: 3 "
            "Pa}",
            "outside the table"},
        Bad{"{type: contact, joint: j, conductance_over_pressure: [[0 Pa, 1 W/(m^2 K)], [2 Pa, -3 W/(m^2 K)]], pressure: 1 "
            "Pa}",
            "outside what is allowed"},
        Bad{"{type: air_gap, joint: j, diameter: 10 mm, gap: 1 mm}", "narrow gaps"},
        Bad{"{type: air_gap, joint: j, diameter: 10 mm, gap: 0 mm}", "outside what is allowed"},
        Bad{"{type: node, node: n, capacity: 0 J/K}", "outside what is allowed"},
        Bad{"{type: node, node: n, capacity: -1 J/K}", "outside what is allowed"},
        Bad{"{type: link, node: n, conductance: 1 W/K}", "key 'to' is missing"},
        Bad{"{type: link, node: n, conductance: 1 W/K, to: n}", "joins two bodies"},
        Bad{"{type: link, node: n, conductance: -1 W/K, to: ambient}", "outside what is allowed"},
        Bad{"{type: hidden_body, node: n, conductance: 1 W/K}", "key 'capacity' is missing"},
        Bad{"{type: hidden_body, node: n, capacity: 1 J/K, conductance: 1 W/K, every: 5 min}", "write its `windows`"},
        Bad{"{type: hidden_body, node: n, capacity: 0 J/K, conductance: 1 W/K}", "outside what is allowed"},
        Bad{"{type: hidden_body, surface: s, capacity: 1 J/K, conductance: 1 W/K}",
            "requires exactly one place: region or node"},
        Bad{"{type: coolant, region: r, tank: ambient, flow: 1 L/min, passage_conductance: 1 W/K, volume: 1 L}",
            "is no tank"},
        Bad{"{type: coolant, region: r, tank: t, flow: 0 L/min, passage_conductance: 1 W/K, volume: 1 L}",
            "outside what is allowed"},
        Bad{"{type: coolant, region: r, tank: t, flow: 1 L/min, passage_conductance: 1 W/K, volume: 1 L, cooling_power: 1 "
            "kW}",
            "must be given together"},
        Bad{"{type: coolant, region: r, tank: t, flow: 1 L/min, passage_conductance: 1 W/K, volume: 1 L, set_point: 20 "
            "degC}",
            "must be given together"},
        Bad{"{type: coolant, region: r, tank: t, flow: 1 L/min, passage_conductance: 1 W/K, volume: 1 L, cooling_power: 1 "
            "kW, "
            "set_point: 20 degC, hysteresis: 0 K}",
            "outside what is allowed"},
        Bad{"{type: stratification, gradient: 100 K/m}", "outside what is allowed"},
        Bad{"{type: stratification, ambient: ambient, gradient: 1 K/m}", "unknown key 'ambient'"}));

}  // namespace
}  // namespace driftwright::effects::effect_errors_test
