// Tests the component for LinuxCNC: its C body with substitutes for HAL, compared with closed forms, and, if halcompile is
// installed, halcompile itself.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/output/component_stand_in.hpp"
#include "tests/shared/deployed_model.hpp"

namespace driftwright::output::linuxcnc_component_test {
namespace {

using ::testing::HasSubstr;

/// Exports of a model into a folder, as `validate` writes them.
std::filesystem::path exported(const std::string& folder_name, const DeployedModel& d) {
  std::filesystem::path folder = folder_for_exports(folder_name);
  std::ofstream(folder / "model.c") << c_function(d, "a test");
  std::ofstream(folder / "model_axis.comp") << linuxcnc_component(d, "model_axis", "model.c", "a test");
  return folder;
}

// T = 30 degC: 20 um, so the axis goes to -20 um at 0.5 um/s: 40 s, and back as fast. 0.1 um a count.
TEST(LinuxcncComponent, LeadsTheAxisThereAndBackAtTheSlewLimit) {
  Component c(exported("there_and_back", two_um_per_K()));
  int heartbeat = 0;
  c.set("T_degC", 30.0);
  c.set("enable", 1);
  c.set("machine_is_on", 1);
  c.cycles(kSecond, kCycle_ns);  // no heartbeat yet
  beating(c, 100, heartbeat);
  c.set("enable", 0);
  beating(c, 100, heartbeat);
  const auto out = c.outputs();
  ASSERT_EQ(out.size(), 1001u);
  EXPECT_EQ(out[0].at("heartbeat_is_late"), 1.0);
  EXPECT_EQ(out[0].at("correction_um"), 0.0);
  EXPECT_EQ(out[0].at("eoffset_enable"), 0.0);
  for (int i = 1; i <= 500; ++i) {
    const auto& o = out[static_cast<std::size_t>(i)];
    const double wanted_um = -std::min(20.0, 0.5 * 0.2 * i);
    ASSERT_NEAR(o.at("axis_offset_um"), wanted_um, 1e-9) << i;
    ASSERT_NEAR(o.at("eoffset_counts"), 10.0 * wanted_um, 0.5 + 1e-6) << i;
    ASSERT_EQ(o.at("eoffset_enable"), 1.0);
    ASSERT_EQ(o.at("correction_um"), 20.0) << i;
    ASSERT_EQ(o.at("model_trust"), 1.0);
  }
  EXPECT_EQ(out[500].at("eoffset_counts"), -200.0);
  EXPECT_EQ(out[500].at("eoffset_scale"), 0.1 / 1000.0);  // mm
  for (int i = 1; i <= 500; ++i) {
    ASSERT_NEAR(out[static_cast<std::size_t>(500 + i)].at("axis_offset_um"), -std::max(0.0, 20.0 - 0.1 * i), 1e-9) << i;
  }
  EXPECT_EQ(out[1000].at("axis_offset_um"), 0.0);
  EXPECT_EQ(out[1000].at("eoffset_counts"), 0.0);
  EXPECT_EQ(out[1000].at("eoffset_enable"), 0.0);
}

// The heartbeat stops: 2 s later the offset goes back. The readings are then no news: after 5 s more without, the sensor
// is in doubt.
TEST(LinuxcncComponent, GoesBackWhenTheWatchdogBites) {
  Component c(exported("watchdog", two_um_per_K()));
  int heartbeat = 0;
  c.set("T_degC", 30.0);
  c.set("enable", 1);
  c.set("machine_is_on", 1);
  c.set("most_age_s", 2.0);
  beating(c, 60, heartbeat);
  for (int i = 0; i < 60; ++i) c.cycles(kSecond, kCycle_ns);  // out[300 + i]: i + 1 s and 0.2 s without a change
  const auto out = c.outputs();
  EXPECT_NEAR(out[299].at("axis_offset_um"), -20.0, 1e-12);
  for (int i = 0; i < 60; ++i) {
    const auto& o = out[static_cast<std::size_t>(300 + i)];
    const double late_s = std::max(0.0, i + 1 + 0.2 - 2.0);
    EXPECT_NEAR(o.at("axis_offset_um"), -std::max(0.0, 20.0 - 0.5 * late_s), 0.5 * 2e-3) << i;  // a cycle or two
    EXPECT_EQ(o.at("heartbeat_is_late"), i >= 1) << i;
    if (i <= 5 || i >= 8) {
      EXPECT_EQ(o.at("doubt_T_degC"), i >= 8) << i;
    }
  }
  EXPECT_EQ(out[359].at("eoffset_counts"), 0.0);
}

TEST(LinuxcncComponent, IsAtZeroWhileTheMachineIsOffAndBeginsAnewAtARestart) {
  DeployedModel d = two_um_per_K();
  d.model.from_start = d.safe.from_start = true;
  d.model.intercept = 0.0;
  d.safe.guards[0].low = -50;
  Component c(exported("restart", d));
  int heartbeat = 0;
  c.set("enable", 1);
  c.set("machine_is_on", 1);
  c.set("most_rate_um_s", 5.0);
  c.set("sign", 1.0);
  c.set("count_um", 0.5);
  c.set("machine_unit_um", 25400.0);
  c.set("T_degC", 23.0);
  beating(c, 10, heartbeat);
  c.set("T_degC", 29.0);
  beating(c, 60, heartbeat);  // 0.5 um/s to 12 um: the model's own slew limit
  const std::size_t warm = 349;
  c.set("machine_is_on", 0);
  beating(c, 1, heartbeat);
  c.set("machine_is_on", 1);
  beating(c, 10, heartbeat);
  c.set("restart", 1);
  beating(c, 10, heartbeat);
  const std::size_t forgotten = warm + 5 + 50 + 50;
  c.set("restart", 0);
  c.set("T_degC", 31.0);
  beating(c, 10, heartbeat);
  c.set("T_degC", 32.0);
  beating(c, 10, heartbeat);
  c.set("count_um", -1.0);
  beating(c, 10, heartbeat);
  const auto out = c.outputs();
  EXPECT_EQ(out[49].at("correction_um"), 0.0);
  EXPECT_EQ(out[warm].at("correction_um"), 12.0);
  EXPECT_EQ(out[warm].at("axis_offset_um"), 12.0);
  EXPECT_EQ(out[warm].at("eoffset_counts"), 24.0);
  EXPECT_EQ(out[warm].at("eoffset_scale"), 0.5 / 25400.0);
  EXPECT_EQ(out[warm + 1].at("eoffset_counts"), 0.0);
  EXPECT_EQ(out[warm + 1].at("eoffset_enable"), 0.0);
  EXPECT_EQ(out[warm + 1].at("correction_um"), 12.0);          // the model goes on
  EXPECT_NEAR(out[warm + 6].at("axis_offset_um"), 1.0, 1e-9);  // 5 um/s, for 0.2 s
  EXPECT_EQ(out[warm + 55].at("axis_offset_um"), 12.0);
  EXPECT_EQ(out[forgotten].at("correction_um"), 0.0);
  EXPECT_EQ(out[forgotten].at("axis_offset_um"), 0.0);
  EXPECT_EQ(out[forgotten + 50].at("correction_um"), 0.0);  // 31 degC is the start now
  EXPECT_EQ(out[forgotten + 100].at("correction_um"), 2.0);
  EXPECT_EQ(out[forgotten + 150].at("setting_is_wrong"), 1.0);
  EXPECT_EQ(out[forgotten + 150].at("eoffset_counts"), 0.0);
}

// Period by period the component's model is the exported function: here with all sorts of terms, and a sensor that falls
// off.
TEST(LinuxcncComponent, StepsTheModelAsFarApartAsItWasJudgedOn) {
  const DeployedModel d = fixtures::deployed(true, 60.0);
  Record r = fixtures::machine(5, 60.0);
  for (std::size_t i = 60; i < 120; ++i) r.channels[2].values[i] = 12.0;
  r.channels[1].values[30] = NAN;
  Component c(exported("steps", d));
  c.set("machine_is_on", 1);
  const compensation::Repaired repaired = compensation::repaired(d.safe, r);
  const compensation::GuardedCorrection wanted = compensation::guarded(d.safe, repaired, d.model.predict(repaired.readings));
  c.set("heartbeat", 0);
  c.cycles(1, 1);
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    for (const char* name : {"X1", "X2", "X3", "X4"}) c.set(std::string(name) + "_degC", r.at(name).values[i]);
    c.set("spindle_rpm", r.at("spindle").values[i]);
    c.set("heartbeat", i % 2 == 0);
    // a quarter of a second a cycle; the first cycle takes the step, the others of the minute wait
    c.cycles(i == 0 ? 1 : 240, 250000000);
  }
  const auto out = c.outputs();
  ASSERT_EQ(out.size(), r.n_samples() + 1);
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    ASSERT_EQ(out[i + 1].at("correction_um"), wanted.correction_um[i]) << i;
    ASSERT_EQ(out[i + 1].at("model_trust"), wanted.trust[i]) << i;
  }
  EXPECT_EQ(out[80].at("doubt_X3_degC"), 1.0);
}

