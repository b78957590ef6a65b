// The main job on the shipped scenario, judged by what it must show.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/record.hpp"
#include "tests/shared/command_line.hpp"

namespace driftwright::fp3_spindle_test {
namespace {

using ::testing::HasSubstr;

class Fp3Spindle : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path store = fresh_folder("fp3_store");
    setenv("XDG_CACHE_HOME", store.c_str(), 1);  // the first run must reduce the machine
    folder_ = fresh_folder("fp3") / "out";
    outcome_ = run_program("run scenarios/fp3_spindle.yaml -o " + folder_.string());
    ASSERT_EQ(outcome_.exit_code, 0) << outcome_.output;
    summary_ = nlohmann::json::parse(read_text(folder_ / "summary.json"));
    give_to_other_tests(store);
  }
  /// Puts the machine that the first run has reduced into the store that tests share, whole or not at all.
  static void give_to_other_tests(const std::filesystem::path& store) {
    for (const auto& machine : std::filesystem::directory_iterator(store / "driftwright")) {
      const std::filesystem::path to = test_store() / std::filesystem::relative(machine.path(), store);
      const std::filesystem::path part = to.string() + ".of_fp3_spindle";
      if (std::filesystem::exists(to)) continue;
      std::filesystem::create_directories(to.parent_path());
      std::filesystem::copy(machine.path(), part, std::filesystem::copy_options::recursive);
      std::error_code failed;
      std::filesystem::rename(part, to, failed);
      if (failed) std::filesystem::remove_all(part);  // another program was faster
    }
  }
  static inline std::filesystem::path folder_;
  static inline CommandOutcome outcome_;
  static inline nlohmann::json summary_;
};

TEST_F(Fp3Spindle, EnergyBalanceCloses) {
  EXPECT_LT(summary_["energy_balance_gap"].get<double>(),
            1e-6);  // the bound of the issue; rounding gives 1e-15
}

TEST_F(Fp3Spindle, StaysUnderFourGiB) {
  rusage children{};
  ASSERT_EQ(getrusage(RUSAGE_CHILDREN, &children), 0);  // of the hungriest child that has ended
  EXPECT_LT(children.ru_maxrss, 4L * 1024 * 1024) << "KiB";
  EXPECT_GT(children.ru_maxrss, 100L * 1024) << "KiB; this does not measure the run";
}

TEST_F(Fp3Spindle, ReachesTheMagnitudesOfThePaper) {
  // "Displacements up to about 50 um, sensor temperatures 20-25 degC"; 240 min at 2000 rpm is the hardest training run.
  const Record hot = read_record_csv((folder_ / "records/heat_cool_2000.csv").string());
  const auto peak = [&](const char* name) {
    return *std::max_element(hot.at(name).values.begin(), hot.at(name).values.end());
  };
  EXPECT_NEAR(peak("drift_y"), 45.0, 10.0);
  for (const char* sensor : {"t01", "t02", "t03", "t04", "t07", "t08", "t09", "t12"}) {
    EXPECT_GT(peak(sensor), 23.0) << sensor;
    EXPECT_LT(peak(sensor), 29.0) << sensor;
  }
  // A machine symmetric about x = 0 neither moves nor tilts sideways; drift_x is the quill's own radius, 62.5 mm on one
  // side.
  const double radius_growth_um = 11.5e-6 * 62.5e3 * (peak("t06") - 20.0);
  // The reading is 9 % above that: under the thermometer the quill is warmer inside. 15 % leaves room for nothing else.
  EXPECT_NEAR(peak("drift_x"), radius_growth_um, 0.15 * radius_growth_um);
}

TEST_F(Fp3Spindle, DriftIsNoFunctionOfTemperature) {
  // The paper found more than 50 % of the smaller value; the issue asks for 30 % at some sensor. We ask it of every sensor
  // on the headstock, where the paper measured.
  for (const auto& entry : summary_["drift_at_one_temperature"]) {
    if (entry["sensor"] == "t05" || entry["sensor"] == "t10" || entry["sensor"] == "t11") continue;  // motor and column
    EXPECT_GE(entry["spread"].get<double>(), 0.3) << entry["sensor"];
  }
  EXPECT_GE(summary_["drift_at_one_temperature"].size(), 12U);
}

