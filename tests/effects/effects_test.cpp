#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/errors.hpp"
#include "effects/bearing_formulas.hpp"
#include "effects/effect.hpp"
#include "effects/film_formulas.hpp"
#include "effects/formula.hpp"
#include "tests/effects/read_entry.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::effects::effects_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// --- formulas -------------------------------------------------------------------------------------------------

TEST(Palmgren, ViscousTorqueOfAnAngularContactBearing) {
  // f0 = 2, nu = 32 mm^2/s, 2000 rpm, d_m = 90 mm: (64000)^(2/3) = 1600, so M0 = 2e-7 * 1600 * 729000 = 233.28 N mm.
  const double torque_Nmm = palmgren_viscous_torque_Nmm(2.0, 32.0, 2000.0, 90.0);
  EXPECT_NEAR(torque_Nmm, 233.28, 1e-10);  // rounding of pow
  EXPECT_NEAR(friction_power_W(torque_Nmm, 2000.0), 48.86,
              0.005);  // 0.23328 N m * 209.44 rad/s; two decimals
}

TEST(Palmgren, BranchesMeetWithinEightPerMille) {
  // 2000^(2/3) = 158.74 against 160: a step of 0.79 %.
  const double above = palmgren_viscous_torque_Nmm(2.0, 20.0, 100.0, 90.0);
  const double below = palmgren_viscous_torque_Nmm(2.0, 20.0, std::nextafter(100.0, 0.0), 90.0);
  EXPECT_NEAR(below, 2.0 * 160e-7 * 729000.0, 1e-12);
  EXPECT_NEAR(above / below, 158.7401 / 160.0, 1e-6);
  EXPECT_LT(std::abs(above - below), 0.008 * below);
  EXPECT_EQ(palmgren_viscous_torque_Nmm(2.0, 20.0, 0.0, 90.0), below);
}

TEST(Palmgren, LoadTorqueIsAProduct) {
  EXPECT_DOUBLE_EQ(palmgren_load_torque_Nmm(0.001, 500.0, 90.0), 45.0);
}

TEST(RotatingCylinder, FilmByHand) {
  // d = 0.1 m, 2000 rpm: u = 10.472 m/s, Re = 65 862, Re^(2/3) = 1630.9, Pr^(1/3) = 0.8921, Nu = 193.5,
  // h = Nu * 0.026 / 0.1 = 50.31 W/(m^2 K). The published example says 50.2, with slightly other properties of air.
  EXPECT_NEAR(rotating_cylinder_htc_W_m2K(0.1, 2000.0), 50.31, 0.01);
  EXPECT_NEAR(rotating_cylinder_htc_W_m2K(0.1, 2000.0), 50.2, 0.003 * 50.2);
  EXPECT_EQ(rotating_cylinder_htc_W_m2K(0.1, 0.0), 0.0);
}

TEST(RotatingCylinder, GrowsWithSpeedByTheTwoThirdsPower) {
  EXPECT_NEAR(rotating_cylinder_htc_W_m2K(0.1, 8000.0) / rotating_cylinder_htc_W_m2K(0.1, 1000.0), 4.0, 1e-12);
}

struct OutOfRange {
  const char* what;
  double (*call)();
};
class EffectRanges : public ::testing::TestWithParam<OutOfRange> {};

TEST_P(EffectRanges, AreGuarded) {
  EXPECT_THAT([] { (void)GetParam().call(); }, ThrowsMessage<RangeError>(HasSubstr(GetParam().what)));
}

