// Liquids in channels: properties and Nusselt numbers by published values, the chain of sections against the closed form
// of a tube in a wall of one temperature, and what an entry may hold.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/errors.hpp"
#include "effects/channel_formulas.hpp"
#include "effects/flow_path.hpp"
#include "tests/effects/read_entry.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::effects::coolant_channel_test {
namespace {

using ::testing::ElementsAre;

TEST(Liquids, HaveThePropertiesOfTheirTables) {
  EXPECT_NEAR(water_at(300.0).prandtl(), 5.83, 0.02);                     // Incropera & DeWitt, table A.6
  EXPECT_NEAR(1e6 * water_at(293.15).viscosity_m2_s, 1.0034, 0.002);      // IAPWS, 20 degC: 1.0016 mPa s, 998.2 kg/m^3
  EXPECT_NEAR(1e-3 * water_at(293.15).heat_capacity_J_m3K, 4176.0, 5.0);  // 998.2 kg/m^3 times 4.184 kJ/(kg K)
  const Liquid glycol = glycol_30_at(293.15);
  EXPECT_NEAR(1e6 * glycol.viscosity_m2_s, 2.087, 1e-6);
  EXPECT_NEAR(glycol.prandtl(), 17.33, 0.02);  // 2.166 mPa s times 3.718 kJ/(kg K) over 0.4649 W/(m K)
  EXPECT_THROW((void)water_at(274.0), RangeError);
  EXPECT_THROW((void)glycol_30_at(273.0), RangeError);
}

TEST(LaminarNusselt, IsGraetzSolutionToAPerCent) {
  // Eigenvalues and constants of Graetz' problem (Shah & London 1978, table 13): mean from the inlet to x* = 1 / Gz,
  // Nu = -ln(8 sum G_n / l_n^2 exp(-2 l_n^2 x*)) / (4 x*).
  constexpr std::array<double, 5> kLambda = {2.7043644, 6.6790315, 10.6733795, 14.6710785, 18.6698719};
  constexpr std::array<double, 5> kG = {0.74877, 0.54383, 0.46286, 0.41542, 0.38292};
  for (const double x : {0.01, 0.02, 0.05, 0.1, 0.2, 1.0}) {
    double mixed = 0.0;
    for (std::size_t n = 0; n < kG.size(); ++n)
      mixed += 8.0 * kG[n] / (kLambda[n] * kLambda[n]) * std::exp(-2.0 * kLambda[n] * kLambda[n] * x);
    const double exact = -std::log(mixed) / (4.0 * x);
    EXPECT_NEAR(nusselt_laminar_tube(1.0 / x), exact, 0.01 * exact) << x;
  }
  EXPECT_NEAR(nusselt_laminar_tube(0.0), 3.66, 1e-12);
}

TEST(TurbulentNusselt, IsGnielinskisAndNearDittusAndBoelters) {
  // By hand: f = (0.79 ln 1e4 - 1.64)^-2 = 0.0314798; f/8 9000 0.7 / (1 + 12.7 0.0627294 (0.788374 - 1)) = 29.817.
  EXPECT_NEAR(nusselt_turbulent_tube(1e4, 0.7, 0.0), 29.817, 2e-3);
  EXPECT_NEAR(nusselt_turbulent_tube(1e4, 0.7, 0.125), 29.817 * 1.25, 3e-3);
  // 0.023 Re^0.8 Pr^0.4 is said to hold to 25 % for 1e4 < Re, 0.6 < Pr < 160.
  for (const double re : {1e4, 5e4, 1e5}) {
    for (const double pr : {0.7, 2.0, 5.83}) {
      const double other = 0.023 * std::pow(re, 0.8) * std::pow(pr, 0.4);
      EXPECT_NEAR(nusselt_turbulent_tube(re, pr, 0.0), other, 0.25 * other) << re << " " << pr;
    }
  }
  EXPECT_THROW((void)nusselt_turbulent_tube(2999.0, 5.0, 0.0), RangeError);
  EXPECT_THROW((void)nusselt_turbulent_tube(1e4, 0.4, 0.0), RangeError);
}

TEST(Nusselt, HasNoJumpBetweenLaminarAndTurbulent) {
  const double laminar = nusselt_laminar_tube(2300.0 * 6.0 * 0.02), turbulent = nusselt_turbulent_tube(4000.0, 6.0, 0.02);
  EXPECT_NEAR(nusselt_tube(2300.0, 6.0, 0.02), laminar, 1e-12);
  EXPECT_NEAR(nusselt_tube(2300.0 + 1e-7, 6.0, 0.02), laminar, 1e-6);
  EXPECT_NEAR(nusselt_tube(4000.0 - 1e-7, 6.0, 0.02), turbulent, 1e-6);
  EXPECT_NEAR(nusselt_tube(4000.0, 6.0, 0.02), turbulent, 1e-12);
  EXPECT_NEAR(nusselt_tube(3150.0, 6.0, 0.02), 0.5 * (laminar + turbulent), 1e-12);
  EXPECT_THROW((void)nusselt_tube(5.1e6, 6.0, 0.02), RangeError);
  EXPECT_THROW((void)nusselt_tube(std::nan(""), 6.0, 0.02), RangeError);
}

const Channel kBore{.hydraulic_diameter_m = 0.008,
                    .cross_section_m2 = 0.25 * std::numbers::pi * 0.008 * 0.008,
                    .heated_perimeter_m = std::numbers::pi * 0.008,
                    .length_m = 0.6};

TEST(Passages, OfAWallOfOneTemperatureAreTheSameForAnyNumberOfSections) {
  for (const double flow_L_min : {0.5, 1.2, 6.0}) {  // Re of 1300, 3200 and 16 000
    const double flow_m3_s = flow_L_min / 60e3;
    const Liquid water = water_at(293.15);
    const double h =
        nusselt_tube(reynolds_of(kBore, water, flow_m3_s), water.prandtl(), 0.008 / 0.6) * water.conductivity_W_mK / 0.008;
    const double stream_W_K = flow_m3_s * water.heat_capacity_J_m3K;
    const double left = std::exp(-h * std::numbers::pi * 0.008 * 0.6 / stream_W_K);
    for (const int n : {1, 3, 40}) {
      double of_sections = 1.0, taken_W_K = 0.0;
      for (const Passage& p : passages(kBore, water, flow_m3_s, 1.0, n)) {
        EXPECT_GT(p.share, 0.0);
        taken_W_K += p.conductance_W_K * of_sections;
        of_sections *= 1.0 - p.share;
      }
      EXPECT_NEAR(of_sections, left, 1e-12) << n;                                  // outlet
      EXPECT_NEAR(taken_W_K, stream_W_K * (1.0 - left), 1e-10 * stream_W_K) << n;  // heat
    }
  }
  for (const Passage& p : passages(kBore, water_at(293.15), 0.0, 1.0, 3)) EXPECT_EQ(p.conductance_W_K, 0.0);
}

constexpr const char* kTwoBodies =
    "{type: coolant_channel, node: a, then: [b], flow: 1.2 L/min, diameter: 8 mm, length: 600 mm, set_point: 20 degC}";

/// Heat into the liquid from each wall, of a balance without tank. @param wall_K  in the order of flow
std::vector<double> taken_W(const HeatBalance& b, const std::vector<double>& wall_K, double inlet_K) {
  std::vector<double> all;
  for (std::size_t i = 0; i < wall_K.size(); ++i) {
    double heat_W = b.exchanges.at(i).coefficient({}) * (wall_K[i] - inlet_K);
    if (i > 0) {
      const std::vector<double> before(wall_K.begin(), wall_K.begin() + static_cast<std::ptrdiff_t>(i));
      heat_W -= b.heats.at(i - 1).power_W(Inputs{.drive = {}, .probe_K = before});
    }
    all.push_back(heat_W);
  }
  return all;
}

TEST(CoolantChannel, CarriesHeatDownstreamAndNeverUp) {
  const HeatBalance b = heat_balance({read(kTwoBodies)});
  ASSERT_EQ(b.exchanges.size(), 2u);
  ASSERT_EQ(b.heats.size(), 1u);
  EXPECT_EQ(b.exchanges[0].body, node("a"));
  EXPECT_EQ(b.exchanges[1].body, node("b"));
  EXPECT_EQ(b.exchanges[1].medium_K, 293.15);
  EXPECT_THAT(b.heats[0].power_W.probes, ElementsAre(node("a")));
  const double stream_W_K = 1.2 / 60e3 * water_at(293.15).heat_capacity_J_m3K;
  const double share_a = b.exchanges[0].coefficient({}) / stream_W_K, share_b = b.exchanges[1].coefficient({}) / stream_W_K;
  EXPECT_GT(share_a, share_b);  // the entrance
  const std::vector<double> hot_first = taken_W(b, {333.15, 294.15}, 293.15),
                            hot_last = taken_W(b, {294.15, 333.15}, 293.15);
  EXPECT_NEAR(hot_first[0], stream_W_K * share_a * 40.0, 1e-9);
  EXPECT_NEAR(hot_first[1], stream_W_K * share_b * (1.0 - 40.0 * share_a), 1e-9);  // heats b, which is at 21 degC
  EXPECT_LT(hot_first[1], 0.0);
  EXPECT_NEAR(hot_last[0], stream_W_K * share_a, 1e-9);  // does not know what follows
  EXPECT_NEAR(hot_last[1], stream_W_K * share_b * (40.0 - share_a), 1e-9);
}

TEST(CoolantChannel, BringsToItsTankWhatItTakesFromTheWalls) {
  const HeatBalance b = heat_balance({read(
      "{type: coolant_channel, region: a, then: [b, a], tank: t, volume: 10 L, medium: glycol_30, pump_power: 30 W, flow: 2 "
      "L/min, diameter: 8 mm, length: 900 mm, runs: while_spindle_turns}")});
  const Inputs turning{.drive = {.speed_rpm = 1.0}};
  const std::vector<double> wall_K = {330.0, 310.0, 330.0};
  const double tank_K = 295.0;
  double from_walls_W = 0.0, into_tank_W = 0.0, rise_K = 0.0;
  const double stream_W_K = 2.0 / 60e3 * glycol_30_at(293.15).heat_capacity_J_m3K;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(b.exchanges[i].surrounding, "t");
    const double c_W_K = b.exchanges[i].coefficient(turning);
    from_walls_W += c_W_K * (wall_K[i] - tank_K - rise_K);
    rise_K += c_W_K / stream_W_K * (wall_K[i] - tank_K - rise_K);
    into_tank_W += c_W_K * (wall_K[i] - tank_K);
    EXPECT_EQ(b.exchanges[i].coefficient({}), 0.0);
  }
  double sum_W = 0.0;
  for (const HeatInput& h : b.heats) {
    if (!h.name.starts_with("medium of")) continue;
    Inputs at = turning;
    for (const Body& body : h.power_W.probes)
      at.probe_K.push_back(body == node("t") ? tank_K : body.name == "a" ? 330.0 : 310.0);
    sum_W += h.power_W(at);
    if (h.body == node("t")) into_tank_W += h.power_W(at);
  }
  EXPECT_NEAR(sum_W, 0.0, 1e-9);  // it only moves heat
  EXPECT_NEAR(into_tank_W, from_walls_W, 1e-9);
  EXPECT_NEAR(into_tank_W, stream_W_K * rise_K, 1e-9);
  ASSERT_EQ(b.nodes.size(), 1u);
  EXPECT_NEAR(b.nodes[0].capacity_J_K, 38.6e3, 1.0);
}