// One that fails is shown by CncMill13.
TEST_F(Fp3Spindle, SomeStrategyStaysInsideTenMicrometres) {
  double least_um = 1e9, most_um = 0.0;
  for (const auto& c : summary_["corrections"]) {
    if (c["channel"] != "drift_y") continue;
    const double peak_um = c["after"]["peak_um"];
    EXPECT_EQ(c["inside_tolerance"].get<bool>(), peak_um <= 10.0);
    EXPECT_GT(c["before"]["peak_um"].get<double>(), 20.0);
    least_um = std::min(least_um, peak_um);
    most_um = std::max(most_um, peak_um);
  }
  EXPECT_LT(least_um, 2.0);  // modes through the injector
  EXPECT_GT(most_um, 9.0);   // one thermometer by a schedule, which uses the whole tolerance
  EXPECT_THAT(outcome_.output, HasSubstr("Inside 10 µm by at least one strategy"));
}

TEST_F(Fp3Spindle, ScoresAreThoseOfTheWrittenRecord) {
  const Record record = read_record_csv((folder_ / "record.csv").string());
  EXPECT_EQ(record.n_samples(), 301U);
  double peak_um = 0.0;
  for (double d : record.at("drift_y").values) peak_um = std::max(peak_um, std::abs(d));
  for (const auto& c : summary_["corrections"]) {
    if (c["channel"] != "drift_y") continue;
    EXPECT_NEAR(c["before"]["peak_um"].get<double>(), peak_um, 1e-4);  // 6 digits each
  }
}

TEST_F(Fp3Spindle, EdgeByEdgeTheInjectorLeavesLittleMoreThanTheModelsError) {
  const auto& loop = summary_["axis_loop"];
  std::vector<std::string> causes;
  std::vector<double> rms_um;
  for (const auto& stage : loop["switched_on_in_turn"]) {
    causes.push_back(stage["cause"]);
    rms_um.push_back(stage["rms_um"]);
  }
  EXPECT_THAT(causes,
              ::testing::ElementsAre("none", "model", "thermometers", "sampling", "resolution", "rate limit", "axis"));
  EXPECT_GT(rms_um.front(), 20.0);
  // Half an insertion of 1 um, evenly spread, is 0.29 um RMS, the axis rests within one count of 1 um, which is 0.29 um
  // RMS again, and the readings' noise is 0.3 um: added to the model's error in squares.
  EXPECT_LT(rms_um.back(), std::hypot(rms_um[1], 0.29, 0.29) + 0.3);
  const auto& counts = loop["counts"];
  EXPECT_EQ(counts["encoder_quarters"].get<int>() + counts["inserted_quarters"].get<int>(),
            counts["control_quarters"].get<int>() + counts["waiting_quarters"].get<int>());
  EXPECT_EQ(counts["illegal_transitions"], 0);
  EXPECT_EQ(counts["inserted_quarters"].get<int>() % 4, 0);  // whole cycles
  EXPECT_THAT(read_text(folder_ / "report.html"), HasSubstr("through the pulse injector, edge by edge"));
}

// Samples taken during a pass carry the axis's lag, not the machine's drift: without feed-forward 10 mm/s / 40 1/s = 250
// um. A pass sets out half a second before a sample and takes 0.6 s.
TEST_F(Fp3Spindle, CompensateThroughTheInjectorJudgesRowsAtRest) {
  std::string text = read_text("scenarios/fp3_spindle.yaml");
  const std::string motion = "motion: {stroke: 1 mm, feed: 600 mm/min, every: 20 s}",
                    channel = "axis_loop:\n  displacement: drift_y";
  const auto changed = [&](std::string of, const std::string& from, const std::string& to) {
    return of.replace(of.find(from), from.size(), to);
  };
  const std::string busy =
      write_file("busy.yaml",
                 changed(text, motion, "servo: {feed_forward: 0}\n  motion: {stroke: 6 mm, feed: 600 mm/min, every: 19 s}"));
  const auto folder = fresh_folder("through") / "out";
  const CommandOutcome done = run_program("compensate " + busy + " --model modes --through injector -o " + folder.string());
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const auto summary = nlohmann::json::parse(read_text(folder / "summary.json"));
  std::istringstream rows(read_text(folder / "corrected.csv"));
  double at_rest_um = 0.0, passing_um = 0.0;
  for (std::string line; std::getline(rows, line);) {
    double time_s, drift_um, predicted_um, left_um;
    int at_rest;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%d", &time_s, &drift_um, &predicted_um, &left_um, &at_rest) != 5)
      continue;
    double& worst_um = at_rest ? at_rest_um : passing_um;
    worst_um = std::max(worst_um, std::abs(left_um));
  }
  EXPECT_NEAR(summary["peak_left_um"].get<double>(), at_rest_um, 1e-4);  // 7 and 6 digits
  EXPECT_NEAR(passing_um, 250.0, 20.0);                                  // were they judged, they would rule
  EXPECT_LT(at_rest_um, 20.0);

  const std::string other = write_file("other.yaml", changed(text, channel, "axis_loop:\n  displacement: drift_z"));
  const CommandOutcome refused =
      run_program("compensate " + other + " --model modes --through injector -o " + folder.string());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.output, HasSubstr("the axis corrects 'drift_z', but the predictor gives 'drift_y'"));
}