INSTANTIATE_TEST_SUITE_P(
    Each, EffectRanges,
    ::testing::Values(OutOfRange{"f0", [] { return palmgren_viscous_torque_Nmm(0, 32, 2000, 90); }},
                      OutOfRange{"f0", [] { return palmgren_viscous_torque_Nmm(NAN, 32, 2000, 90); }},
                      OutOfRange{"viscosity", [] { return palmgren_viscous_torque_Nmm(2, 0, 2000, 90); }},
                      OutOfRange{"speed", [] { return palmgren_viscous_torque_Nmm(2, 32, -1, 90); }},
                      OutOfRange{"speed", [] { return palmgren_viscous_torque_Nmm(2, 32, NAN, 90); }},
                      OutOfRange{"diameter", [] { return palmgren_viscous_torque_Nmm(2, 32, 2000, 0); }},
                      OutOfRange{"f1", [] { return palmgren_load_torque_Nmm(-1e-3, 500, 90); }},
                      OutOfRange{"load", [] { return palmgren_load_torque_Nmm(1e-3, -500, 90); }},
                      OutOfRange{"load", [] { return palmgren_load_torque_Nmm(1e-3, NAN, 90); }},
                      OutOfRange{"diameter", [] { return palmgren_load_torque_Nmm(1e-3, 500, -90); }},
                      OutOfRange{"diameter", [] { return rotating_cylinder_htc_W_m2K(0, 2000); }},
                      OutOfRange{"speed", [] { return rotating_cylinder_htc_W_m2K(0.1, -1); }},
                      OutOfRange{"Reynolds", [] { return rotating_cylinder_htc_W_m2K(0.1, 13060); }},
                      OutOfRange{"Reynolds", [] { return rotating_cylinder_htc_W_m2K(INFINITY, 1); }}));

TEST(RotatingCylinder, IsValidUpToItsReynoldsNumber) {
  // Re = 4.3e5 at 13057.7 rpm: 4.3e5 * 15.9e-6 * 60 / (pi * 0.01).
  EXPECT_NO_THROW((void)rotating_cylinder_htc_W_m2K(0.1, 13050));
}

// --- the catalogue ----------------------------------------------------------------------------------------------

TEST(Catalogue, KeysAndParameterNamesAreUnique) {
  std::set<std::string> keys;
  for (const EffectKind& kind : catalogue()) {
    EXPECT_TRUE(keys.insert(kind.key).second) << kind.key;
    std::set<std::string> names = {"type"};
    for (Place place : kind.places) EXPECT_TRUE(names.insert(place_key(place)).second) << kind.key;
    for (const Reference& r : kind.references) EXPECT_TRUE(names.insert(r.name).second) << kind.key << " " << r.name;
    for (const Choice& c : kind.choices) EXPECT_TRUE(names.insert(c.name).second) << kind.key << " " << c.name;
    for (const Table& t : kind.tables) EXPECT_TRUE(names.insert(t.name).second) << kind.key << " " << t.name;
    for (const Mention& m : kind.mentions) EXPECT_TRUE(names.insert(m.name).second) << kind.key << " " << m.name;
    for (const Parameter& p : kind.parameters) EXPECT_TRUE(names.insert(p.name).second) << kind.key << " " << p.name;
  }
  EXPECT_GE(keys.size(), 8u);
}

TEST(Catalogue, DefaultsLieInTheirRanges) {
  for (const EffectKind& kind : catalogue()) {
    EXPECT_FALSE(kind.title.empty() || kind.law.empty()) << kind.key;
    for (const Parameter& p : kind.parameters) {
      EXPECT_LT(p.low, p.high) << kind.key << " " << p.name;
      const double fallback = p.fallback.value_or(p.low);
      if (std::isnan(fallback)) continue;  // may be left out
      EXPECT_TRUE(fallback >= p.low && fallback <= p.high) << kind.key << " " << p.name;
    }
  }
}

/// An effect of a kind at a place called "spot", with its defaults, or mid-range values where there are none.
Effect sample(const EffectKind& kind, Place place) {
  Effect effect{.kind = &kind, .place_kind = place, .place = "spot"};
  for (const Parameter& p : kind.parameters)
    effect.values.push_back(p.fallback.value_or(std::max(p.low, std::min(p.high, 0.5))));
  for (const Reference& r : kind.references) {
    const std::string name = r.fallback.value_or("other");
    if (!name.empty()) effect.references[r.name] = {r.kinds.front(), name};
  }
  for (const Choice& c : kind.choices) effect.words[c.name] = c.fallback.value_or(c.options.front());
  for (const Table& t : kind.tables) {
    if (t.compulsory) effect.tables[t.name] = {{0.0}, {std::max(t.low, std::min(t.high, 300.0))}};
  }
  for (const Mention& m : kind.mentions) effect.words[m.name] = m.compulsory ? "other" : "";
  return effect;
}