TEST(CoolantChannel, FollowsARecordedFlow) {
  const Effect e = read(
      "{type: coolant_channel, node: a, column: flow_L_min, flow: 1 L/min, diameter: 8 mm, length: 600 mm, set_point: 20 "
      "degC}");
  const HeatBalance b = heat_balance({e});
  const auto at = [&](double flow) {
    return b.exchanges[0].coefficient(Inputs{.drive = {.signals = {{"flow_L_min", flow}}}});
  };
  const auto constant = [](const std::string& flow) {
    return heat_balance({read("{type: coolant_channel, node: a, flow: " + flow +
                              ", diameter: 8 mm, length: 600 mm, set_point: 20 degC}")})
        .exchanges[0]
        .coefficient({});
  };
  EXPECT_NEAR(at(3.0), constant("3 L/min"), 1e-9);
  EXPECT_NEAR(at(0.4), constant("0.4 L/min"), 1e-9);
  EXPECT_EQ(at(0.0), 0.0);
  EXPECT_EQ(b.exchanges[0].coefficient({}), 0.0);  // before a run
  EXPECT_FALSE(drive_change({e}, "").drive.empty());
}

TEST(CoolantChannel, NamesTheSectionsOfASurface) {
  const HeatBalance b =
      heat_balance({read("{type: coolant_channel, surface: bore, along: [[0 mm, 0 mm, 0 mm], [0.1 m, 0 mm, 25 mm]], "
                         "sections: 3, flow: 1 L/min, "
                         "diameter: 8 mm, length: 100 mm, set_point: 20 degC}")});
  ASSERT_EQ(b.exchanges.size(), 3u);
  EXPECT_EQ(b.exchanges[2].body, surface(section_name("bore", 2, 3)));
  EXPECT_EQ(b.exchanges[2].per, Per::kTotal);
}