TEST_F(Fp3Spindle, FewModesMissTheBearingAndSteadyResponsesMendIt) {
  const auto& errors = summary_["modal"]["errors_against_full_model"];
  EXPECT_GT(errors[0]["worst_temperature_K"].get<double>(), 1.0);  // what the issue warns of
  EXPECT_LT(errors[1]["worst_temperature_K"].get<double>(), 0.2 * errors[0]["worst_temperature_K"].get<double>());
  const auto& tau = summary_["modal"]["time_constants_min"];
  EXPECT_TRUE(std::is_sorted(tau.begin(), tau.end(), std::greater<>()));
}

TEST_F(Fp3Spindle, WritesFieldsReportAndSchedule) {
  EXPECT_THAT(read_text(folder_ / "fields.pvd"), HasSubstr("fields/fields_0010.vtu"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "fields/fields_0010.vtu"));
  EXPECT_THAT(read_text(folder_ / "schedule.txt"), HasSubstr("1-{40}-{0}"));
  EXPECT_THAT(read_text(folder_ / "report.html"), HasSubstr("Drift is not a function of temperature"));
}

TEST_F(Fp3Spindle, TheSameScenarioGivesTheSameBytes) {
  const auto again = fresh_folder("fp3_again") / "out";
  const CommandOutcome second = run_program("run scenarios/fp3_spindle.yaml -o " + again.string());
  ASSERT_EQ(second.exit_code, 0) << second.output;
  EXPECT_THAT(outcome_.output, ::testing::Not(HasSubstr("known from disk")));
  EXPECT_THAT(second.output, HasSubstr("known from disk"));  // the first had to make the model
  int n_files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    if (!entry.is_regular_file()) continue;
    ++n_files;
    EXPECT_EQ(read_text(entry.path()), read_text(again / std::filesystem::relative(entry.path(), folder_))) << entry.path();
  }
  EXPECT_GT(n_files, 15);
}

TEST(Fp3Verbs, MeshSimulateAndPredictWork) {
  const auto folder = fresh_folder("fp3_verbs");
  EXPECT_EQ(run_program("mesh scenarios/fp3_spindle.yaml -o " + (folder / "mesh").string()).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "mesh/mesh.vtu"));

  // The same model on a cyclogram of the scenario and on one given as a CSV: 20 min at 2000 rpm, then 10 at rest.
  std::ofstream(folder / "plan.csv") << "time_min,speed_rpm\n0,2000\n20,0\n30,0\n";
  auto scenario = read_text("scenarios/fp3_spindle.yaml");
  const std::string marker = "  warm_up_2000:";
  scenario.insert(scenario.find(marker), "  plan: [[20 min, 2000 rpm], [10 min, 0 rpm]]\n");
  std::ofstream(folder / "plan.yaml") << scenario;
  const std::string yaml = (folder / "plan.yaml").string();
  ASSERT_EQ(run_program("simulate " + yaml + " --cyclogram plan -o " + (folder / "simulated").string()).exit_code, 0);
  ASSERT_EQ(run_program("predict " + yaml + " --cyclogram " + (folder / "plan.csv").string() + " -o " +
                        (folder / "predicted").string())
                .exit_code,
            0);
  const Record simulated = read_record_csv((folder / "simulated/record.csv").string()),
               predicted = read_record_csv((folder / "predicted/record.csv").string());
  ASSERT_EQ(simulated.time_s, predicted.time_s);
  for (const Channel& c : simulated.channels) {
    for (std::size_t i = 0; i < simulated.n_samples(); ++i)  // seven digits are written
      EXPECT_NEAR(predicted.at(c.name).values[i], c.values[i], 1e-5) << c.name << " at " << simulated.time_s[i] << " s";
  }
}

}  // namespace
}  // namespace driftwright::fp3_spindle_test