/// How many entries of a balance name a place.
int n_entries_at(const HeatBalance& b, const std::string& place) {
  int n = 0;
  for (const auto& e : b.heats) n += e.body.name == place;
  for (const auto& e : b.exchanges) n += e.body.name == place;
  for (const auto& e : b.radiations) n += e.surface == place;
  for (const auto& e : b.nodes) n += e.name == place;
  for (const auto& e : b.fixed) n += e.body.name == place;
  return n;
}

TEST(Catalogue, EveryEffectDoesSomethingAtEachPlaceItAllows) {
  for (const EffectKind& kind : catalogue()) {
    ASSERT_FALSE(kind.places.empty()) << kind.key;
    if (has_formula(kind)) continue;  // its entries declare what they do: formula_test
    for (Place place : kind.places) {
      const Effect effect = sample(kind, place);
      if (!kind.contribute) {
        const DriveChange drive = drive_change({effect}, "");
        EXPECT_TRUE(!drive.ambient.empty() || !drive.drive.empty() || !reading_chain({effect}, "").empty() ||
                    material_factors({effect}).size() == 1u || kind.acts_on_heat())
            << kind.key << " at a " << place_key(place);
        continue;
      }
      const HeatBalance b = heat_balance({effect});
      if (place == Place::kAmbient) {
        EXPECT_EQ(b.stratifications.size(), 1u) << kind.key;
      } else {
        EXPECT_GE(n_entries_at(b, "spot"), 1) << kind.key << " at a " << place_key(place);
      }
    }
  }
}

// --- laws, as the user writes them ------------------------------------------------------------------------------

double power_W(const std::string& text, double speed_rpm) {
  return heat_balance({read(text)}).heats.at(0).power_W({.drive = {.speed_rpm = speed_rpm}, .ambient_K = 0.0});
}
double htc_W_m2K(const std::string& text, double speed_rpm) {
  return heat_balance({read(text)}).exchanges.at(0).coefficient({.drive = {.speed_rpm = speed_rpm}, .ambient_K = 0.0});
}

TEST(Laws, BearingFrictionAddsBothTorquesTimesTheCount) {
  // (233.28 + 45) N mm = 0.27828 N m at 209.4395 rad/s = 58.2828 W each.
  const std::string two =
      "{type: bearing_friction, region: front, f0: 2, viscosity: 32 mm^2/s, mean_diameter: 9 cm, f1: 0.001, "
      "load: 0.5 kN, count: 2}";
  EXPECT_NEAR(power_W(two, 2000), 2 * 58.2828, 1e-4);  // the digits written
  EXPECT_EQ(power_W(two, 0), 0.0);
}

TEST(Laws, MotorLossHasAnIdlePartThatStopsWithTheSpindle) {
  const std::string motor = "{type: motor_loss, region: motor, power: 0.2 kW, at_speed: 1000 rpm, exponent: 2, idle: 30 W}";
  EXPECT_DOUBLE_EQ(power_W(motor, 1000), 230.0);
  EXPECT_DOUBLE_EQ(power_W(motor, 3000), 30.0 + 9 * 200.0);
  EXPECT_EQ(power_W(motor, 0), 0.0);
  EXPECT_DOUBLE_EQ(power_W("{type: motor_loss, region: m, power: 200 W, at_speed: 1000 rpm}", 500), 100.0);
}

TEST(Laws, HeatSourceIsConstantOrAPower) {
  EXPECT_EQ(power_W("{type: heat_source, region: a, power: -50 W}", 0), -50.0);
  EXPECT_EQ(power_W("{type: heat_source, region: a, power: -50 W}", 4000), -50.0);
  const std::string grows = "{type: heat_source, region: a, power: 80 W, at_speed: 2000 rpm, exponent: 1.5}";
  EXPECT_NEAR(power_W(grows, 500), 10.0, 1e-12);  // (1/4)^1.5 = 1/8
  EXPECT_EQ(power_W(grows, 0), 0.0);
}

