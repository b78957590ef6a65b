// Bodies inside a guard whose air has its own exchange with the ambient: the effect of the entry, and that `diagnose` finds
// a guard that a scenario lacks.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/effect_list.hpp"
#include "tests/shared/lumped_records.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::diagnosis::guard_test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

constexpr const char* kMachine = R"(name: behind_a_guard
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5 kJ/K}
  - {type: node, node: table, capacity: 12 kJ/K}
  - {type: node, node: column, capacity: 40 kJ/K}
  - {type: heat_source, node: spindle, power: 120 W, at_speed: 1000 rpm, exponent: 1.3}
  - {type: link, node: spindle, to: column, conductance: 6 W/K}
  - {type: link, node: table, to: column, conductance: 2 W/K}
  - {type: link, node: spindle, to: ambient, conductance: 5 W/K}
  - {type: link, node: table, to: ambient, conductance: 7 W/K}
  - {type: link, node: column, to: ambient, conductance: 14 W/K}
ambient: [[0 min, 20 degC], [200 min, 22 degC], [400 min, 21 degC]]
sensors:
  - {name: t_spindle, node: spindle}
  - {name: t_table, node: table}
  - {name: t_column, node: column}
displacements:
  - name: nose
    sensitivities:
      - {node: column, sensitivity: 3 um/K}
cyclograms:
  monday: [[60 min, 600 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm], [60 min, 1400 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 300 rpm], [60 min, 1000 rpm], [60 min, 0 rpm], [60 min, 2000 rpm]]
solver: {output_interval: 1 min}
)";
constexpr const char* kGuard = R"({type: node, node: air, capacity: 2 kJ/K}
  - {type: link, node: air, to: ambient, conductance: 8 W/K}
  - {type: guard, node: spindle, air: air}
  - {type: guard, node: table, air: air})";

TEST(AGuard, TakesWhatItsBodiesLoseToTheAmbientToItsAir) {
  const scenarios::Scenario s = scenarios::read_scenario(write_file("guard.yaml", with_effect(kMachine, kGuard)));
  const effects::HeatBalance b = effects::heat_balance(s.machine->effects);
  for (const effects::Exchange& x : b.exchanges) {
    if (x.name == "link spindle - ambient" || x.name == "link table - ambient")
      EXPECT_EQ(x.surrounding, "air") << x.name;
    else
      EXPECT_NE(x.surrounding, "air") << x.name;
  }
}

// 120 W into the spindle alone, two bodies without a way to a third: T_air = P / G_air over the ambient, the spindle P /
// G_film above the air, the table as warm as the air.
TEST(AGuard, InSteadyStateIsThreeConductancesInARow) {
  const char* text = R"(name: steady
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 1 kJ/K}
  - {type: node, node: table, capacity: 1 kJ/K}
  - {type: node, node: air, capacity: 1 kJ/K}
  - {type: heat_source, node: spindle, power: 120 W}
  - {type: link, node: spindle, to: ambient, conductance: 5 W/K}
  - {type: link, node: table, to: ambient, conductance: 7 W/K}
  - {type: link, node: air, to: ambient, conductance: 8 W/K}
  - {type: guard, node: spindle, air: air}
  - {type: guard, node: table, air: air}
ambient: 20 degC
sensors: [{name: t_spindle, node: spindle}, {name: t_table, node: table}, {name: t_air, node: air}]
cyclograms: {long: [[50 h, 1000 rpm]]}
)";
  const scenarios::Scenario s = scenarios::read_scenario(write_file("steady.yaml", text));
  const scenarios::MachineModel& model = *s.machine;
  const scenarios::Machine machine = scenarios::build(model, scenarios::place(model));
  const Cyclogram& c = s.cyclograms.front();
  const auto run =
      solver::simulate(machine.system, c, model.ambient, {0.0, c.duration_s()}, {}, scenarios::start_state(model, machine));
  const Record r = scenarios::as_recorded(model, run, machine.system.outputs, c);
  const auto at_end = [&](const std::string& name) {
    for (const Channel& channel : r.channels) {
      if (channel.name == name) return channel.values.back();
    }
    ADD_FAILURE() << name;
    return 0.0;
  };
  EXPECT_NEAR(at_end("t_air"), 20.0 + 120.0 / 8.0, 1e-3);
  EXPECT_NEAR(at_end("t_spindle"), 20.0 + 120.0 / 8.0 + 120.0 / 5.0, 1e-3);
  EXPECT_NEAR(at_end("t_table"), 20.0 + 120.0 / 8.0, 1e-3);
}

TEST(AGuard, ThatAScenarioLacksIsNamedAtItsBodiesAndWritten) {
  const Found found(kMachine, with_effect(kMachine, kGuard), "guard_");
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "hidden_body");
  EXPECT_EQ(d.causes[0].where, "spindle,table");
  EXPECT_THAT(d.causes[0].law, HasSubstr("guard"));
  ASSERT_THAT(d.causes[0].parameters, SizeIs(2));
  EXPECT_NEAR(d.causes[0].parameters[0].value, 1.0 / 8.0, 0.015);
  EXPECT_NEAR(d.causes[0].parameters[1].value, 2000.0, 600.0);
  found.expect_written_is_found_no_more();
}

