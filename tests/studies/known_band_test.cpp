// The band about a curve by what is known of the numbers: one body, whose course and sensitivities have a closed form.

#include "studies/known_band.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "studies/prediction.hpp"
#include "tests/shared/edited_text.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::studies::known_band_test {
namespace {

using ::testing::HasSubstr;

constexpr double kPower_W = 100.0, kConductance_W_K = 5.0, kCapacity_J_K = 10e3, kSensitivity_um_K = 2.0;

/// One body in constant heat. @param capacity, power, conductance  further keys of each
scenarios::Scenario body(const std::string& capacity, const std::string& power, const std::string& conductance) {
  return scenarios::read_scenario(write_file(
      "body.yaml",
      fmt::format("name: body\nreference_temperature: 20 degC\nambient: 20 degC\nmachine: {{generator: lumped}}\neffects:\n"
                  "  - {{type: node, node: body, capacity: 10 kJ/K{}}}\n"
                  "  - {{type: heat_source, node: body, power: 100 W{}}}\n"
                  "  - {{type: link, node: body, to: ambient, conductance: 5 W/K{}}}\n"
                  "sensors: [{{name: t_body, node: body}}]\n"
                  "displacements: [{{name: z, sensitivities: [{{node: body, sensitivity: 2 um/K}}]}}]\n"
                  "cyclograms: {{warm: [[120 min, 1000 rpm]]}}\n",
                  capacity, power, conductance)));
}

Prediction predicted(const scenarios::Scenario& scenario) {
  return predict_drift(scenario, scenario.cyclogram("warm"), {.with_band = true}, {}, "test");
}

double high(const Prediction& p, const std::string& channel, std::size_t row) {
  return p.band->high(channel)->values[row] - p.record.at(channel).values[row];
}
double low(const Prediction& p, const std::string& channel, std::size_t row) {
  return p.band->low(channel)->values[row] - p.record.at(channel).values[row];
}

TEST(KnownBand, OfSmallUncertaintiesIsThatOfLinearTheory) {
  const double sd_capacity = 0.001, sd_power = 0.002, sd_conductance = 0.0015;
  const Prediction p = predicted(body(", known_to: 0.1 %", ", known_to: 0.2 %", ", known_to: 0.15 %"));
  ASSERT_TRUE(p.band);
  for (const std::size_t row : {std::size_t{5}, std::size_t{30}, std::size_t{60}, std::size_t{120}}) {
    const double t_s = p.record.time_s[row], steady_K = kPower_W / kConductance_W_K;
    const double x = kConductance_W_K * t_s / kCapacity_J_K, decay = std::exp(-x), rise_K = steady_K * (1.0 - decay);
    const double by_power = rise_K, by_conductance = -rise_K + steady_K * x * decay, by_capacity = -steady_K * x * decay;
    const double sd_K = std::hypot(sd_power * by_power, sd_conductance * by_conductance, sd_capacity * by_capacity);
    const double half = 0.5 * (high(p, "z", row) - low(p, "z", row));
    EXPECT_NEAR(half / (1.96 * kSensitivity_um_K * sd_K), 1.0, 1e-3) << row;  // ten times as wide, it is 4e-3 away
    EXPECT_NEAR(0.5 * (high(p, "t_body", row) - low(p, "t_body", row)) / (1.96 * sd_K), 1.0, 1e-3) << row;
  }
  EXPECT_EQ(high(p, "z", 0), 0.0) << "the start is known";
}

TEST(KnownBand, OfAGuessIsSkewedAsTheNumberIs) {
  const Prediction p = predicted(body("", ", known_to: guess", ""));
  const double drift_um = p.record.at("z").values.back();
  EXPECT_NEAR((drift_um + high(p, "z", 120)) / drift_um, std::pow(2.0, 1.96), 0.02 * std::pow(2.0, 1.96));
  EXPECT_NEAR((drift_um + low(p, "z", 120)) / drift_um, std::pow(2.0, -1.96), 0.02 * std::pow(2.0, -1.96));
}

TEST(KnownBand, IsThereOnlyWhereTheScenarioSaysWhatIsKnown) {
  EXPECT_FALSE(predicted(body("", "", "")).band);
  EXPECT_FALSE(predicted(body("", ", known_to: fixed", "")).band);
  const scenarios::Scenario scenario = body("", ", known_to: 10 %", ", known_to: 30 %");
  EXPECT_FALSE(predict_drift(scenario, scenario.cyclogram("warm"), {}, {}, "test").band) << "nobody asked";
  EXPECT_THAT(predicted(scenario).band->words, HasSubstr("2 numbers known to 10 to 30 %"));
}

/// The body with how well its power and its conductance are known together.
scenarios::Scenario fitted_body(const std::string& known_together) {
  return scenarios::read_scenario(
      write_file("fitted.yaml", read_text(body("", "", "").path) + "known_together: " + known_together + "\n"));
}

// ln power = 0.01 a, ln conductance = 0.01 a + 0.002 b with independent a, b: their quotient is known better than either.
TEST(KnownBand, OfNumbersThatAreKnownTogetherIsThatOfLinearTheory) {
  const Prediction p =
      predicted(fitted_body("{numbers: [heat_source body power, \"link body,ambient conductance\"], values: [100, 5], "
                            "factor: [0.01, 0.01, 0.002]}"));
  ASSERT_TRUE(p.band);
  const double t_s = p.record.time_s[120], steady_K = kPower_W / kConductance_W_K;
  const double x = kConductance_W_K * t_s / kCapacity_J_K, decay = std::exp(-x), rise_K = steady_K * (1.0 - decay);
  const double by_conductance = -rise_K + steady_K * x * decay;
  const double sd_K = std::hypot(0.01 * (rise_K + by_conductance), 0.002 * by_conductance);
  EXPECT_NEAR(0.5 * (high(p, "t_body", 120) - low(p, "t_body", 120)) / (1.96 * sd_K), 1.0, 0.01);  // each by itself: 6.5
  EXPECT_THAT(p.band->words, HasSubstr("2 numbers known to 1 to 1.02 % (`known_together` and `known_to`"));
}

TEST(KnownBand, IsRefusedWhereWhatIsKnownTogetherDoesNotFitTheScenario) {
  EXPECT_REFUSED(fitted_body("{numbers: [heat_source body power], values: [100], factor: [0.1, 0.2]}"), "fitted.yaml",
                 "factor", "1 numbers need 1 entries");
  EXPECT_REFUSED(fitted_body("{numbers: [a, a], values: [1, 1], factor: [0.1, 0, 0.2]}"), "'a' is listed twice");
  EXPECT_REFUSED(fitted_body("{numbers: [a, b], values: [1, 1], factor: [0.1, 0, 0]}"), "row 2",
                 "'b' would be known exactly");
  EXPECT_REFUSED(fitted_body("{numbers: [a, b], values: [1], factor: [0.1, 0, 0.1]}"), "values", "2 numbers need 2 values");
  const Prediction p = predicted(fitted_body("{numbers: [heat_source shaft power], values: [100], factor: [0.1]}"));
  ASSERT_TRUE(p.band);
  EXPECT_TRUE(p.band->limits.channels.empty());
  EXPECT_THAT(p.band->words, HasSubstr("names 'heat_source shaft power', which the scenario does not have"));
}

TEST(KnownBand, IsRefusedWhereANumberWasChangedAfterItsFit) {
  const auto words = [](double power_W) {
    const Prediction p =
        predicted(fitted_body(fmt::format("{{numbers: [heat_source body power], values: [{}], factor: [0.1]}}", power_W)));
    return p.band->limits.channels.empty() ? p.band->words : std::string();
  };
  EXPECT_EQ(words(100.0001), "") << "a band: the same to six digits";
  EXPECT_THAT(words(101.0), HasSubstr("'heat_source body power' is 100 in SI units, and 101 in `known_together`"));
  EXPECT_THAT(words(101.0), HasSubstr("Calibrate the scenario again"));
}

// Two powers of one body have the same name but for its number; the first one is exact, and the second one was fitted.
TEST(KnownBand, CountsNamesThatAreAlikeInOneListOfAllNumbers) {
  const std::string text = read_text(body("", "", "").path);
  const auto half = [&](const std::string& second) {
    const scenarios::Scenario s = scenarios::read_scenario(
        write_file("alike.yaml",
                   fixtures::replaced(text, "  - {type: link", "  - {type: heat_source, node: body, power: 50 W" + second)));
    const Prediction p = predicted(s);
    return p.band && !p.band->limits.channels.empty() ? high(p, "z", 120) : 0.0;
  };
  const double by_known_to = half(", known_to: 10 %}\n  - {type: link");
  EXPECT_GT(by_known_to, 0.0);
  const std::string fitted = fixtures::replaced(
      text, "  - {type: link", "  - {type: heat_source, node: body, power: 50 W, known_to: 10 %}\n  - {type: link");
  const Prediction p = predicted(scenarios::read_scenario(write_file(
      "alike.yaml", fitted + "known_together: {numbers: [heat_source body power 2], values: [50], factor: [0.1]}\n")));
  EXPECT_THAT(p.band->words, HasSubstr("1 number known to 10 %")) << "it is not counted twice";
  EXPECT_NEAR(high(p, "z", 120), by_known_to, 1e-3 * by_known_to);
}

// Its rows differ by 1.118e-4, their numbers by a factor of two (`guess`).
TEST(KnownTogether, KeepsAQuotientThatIsKnownMuchBetterThanItsNumbers) {
  scenarios::KnownTogether known{.numbers = {"a", "b"}, .values = {1.0, 1.0}, .factor = Eigen::MatrixXd::Zero(2, 2)};
  known.factor << 0.7123456, 0.0, 0.7123956, 1e-4;
  const scenarios::Scenario again =
      scenarios::read_scenario(write_file("fitted.yaml", read_text(body("", "", "").path) + scenarios::yaml_of(known)));
  const Eigen::MatrixXd& factor = again.machine->known_together.factor;
  EXPECT_NEAR((factor.row(1) - factor.row(0)).norm(), std::hypot(5e-5, 1e-4), 1e-6);
}

/// The body with a part of its drift learned, which still misses 3 um (one sigma).
scenarios::Scenario learned_body(const std::string& power) {
  const std::string text = read_text(body("", power, "").path);
  return scenarios::read_scenario(
      write_file("learned.yaml",
                 fixtures::replaced(text, "sensors:",
                                    "  - {type: learned, displacement: z, misses: 3, follows: running, grows: [[10 min, "
                                    "5 um]]}\nsensors:")));
}

TEST(KnownBand, ContainsWhatLearnedEffectsStillMiss) {
  const Prediction p = predicted(learned_body(""));
  ASSERT_TRUE(p.band);
  EXPECT_NEAR(high(p, "z", 60), 1.96 * 3.0, 1e-9);
  EXPECT_NEAR(low(p, "z", 60), -1.96 * 3.0, 1e-9);
  EXPECT_EQ(p.band->high("t_body"), nullptr) << "nothing was learned of it";
  EXPECT_THAT(p.band->words, HasSubstr("The bands of 1 channel contain what the effects `learned` still miss"));
}

// Learned up to 400 rpm, asked at 1000: with the excess e = (1000 / 400 - 1) (1 - exp(-t / 10 min)), 5 um e are missing if
// the law goes on, and its amount is known to 2 um (one sigma).
TEST(KnownBand, GrowsBeyondTheSpeedsThatWereLearnedFrom) {
  const std::string text = read_text(body("", "", "").path);
  const Prediction p = predicted(scenarios::read_scenario(
      write_file("beyond.yaml", fixtures::replaced(text, "sensors:",
                                                   "  - {type: learned, displacement: z, misses: 3, error: 2, at_speed: 400 "
                                                   "rpm, follows: running, grows: [[10 min, 5 um]]}\nsensors:"))));
  ASSERT_TRUE(p.band);
  EXPECT_NEAR(high(p, "z", 0), 1.96 * 3.0, 1e-9);
  const double excess = 1.5 * (1.0 - std::exp(-p.record.time_s[60] / 600.0));
  EXPECT_NEAR(high(p, "z", 60), 1.96 * std::sqrt(9.0 + std::pow(5.0 * excess, 2) + std::pow(2.0 * excess, 2)), 1e-3);
}

TEST(KnownBand, AddsWhatIsStillMissedToTheNumbers) {
  const Prediction p = predicted(learned_body(", known_to: 1 %"));
  ASSERT_TRUE(p.band);
  const double x = kConductance_W_K * p.record.time_s[60] / kCapacity_J_K;
  const double by_power_um = 0.01 * kSensitivity_um_K * kPower_W / kConductance_W_K * (1.0 - std::exp(-x));
  EXPECT_NEAR(high(p, "z", 60), 1.96 * std::hypot(3.0, by_power_um), 2e-2 * by_power_um);
  EXPECT_NEAR(high(p, "t_body", 60) * kSensitivity_um_K, 1.96 * by_power_um, 0.04 * by_power_um);
}

// Machines drawn as `known_to` says, and a remainder as `misses` says, against the closed form: 95 % are in the band.
TEST(KnownBand, HoldsNinetyFivePerCentOfTheMachines) {
  const Prediction p = predicted(learned_body(", known_to: 30 %"));
  ASSERT_TRUE(p.band);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const double x = kConductance_W_K * p.record.time_s[60] / kCapacity_J_K;
  const double drift_um = kSensitivity_um_K * kPower_W / kConductance_W_K * (1.0 - std::exp(-x));
  const int n = 40000;
  int n_inside = 0;
  for (int i = 0; i < n; ++i) {
    const double less_um = drift_um * std::expm1(0.3 * normal(random)) + 3.0 * normal(random);
    if (less_um >= low(p, "z", 60) && less_um <= high(p, "z", 60)) ++n_inside;
  }
  EXPECT_NEAR(n_inside / static_cast<double>(n), 0.95, 0.01);  // without the remainder 0.935, without the numbers 0.43
}

TEST(KnownBand, LeavesOutMachinesWithoutASolutionAndSaysSo) {
  // A law that refuses temperatures far above the oil's range refuses some machines of a power that is a guess.
  const scenarios::Scenario scenario = scenarios::read_scenario(
      write_file("oil.yaml",
                 "name: oil\nreference_temperature: 20 degC\nambient: 20 degC\nmachine: {generator: lumped}\neffects:\n"
                 "  - {type: node, node: body, capacity: 10 kJ/K}\n"
                 "  - {type: heat_source, node: body, power: 550 W, known_to: guess}\n"
                 "  - {type: bearing_friction, node: body, f0: 0.4, viscosity_40: 25 mm^2/s, viscosity_100: 5.4 mm^2/s, "
                 "mean_diameter: 90 "
                 "mm, f1: 0.0006, load: 10 N}\n"
                 "  - {type: link, node: body, to: ambient, conductance: 5 W/K}\n"
                 "displacements: [{name: z, sensitivities: [{node: body, sensitivity: 2 um/K}]}]\n"
                 "cyclograms: {warm: [[120 min, 100 rpm]]}\n"));
  const Prediction p = predicted(scenario);
  ASSERT_TRUE(p.band);
  EXPECT_THAT(p.band->words, HasSubstr("drawn machines have no solution"));
}

TEST(KnownBand, SaysThatNoReducedModelFollowsAPrescribedCourse) {
  scenarios::Scenario scenario = body("", ", known_to: 10 %", "");
  scenario.machine->effects.push_back(effects::read_effect(ConfigMap::read_file(
      write_file("held.yaml", "{type: fixed_temperature, surface: s, temperature: [[0 s, 20 degC], [60 s, 30 degC]]}"))));
  const scenarios::Model none{};
  const auto band = known_band(scenario, {none, scenario.cyclogram("warm"), scenario.machine->ambient, {}}, {});
  ASSERT_TRUE(band);
  EXPECT_TRUE(band->limits.channels.empty());
  EXPECT_THAT(band->words, HasSubstr("prescribed over time"));
}

}  // namespace
}  // namespace driftwright::studies::known_band_test