TEST(Laws, ForcedConvectionGrowsByTwoThirdsUnlessToldOtherwise) {
  const std::string film = "{type: forced_convection, surface: s, growth: 12 W/(m^2 K), at_speed: 1000 rpm";
  EXPECT_NEAR(htc_W_m2K(film + "}", 8000), 48.0, 1e-12);  // 8^(2/3) = 4
  EXPECT_NEAR(htc_W_m2K(film + ", exponent: 0.5}", 4000), 24.0, 1e-12);
  EXPECT_EQ(htc_W_m2K(film + "}", 0), 0.0);
}

TEST(Laws, ConvectionAndRotatingCylinder) {
  EXPECT_EQ(htc_W_m2K("{type: convection, surface: s, film: 8 W/(m^2 K)}", 1234), 8.0);
  EXPECT_NEAR(htc_W_m2K("{type: rotating_cylinder, surface: s, diameter: 100 mm}", 2000), 50.31, 0.01);
}

TEST(Laws, ContactAndAirNodeCarryTheirNumbers) {
  const auto contact = heat_balance({read("{type: contact, joint: a/b, conductance: 0.3 W/(cm^2 K)}")}).exchanges.at(0);
  EXPECT_EQ(contact.body, joint("a/b"));
  EXPECT_NEAR(contact.coefficient({}), 3000.0, 1e-9);
  const HeatBalance air = heat_balance({read("{type: air_node, node: air, capacity: 1.2 kJ/K, exchange: 4 W/K}")});
  EXPECT_EQ(air.nodes.at(0).name, "air");
  EXPECT_NEAR(air.nodes.at(0).capacity_J_K, 1200.0, 1e-9);
  EXPECT_EQ(air.exchanges.at(0).body, node("air"));
  EXPECT_EQ(air.exchanges.at(0).coefficient({}), 4.0);
}

TEST(Laws, SurroundingIsTheAmbientUnlessNamed) {
  EXPECT_EQ(heat_balance({read("{type: convection, surface: s, film: 8 W/(m^2 K)}")}).exchanges.at(0).surrounding,
            effects::kAmbientName);
  EXPECT_EQ(heat_balance({read("{type: convection, surface: s, film: 8 W/(m^2 K), surrounding: air}")})
                .exchanges.at(0)
                .surrounding,
            "air");
}

struct Bad {
  const char* text;
  const char* message;
};
class EffectErrors : public ::testing::TestWithParam<Bad> {};

TEST_P(EffectErrors, NameWhatIsWrong) {
  EXPECT_REFUSED(read(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, EffectErrors,
    ::testing::Values(Bad{"{type: convecton, surface: s}", "'convecton' is not known here"},
                      Bad{"{type: convection, film: 8 W/(m^2 K)}", "key 'surface' is missing"},
                      Bad{"{type: convection, surface: s}", "key 'film' is missing"},
                      Bad{"{type: convection, surface: s, film: 8 W/m^2}", "wrong unit"},
                      Bad{"{type: convection, surface: s, film: -8 W/(m^2 K)}", "outside what is allowed"},
                      Bad{"{type: convection, surface: s, film: 8 W/(m^2 K), surounding: air}",
                          "Did you mean 'surrounding'?"},
                      Bad{"{type: contact, joint: a/b, conductance: 1 W/(m^2 K), surrounding: air}", "unknown key"},
                      Bad{"{type: air_node, node: air, capacity: 0 J/K, exchange: 1 W/K}", "outside what is allowed"}));

TEST(Effect, AsksForNoParameterItHasNot) {
  const Effect e = read("{type: convection, surface: s, film: 8 W/(m^2 K)}");
  EXPECT_EQ(e["film"], 8.0);
  EXPECT_THROW((void)e["fillm"], std::logic_error);
}

}  // namespace
}  // namespace driftwright::effects::effects_test