// 20 um of correction, and the axis is 8 um off: the probe reads that on the corrected axis, once for each time that the
// strobe turns on. Then the residual fades with its time constant. A chip is refused, what is probed twice is a jump.
TEST(LinuxcncComponent, TakesProbings) {
  DeployedModel d = two_um_per_K();
  d.residual = compensation::ResidualProcess{5.0, 1800.0};
  d.probe = {0.1, 0.0};
  Component c(exported("probed", d));
  int heartbeat = 0;
  c.set("T_degC", 30.0);
  c.set("enable", 1);
  c.set("machine_is_on", 1);
  beating(c, 60, heartbeat);
  const auto probe = [&](double um) {
    c.set("probe_um", um);
    c.set("probe_strobe", 1);
    beating(c, 1, heartbeat);
    c.set("probe_strobe", 0);
  };
  probe(8.0);
  beating(c, 599, heartbeat);
  probe(-60.0);
  beating(c, 9, heartbeat);
  probe(-60.0);
  beating(c, 199, heartbeat);
  probe(NAN);
  const auto out = c.outputs();
  compensation::ProbeFeedback feedback({5.0, 1800.0}, {.noise_um = 0.1}, false);
  feedback.row(20.0, 0.0, 0.0);
  EXPECT_EQ(out[299].at("correction_um"), 20.0);
  // nothing is known of a drift that does not count from the start
  EXPECT_NEAR(out[299].at("probe_sigma_um"), feedback.deviation_um(), 1e-9);
  EXPECT_TRUE(feedback.probe_drift_um(28.0));
  EXPECT_EQ(out[304].at("probe_verdict"), 1.0);
  EXPECT_NEAR(out[304].at("probe_off_um"), 8.0, 1e-9);
  EXPECT_NEAR(out[304].at("correction_um"), 20.0 + feedback.estimate_um(), 0.05);  // 1 s later
  EXPECT_NEAR(out[350].at("axis_offset_um"), -20.0 - 0.5 * 10.2, 0.02);            // on its way, at 0.5 um/s
  for (int k = 0; k < 600; ++k) feedback.row(20.0, 0.0, 1.0);
  EXPECT_NEAR(out[3299].at("axis_offset_um"), -20.0 - feedback.estimate_um(), 0.02);
  EXPECT_NEAR(out[3299].at("probe_sigma_um"), feedback.deviation_um(), 0.02);
  EXPECT_EQ(out[3304].at("probe_verdict"), 3.0);
  EXPECT_EQ(out[3304].at("refused_probings"), 1.0);
  EXPECT_NEAR(out[3304].at("correction_um"), 20.0 + feedback.estimate_um(), 0.02);
  EXPECT_EQ(out[3354].at("probe_verdict"), 2.0);
  EXPECT_NEAR(out[3354].at("probe_residual_um"), feedback.estimate_um() - 60.0, 0.3);
  // the jump does not fade, what was left before it does
  for (int k = 0; k < 210; ++k) feedback.row(20.0, 0.0, 1.0);
  EXPECT_NEAR(out[4349].at("axis_offset_um"), -(20.0 + feedback.estimate_um() - 60.0), 0.5);
  EXPECT_EQ(out[4354].at("probe_verdict"), 5.0);
  EXPECT_EQ(out[4354].at("refused_probings"), 2.0);
  EXPECT_EQ(out[4354].at("setting_is_wrong"), 0.0);
}