TEST(CoolantChannel, CutsALineInto40Sections) {
  const HeatBalance b = heat_balance({read(
      "{type: coolant_channel, surface: bore, along: [[0 mm, 0 mm, 0 mm], [0.1 m, 0 mm, 0 mm]], flow: 1 L/min, diameter: 8 "
      "mm, length: 100 mm, set_point: 20 degC}")});
  EXPECT_EQ(b.exchanges.size(), 40u);
}

TEST(CoolantChannel, ComesBackFromItsText) {
  const std::string text =
      "{type: coolant_channel, surface: bore, flow: 2 L/min, diameter: 8 mm, length: 100 mm, sections: 4, set_point: 21 "
      "degC, along: [[0 mm, 0 mm, 0.5 mm], [100 mm, -2.25 mm, 0 mm]]}";
  EXPECT_EQ(yaml_of(read(text)), text);
  EXPECT_EQ(
      yaml_of(read(kTwoBodies)),
      "{type: coolant_channel, node: a, flow: 1.2 L/min, diameter: 8 mm, length: 600 mm, set_point: 20 degC, then: [b]}");
}

struct Bad {
  const char* keys;
  const char* message;
};
class ChannelErrors : public ::testing::TestWithParam<Bad> {};

TEST_P(ChannelErrors, NameWhatIsWrong) {
  EXPECT_REFUSED(read("{type: coolant_channel, diameter: 8 mm, length: 600 mm, " + std::string(GetParam().keys) + "}"),
                 GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ChannelErrors,
    ::testing::Values(
        Bad{"node: a, flow: 2 L/min", "held at its `set_point`"},
        Bad{"node: a, flow: 2 L/min, set_point: 20 degC, volume: 5 L", "allowed only with a `tank`"},
        Bad{"node: a, flow: 2 L/min, tank: t, pump_power: 20 W", "requires the `volume` of the tank"},
        Bad{"node: a, flow: 2 L/min, tank: t, set_point: 20 degC", "the node of another entry"},
        Bad{"node: a, flow: 2 L/min, tank: ambient, volume: 5 L", "the ambient is no tank"},
        Bad{"node: a, flow: 2 kg/s, set_point: 20 degC", "flow"},
        Bad{"node: a, flow: 60000 L/min, set_point: 20 degC", "Reynolds number"},
        Bad{"node: a, flow: 2 L/min, set_point: 20 degC, along: [[0 mm, 0 mm, 0 mm], [1 mm, 0 mm, 0 mm]]",
            "cuts a `surface`"},
        Bad{"surface: a, flow: 2 L/min, set_point: 20 degC, sections: 4", "requires `along`"},
        Bad{"surface: a, flow: 2 L/min, set_point: 20 degC, then: [b], along: [[0 mm, 0 mm, 0 mm], [1 mm, 0 mm, 0 mm]]",
            "cuts one surface"},
        Bad{"surface: a, flow: 2 L/min, set_point: 20 degC, along: [[0 mm, 0 mm, 0 mm]]", "two points or more"},
        Bad{"surface: a, flow: 2 L/min, set_point: 20 degC, along: [[0 mm, 0 mm], [1 mm, 0 mm]]", "rows of"},
        Bad{"surface: a, flow: 2 L/min, set_point: 20 degC, sections: 2.5, along: [[0 mm, 0 mm, 0 mm], [1 mm, 0 mm, 0 mm]]",
            "whole number"},
        Bad{"node: a, flow: 2 L/min, set_point: 20 degC, then: b", "must be a list"},
        Bad{"node: a, flow: 2 L/min, set_point: 20 degC, then: ['b, c']", "contain a comma"},
        Bad{"node: a, flow: 2 L/min, set_point: 20 degC, perimeter: 30 mm", "longer than the whole wetted perimeter"},
        Bad{"node: a, flow: 2 L/min, set_point: 20 degC, medium: oil", "requires its viscosity"},
        Bad{"node: a, flow: 2 L/min, set_point: 100 degC", "the table of `medium: water` ends there"},
        Bad{"node: a, flow: 2 L/min, set_point: 20 degC, medium: milk", "'milk' is not known here"}));

}  // namespace
}  // namespace driftwright::effects::coolant_channel_test