// A film that depends on the temperatures of both sides is the same by a guard as by its own `surrounding`; so is radiation.
TEST(AGuard, OfAFilmOfFreeConvectionIsItsSurrounding) {
  const std::string film = "{type: natural_convection, surface: top, length: 0.2 m, orientation: up",
                    grey = "{type: radiation, surface: top, emissivity: 0.9";
  const effects::HeatBalance by_guard =
                                 fixtures::balance_of({film + "}", grey + "}", "{type: guard, surface: top, air: box}"}),
                             by_surrounding =
                                 fixtures::balance_of({film + ", surrounding: box}", grey + ", surrounding: box}"});
  ASSERT_THAT(by_guard.exchanges, SizeIs(1));
  EXPECT_EQ(by_guard.exchanges[0].surrounding, "box");
  EXPECT_EQ(by_guard.exchanges[0].coefficient.probes, by_surrounding.exchanges[0].coefficient.probes);
  EXPECT_EQ(by_guard.radiations[0].surrounding, by_surrounding.radiations[0].surrounding);
}

// The position of a guard in the list does not matter: paths are changed before laws.
TEST(AGuard, StandsAnywhereInTheList) {
  const std::string guard = "{type: guard, node: spindle, air: air}",
                    state = "{type: run_state, of: exchange, factor: 2, in: monday}";
  const auto with = [&](const std::string& first, const std::string& second) {
    const std::string entries =
        first + "\n  - " + second +
        "\n  - {type: node, node: air, capacity: 2 kJ/K}\n  - {type: link, node: air, to: ambient, conductance: 8 W/K}";
    return effects::heat_balance(
        scenarios::read_scenario(write_file("anywhere.yaml", with_effect(kMachine, entries))).machine->effects);
  };
  const effects::HeatBalance a = with(guard, state), b = with(state, guard);
  ASSERT_EQ(a.exchanges.size(), b.exchanges.size());
  const effects::Inputs monday{.drive = {}, .run = "monday"};
  for (std::size_t i = 0; i < a.exchanges.size(); ++i) {
    EXPECT_EQ(a.exchanges[i].surrounding, b.exchanges[i].surrounding);
    EXPECT_EQ(a.exchanges[i].coefficient(monday), b.exchanges[i].coefficient(monday)) << a.exchanges[i].name;
  }
}

TEST(AGuard, FindsSomethingToTake) {
  const auto refused = [](const std::string& entries) {
    EXPECT_THAT(
        [&] {
          const scenarios::Scenario s =
              scenarios::read_scenario(write_file("takes_nothing.yaml", with_effect(kMachine, entries)));
          (void)scenarios::place(*s.machine);
        },
        ThrowsMessage<InputError>(HasSubstr("nothing leads from")));
  };
  const std::string air =
      "{type: node, node: air, capacity: 2 kJ/K}\n  - {type: link, node: air, to: spindle, conductance: 8 W/K}\n  - ";
  refused(air + "{type: guard, node: table, air: air}\n  - {type: guard, node: table, air: air}");
  refused("{type: node, node: tool, capacity: 2 kJ/K}\n  - " + air + "{type: guard, node: tool, air: air}");
}

// Two guards, each of them around bodies of its own: one is written and the other one is to be found. Not reached: the
// first search finds it (53 nats), the second one, with sharper noise, begins anew, where 'a body that follows the tank'
// explains more to first order, and says sensor_lag at t_tank (docs/theory/diagnosis.md).
TEST(AGuard, DISABLED_BesideAnotherOneIsFound) {
  const std::string other =
      "{type: node, node: motor, capacity: 3 kJ/K}\n  - {type: node, node: tank, capacity: 9 kJ/K}\n  - {type: heat_source, "
      "node: motor, power: 60 W, at_speed: 1000 rpm, exponent: 0.7}\n  - {type: link, node: motor, to: tank, conductance: 2 "
      "W/K}\n  - {type: link, node: motor, to: ambient, conductance: 4 W/K}\n  - {type: link, node: tank, to: ambient, "
      "conductance: 6 W/K}";
  std::string machine = with_effect(kMachine, other);
  machine.insert(machine.find("displacements:"), "  - {name: t_motor, node: motor}\n  - {name: t_tank, node: tank}\n");
  const std::string around =
      "{type: node, node: box, capacity: 1 kJ/K}\n  - {type: link, node: box, to: ambient, conductance: 12 W/K}\n  - {type: "
      "guard, node: motor, air: box}\n  - {type: guard, node: tank, air: box}";
  const std::string believed = with_effect(machine, kGuard);
  const Found found(believed, with_effect(believed, around), "two_guards_");
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].where, "motor,tank");
  EXPECT_NEAR(d.causes[0].parameters[0].value, 1.0 / 12.0, 0.015);
}

TEST(AGuard, WantsANodeForItsAir) {
  for (const auto& [entry, message] :
       {std::pair{"{type: guard, node: spindle}", "key 'air' is missing"},
        std::pair{"{type: guard, node: spindle, air: ambient}", "this must be a lumped node"},
        std::pair{"{type: guard, node: spindle, air: spindle}", "another node than the body"}}) {
    EXPECT_REFUSED(scenarios::read_scenario(write_file("bad_guard.yaml", with_effect(kMachine, entry))), message);
  }
}

}  // namespace
}  // namespace driftwright::diagnosis::guard_test