// The blend says 20 um, its members 30 and 10 um. The axis is at 30 um: the first member expected it, gains weight, and
// leads from then on. The same numbers by the filters of the program, which are fed once a second as the component is.
TEST(LinuxcncComponent, MovesTheWeightsOfABlend) {
  DeployedModel d = two_um_per_K();
  d.residual = compensation::ResidualProcess{5.0, 1800.0};
  d.probe = {0.1, 0.0};
  d.members = {d.model, d.model};
  d.members[0].intercept = -30.0;
  d.members[1].intercept = -50.0;
  d.member_residuals = {{"high", {4.0, 3600.0}}, {"low", {4.0, 3600.0}}};
  Component c(exported("blend", d));
  int heartbeat = 0;
  c.set("T_degC", 30.0);
  c.set("enable", 1);
  c.set("machine_is_on", 1);
  beating(c, 100, heartbeat);
  c.set("probe_um", 10.0);  // with 20 um in force
  c.set("probe_strobe", 1);
  beating(c, 1, heartbeat);
  c.set("probe_strobe", 0);
  beating(c, 599, heartbeat);
  c.set("probe_um", 0.5);  // with about 30 um in force
  c.set("probe_strobe", 1);
  beating(c, 1, heartbeat);
  c.set("probe_strobe", 0);
  const auto out = c.outputs();
  compensation::ProbeFeedback feedback(
      std::vector<probe_process>{{5.0, 1800.0, 0.1, 0.0, 0}, {4.0, 3600.0, 0.1, 0.0, 0}, {4.0, 3600.0, 0.1, 0.0, 0}});
  const std::vector<double> predictions_um = {20.0, 30.0, 10.0};
  feedback.row(predictions_um, 0.0, 0.0);
  EXPECT_NEAR(out[499].at("correction_um"), 20.0, 1e-9);  // the mean of the three
  EXPECT_NEAR(out[499].at("probe_sigma_um"), feedback.deviation_um(), 1e-9);
  EXPECT_TRUE(feedback.probe_drift_um(30.0));
  EXPECT_EQ(out[504].at("probe_verdict"), 1.0);
  EXPECT_NEAR(out[504].at("probe_off_um"), 10.0, 1e-9);                            // by the blend, which led
  EXPECT_NEAR(out[504].at("correction_um"), 20.0 + feedback.estimate_um(), 0.01);  // 1 s later
  EXPECT_NEAR(out[504].at("probe_residual_um"), feedback.estimate_um(), 0.01);
  for (int k = 0; k < 600; ++k) feedback.row(predictions_um, 0.0, 1.0);
  EXPECT_NEAR(out[3499].at("correction_um"), 20.0 + feedback.estimate_um(), 0.02);
  EXPECT_GT(feedback.members()[1].weight, 0.7);
  EXPECT_LT(std::abs(out[3499].at("correction_um") - 30.0), 2.0);
  EXPECT_EQ(out[3504].at("probe_verdict"), 1.0);
  EXPECT_LT(std::abs(out[3504].at("probe_off_um")), 1.0);  // by the member that leads now
  EXPECT_EQ(out[3504].at("refused_probings"), 0.0);
  EXPECT_EQ(out[3504].at("setting_is_wrong"), 0.0);
}

