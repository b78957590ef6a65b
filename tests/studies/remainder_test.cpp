// What a scenario misses, learned beside it, next to a plain regression and the noise of the readings.

#include "studies/remainder.hpp"

#include <gtest/gtest.h>

#include "scenarios/reader/scenario.hpp"
#include "tests/shared/edited_text.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::studies::remainder_test {
namespace {

/// One body of 20 min; its heat goes with the turning spindle.
constexpr const char* kBody = R"(name: body
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 12 kJ/K}
  - {type: link, node: head, to: ambient, conductance: 10 W/K}
  - {type: heat_source, node: head, power: 100 W, runs: while_spindle_turns}
ambient: 20 degC
sensors:
  - {name: t_head, node: head}
displacements:
  - name: nose
    sensitivities:
      - {node: head, sensitivity: 3 um/K}
cyclograms:
  monday: [[60 min, 0 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm], [60 min, 0 rpm], [100 min, 1900 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 0 rpm], [60 min, 1000 rpm], [60 min, 0 rpm], [60 min, 2000 rpm]]
solver: {output_interval: 1 min}
)";

// The regression has the spindle on after 20 min among its columns, so it leaves little more than the noise; hidden speeds
// cost it most. So does the extension. Half of the heat is missing: while the spindle turns, 5 K in the end.
TEST(LearnBeside, SaysWhatARegressionAndTheNoiseLeave) {
  const std::string scenario = write_file("half.yaml", fixtures::replaced(kBody, "power: 100 W", "power: 50 W"));
  const std::vector<std::string> records =
      diagnosis::noisy_records(write_file("truth.yaml", kBody), "", {.noise_K = 0.05, .noise_um = 0.3});
  const MeasuredTwin m = open_measured_twin(scenarios::read_scenario(scenario), "identify --prior", records, {});
  const LearnedBeside learned = learn_beside(m, m.twin->as_written(), {});
  ASSERT_EQ(learned.network.channels.size(), 2u);
  for (const identification::IdentifiedChannel& c : learned.network.channels) {
    const double noise = c.name == "nose" ? 0.3 : 0.05;
    EXPECT_NEAR(c.noise, noise, 0.15 * noise) << c.name;
    EXPECT_GT(c.regression_kept_out, 0.9 * noise) << c.name;
    EXPECT_LT(c.regression_kept_out, 2.5 * noise) << c.name;
    EXPECT_GT(c.scenario_kept_out, c.name == "nose" ? 4.0 : 1.5) << c.name;
    EXPECT_TRUE(c.is_extended) << c.name;
    EXPECT_LT(c.missed_kept_out, 1.5 * noise) << c.name;
  }
  // The amounts are known far better than a half, and their error grows beyond the fastest of these speeds.
  double n_of_drive = 0.0;
  for (const effects::Effect& e : learned_effects(learned.network)) {
    if (e.words.at("follows") != "running" && e.words.at("follows") != "speed") continue;
    n_of_drive += 1.0;
    ASSERT_TRUE(e.has("error") && e.has("at_speed")) << e.place;
    EXPECT_NEAR(e["at_speed"], 2000.0, 1e-9);
    EXPECT_GT(e["error"], 0.0) << e.place;
    EXPECT_LT(e["error"], e.place == "nose" ? 7.5 : 2.5) << e.place;
  }
  EXPECT_GE(n_of_drive, 2.0);
  for (const effects::Effect& e : learned_effects(learned.network)) {  // the first of each channel says what it still misses
    if (!e.has("misses")) continue;
    EXPECT_LT(e["misses"], (e.place == "nose" ? 0.3 : 0.05) * 2.0) << e.place;  // the scenario missed ten times as much
  }
}

// Five folds that miss 0.5 um beside a noise of 0.3 um: sqrt(0.25 - 0.09) = 0.4 um, Student's 2.5706 instead of 1.96.
TEST(RemainingSd, IsWhatFoldsMissWithoutTheNoise) {
  identification::IdentifiedChannel channel;
  EXPECT_EQ(remaining_sd(channel), 0.0) << "no fold could judge";
  channel.square_kept_out = {.mean = 0.25, .standard_error = 0.0, .n = 5};
  channel.noise = 0.3;
  EXPECT_NEAR(remaining_sd(channel), 0.4 * 2.5706 / 1.96, 1e-4);
  channel.noise = 0.6;
  EXPECT_EQ(remaining_sd(channel), 0.0) << "no more than the noise";
}

// An entry that keeps all and adds nothing could not be read back.
TEST(LearnedEffects, SayNothingOfAChannelThatKeepsAllAndAddsNothing) {
  identification::Identified extension;
  identification::IdentifiedChannel& c = extension.channels.emplace_back();
  c.name = "nose";
  c.unit = "um";
  c.is_extended = true;
  c.fit.kept = 1.0 - 1e-8;
  EXPECT_TRUE(learned_effects(extension).empty());
  c.fit.kept = 0.9;
  ASSERT_EQ(learned_effects(extension).size(), 1u);
  EXPECT_EQ(learned_effects(extension).front()["keeps"], 0.9);
}

// Beside what a diagnosis wrote, here the scenario as it was.
TEST(LearnBeside, IsTheRemainderOfADiagnosis) {
  const std::string scenario = write_file("half.yaml", fixtures::replaced(kBody, "power: 100 W", "power: 50 W"));
  const std::vector<std::string> records =
      diagnosis::noisy_records(write_file("truth.yaml", kBody), "", {.noise_K = 0.05, .noise_um = 0.3});
  const MeasuredTwin m = open_measured_twin(scenarios::read_scenario(scenario), "diagnose", records, {});
  WrittenScenario written;
  written.effects = m.twin->as_written();
  diagnosis::Diagnosis d;
  d.verdict = diagnosis::Verdict::kUnexplained;
  const Remainder remainder = remainder_of(m, d, written, {});
  EXPECT_EQ(remainder.why_not, "");
  ASSERT_EQ(remainder.channels.size(), 2u);
  for (const RemainderGain& g : remainder.channels) {
    EXPECT_EQ(g.unit, g.name == "nose" ? "um" : "K");
    EXPECT_TRUE(g.is_learned) << g.name;
    EXPECT_LT(g.rmse_with_remainder, 0.2 * g.rmse_file) << g.name;
  }
  d.verdict = diagnosis::Verdict::kInsufficientData;
  EXPECT_EQ(remainder_of(m, d, written, {}).why_not, "The readings are too few.");
  EXPECT_TRUE(remainder_of(m, d, written, {}).channels.empty());
}

}  // namespace
}  // namespace driftwright::studies::remainder_test