// HAL takes 47 characters, of which "thermal." are eight.
TEST(LinuxcncComponent, HasPinsThatHalCanName) {
  DeployedModel d = two_um_per_K();
  d.model.terms.clear();
  d.safe.guards.clear();
  for (const char* name : {"the temperature of the outer ring of the front bearing",
                           "the temperature of the outer ring of the rear bearing", "enable", "T a", "T-a"})
    d.safe.guards.push_back(
        {.input = name, .unit = "degC", .low = 0, .high = 100, .most_jump = 1e9, .others_coefficient = {}});
  const Component c(exported("names", d));  // compiles
  std::set<std::string> names;
  for (const std::string& name : c.names()) {
    EXPECT_LE(name.size(), 39u) << name;
    EXPECT_TRUE(names.insert(name).second) << name;
  }
  EXPECT_EQ(c.names().size(), 29u);  // 10 of the inputs; of any component 4 in, 8 out and 7 parameters
  EXPECT_TRUE(names.contains("doubt_T_a_degC_2"));
}

TEST(LinuxcncComponent, NeverBearsTheNameOfTheModelsOwnFile) {
  EXPECT_THROW((void)linuxcnc_component(two_um_per_K(), "model", "model.c", "a test"), std::logic_error);
}

TEST(LinuxcncComponent, IsTakenByHalcompile) {
  if (std::system("command -v halcompile >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no halcompile here; Debian's linuxcnc-uspace-dev has it";
  const DeployedModel d = deployed_model(fixtures::deployed_blend());
  const std::filesystem::path folder = exported("halcompile", d);
  const std::string model = read_text(folder / "model.c");
  for (const char* what : {"--preprocess", "--compile", "--document"}) {
    EXPECT_EQ(std::system(fmt::format("cd {} && halcompile {} model_axis.comp >said 2>&1", folder.string(), what).c_str()),
              0)
        << what << ": " << read_text(folder / "said");
  }
  EXPECT_THAT(read_text(folder / "model_axis.c"), HasSubstr("axis_offset_step"));
  EXPECT_TRUE(std::filesystem::exists(folder / "model_axis.so"));
  EXPECT_EQ(read_text(folder / "model.c"), model);
}

}  // namespace
}  // namespace driftwright::output::linuxcnc_component_test
