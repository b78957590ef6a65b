// `driftwright predict` and `simulate` as a user runs them: the same model, named cyclograms and CSV files, warm starts,
// and the figures of ISO 230-3 in what they write.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/record.hpp"
#include "tests/shared/command_line.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::predict_verb_test {
namespace {

using fixtures::replaced;
using ::testing::AllOf, ::testing::ContainsRegex, ::testing::HasSubstr, ::testing::Not;
using Json = nlohmann::json;

/// One body of 60 kJ/K on 20 W/K: 15 K and 60 um at 2000 rpm with a time constant of 50 min. Linear.
constexpr const char* kHead = R"(name: head
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 60 kJ/K}
  - {type: motor_loss, node: head, power: 300 W, at_speed: 2000 rpm, exponent: 1}
  - {type: link, node: head, to: ambient, conductance: 20 W/K}
start: ambient
ambient: [[0 h, 20 degC], [9 h, 20 degC]]
sensors: [{name: t_head, node: head}]
displacements: [{name: nose_z, sensitivities: [{node: head, sensitivity: 4 um/K}]}]
cyclograms:
  morning: [[60 min, 2000 rpm], [20 min, 500 rpm]]
  afternoon: [[30 min, 1000 rpm], [45 min, 2000 rpm]]
  day: [[60 min, 2000 rpm], [20 min, 500 rpm], [30 min, 1000 rpm], [45 min, 2000 rpm]]
  day_with_pause: [[60 min, 2000 rpm], [20 min, 500 rpm], [25 min, 0 rpm], [30 min, 1000 rpm], [45 min, 2000 rpm]]
  short: [[45 min, 2000 rpm]]
)";

/// The same in exact exponentials: what two runs differ by is no error of an integrator.
std::string exact_head() {
  return std::string(kHead) + "solver: {model: reduced}\n";
}

double warming_um(double t_min) {
  return 60.0 * -std::expm1(-t_min / 50.0);
}

/// Runs a verb in a folder of its own. @returns the folder of results
std::filesystem::path run_verb(const std::string& name, const std::string& arguments) {
  const auto out = fresh_folder(name) / "out";
  const CommandOutcome outcome = run_program(arguments + " -o " + out.string());
  EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.output;
  return out;
}

Record record_in(const std::filesystem::path& folder) {
  return read_record_csv((folder / "record.csv").string());
}

/// Lines without '#' comments, which name the command.
std::string rows_of(const std::filesystem::path& file) {
  std::istringstream text(read_text(file));
  std::string rows;
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("#")) rows += line + "\n";
  }
  return rows;
}

/// The record of `part`, whose rows begin at `start_s` of `whole`, holds the same as the latter.
void expect_continues(const Record& whole, const Record& part, double start_s, double tolerance) {
  std::size_t n_compared = 0;
  for (std::size_t i = 0; i < whole.n_samples(); ++i) {
    for (std::size_t k = 0; k < part.n_samples(); ++k) {
      if (std::abs(whole.time_s[i] - start_s - part.time_s[k]) > 1e-6) continue;
      ++n_compared;
      for (const Channel& c : part.channels)
        EXPECT_NEAR(c.values[k], whole.at(c.name).values[i], tolerance) << c.name << " at " << part.time_s[k] << " s";
    }
  }
  EXPECT_EQ(n_compared, part.n_samples());
}

TEST(PredictVerb, RunsTheModelThatSimulateRuns) {
  for (const char* cyclogram : {"shift", "warm_up"}) {
    const std::string name = cyclogram;
    const auto predicted = run_verb("p_" + name, "predict scenarios/lumped_spindle.yaml --cyclogram " + name);
    const auto simulated = run_verb("s_" + name, "simulate scenarios/lumped_spindle.yaml --cyclogram " + name);
    EXPECT_EQ(rows_of(predicted / "record.csv"), rows_of(simulated / "record.csv"));
  }
}

TEST(PredictVerb, HasTheBandOfWhatIsKnownAndSoHaveTheOthers) {
  // The drift is proportional to the power, which alone is uncertain: its limits are those of the power.
  const std::string known =
      write_file("known.yaml", replaced(kHead, "exponent: 1}", "exponent: 1, known_to: {power: 10 %}}"));
  const auto predicted = run_verb("band_p", "predict " + known + " --cyclogram morning");
  const Record record = record_in(predicted), band = read_record_csv((predicted / "record_band.csv").string());
  ASSERT_EQ(band.time_s, record.time_s);
  for (const std::size_t row : {std::size_t{10}, record.n_samples() - 1}) {
    const double drift_um = record.at("nose_z").values[row];
    EXPECT_NEAR(band.at("nose_z_low").values[row] / drift_um, std::exp(-0.196), 1e-3);
    EXPECT_NEAR(band.at("nose_z_high").values[row] / drift_um, std::exp(0.196), 1e-3);
  }
  const Json summary = Json::parse(read_text(predicted / "summary.json"));
  EXPECT_THAT(summary["band"].get<std::string>(),
              AllOf(HasSubstr("1 number known to 10 %"), HasSubstr("nor what the model itself lacks")));
  EXPECT_NEAR(summary["channels"][0]["at_end_ci95"][1].get<double>(), band.at("nose_z_high").values.back(), 1e-3);
  EXPECT_THAT(read_text(predicted / "report.html"), HasSubstr("class=\"interval\""));

  const auto simulated = run_verb("band_s", "simulate " + known + " --cyclogram morning");
  EXPECT_EQ(rows_of(simulated / "record_band.csv"), rows_of(predicted / "record_band.csv"));
  const auto compared = run_verb("band_c", "compare " + simulated.string() + " " + predicted.string());
  EXPECT_EQ(Json::parse(read_text(compared / "summary.json"))["channels"][0]["within_band"], 1.0);
  const auto both = run_verb("band_both", "simulate " + known + " --cyclogram morning --cyclogram afternoon");
  EXPECT_EQ(rows_of(both / "bands/morning.csv"), rows_of(simulated / "record_band.csv"));

  const auto without = run_verb("band_none", "predict " + write_file("head.yaml", kHead) + " --cyclogram morning");
  EXPECT_FALSE(std::filesystem::exists(without / "record_band.csv"));
  EXPECT_FALSE(Json::parse(read_text(without / "summary.json")).contains("band"));
  EXPECT_EQ(rows_of(without / "record.csv"), rows_of(predicted / "record.csv")) << "the curve itself is the same";
}

TEST(PredictVerb, SaysWhatPredicted) {
  const std::string scenario = write_file("head.yaml", kHead);
  const auto out = fresh_folder("words") / "out";
  const CommandOutcome full = run_program("predict " + scenario + " --cyclogram morning -o " + out.string());
  EXPECT_THAT(full.output,
              AllOf(HasSubstr("predicted by the full model of 1 temperature unknowns"), Not(HasSubstr("modes"))));
  EXPECT_THAT(read_text(out / "record.csv"), HasSubstr("predicted by the full model"));
  const CommandOutcome reduced =
      run_program("predict " + scenario + " --cyclogram morning --model reduced -o " + out.string());
  EXPECT_THAT(reduced.output, HasSubstr("predicted by the reduced model of 1 states"));
  EXPECT_EQ(run_program("predict " + scenario + " --cyclogram morning --model modes -o " + out.string()).exit_code, 2);
}

TEST(SimulateVerb, RunsACyclogramFromACsvAsOneOfTheScenario) {
  const std::string scenario = write_file("head.yaml", kHead);
  const std::string csv = write_file("plan.csv", "time_min,speed_rpm\n0,2000\n60,500\n80,0\n");
  const auto named = run_verb("named", "simulate " + scenario + " --cyclogram morning");
  const auto from_file = run_verb("from_file", "simulate " + scenario + " --cyclogram " + csv);
  EXPECT_EQ(rows_of(named / "record.csv"), rows_of(from_file / "record.csv"));
  const auto both = run_verb("both", "simulate " + scenario + " --cyclogram morning --cyclogram " + csv);
  EXPECT_EQ(rows_of(both / "records/morning.csv"), rows_of(both / "records/plan.csv"));
  EXPECT_EQ(rows_of(both / "records/plan.csv"), rows_of(from_file / "record.csv"));
}

TEST(SimulateVerb, RefusesTwoCyclogramsOfOneName) {
  const std::string scenario = write_file("head.yaml", kHead);
  const std::string csv = write_file("morning.csv", "time_min,speed_rpm\n0,1000\n80,0\n");
  const CommandOutcome outcome = run_program("simulate " + scenario + " --cyclogram morning --cyclogram " + csv);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("both named 'morning'"), HasSubstr(csv)));
}

// Exact but for the record's seven digits: 1e-5 K of 30 degC, 1e-5 um.
TEST(WarmStart, BehindARecordIsTheRecordAndTheJobInOneCyclogram) {
  const std::string scenario = write_file("exact.yaml", exact_head());
  const auto morning = run_verb("morning", "simulate " + scenario + " --cyclogram morning");
  const Record day = record_in(run_verb("day", "simulate " + scenario + " --cyclogram day"));
  const Record warm = record_in(
      run_verb("warm", "predict " + scenario + " --cyclogram afternoon --start " + (morning / "record.csv").string()));
  expect_continues(day, warm, 80 * 60.0, 2e-4);
  EXPECT_GT(warm.at("nose_z").values.front(), 30.0) << "the machine is warm";
  const Record cold = record_in(run_verb("cold", "predict " + scenario + " --cyclogram afternoon"));
  EXPECT_NEAR(cold.at("nose_z").values.front(), 0.0, 1e-9);
}

// A cyclogram of the scenario is exact where a record's rows are not: speeds that change between two rows.
TEST(WarmStart, BehindACyclogramIsBothInOneCyclogram) {
  const std::string odd =
      write_file("odd.yaml", replaced(exact_head(), "  short:",
                                      "  odd: [[10.3 min, 2000 rpm], [0.4 min, 500 rpm], [11 min, 1500 rpm]]\n"
                                      "  odd_day: [[10.3 min, 2000 rpm], [0.4 min, 500 rpm], [11 min, 1500 rpm], "
                                      "[45 min, 2000 rpm]]\n  short:"));
  const Record day = record_in(run_verb("odd_day", "simulate " + odd + " --cyclogram odd_day"));
  const Record warm = record_in(run_verb("odd_warm", "predict " + odd + " --cyclogram short --start odd"));
  EXPECT_NEAR(warm.time_s.back() + 21.7 * 60.0, day.time_s.back(), 1e-6);
  EXPECT_NEAR(warm.at("nose_z").values.back(), day.at("nose_z").values.back(), 2e-4);
}

// A record in which the tool drifts by 30 um where the model says 41.9: both are shown, of channels that the machine has.
TEST(WarmStart, SetsTheRecordsChangeBesideTheModels) {
  const std::string scenario = write_file("exact.yaml", exact_head());
  const std::string start = write_file(
      "measured.csv", "time_s,speed_rpm,nose_z_um,other_um\n0,2000,100,0\n1800,2000,,1\n3600,2000,130,2\n5400,0,,\n");
  const auto out = fresh_folder("checks") / "out";
  const CommandOutcome outcome =
      run_program("predict " + scenario + " --cyclogram short --start " + start + " -o " + out.string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, ContainsRegex("nose_z +µm +\\+30.0 +\\+41.9\n"));
  const Json checks = Json::parse(read_text(out / "summary.json"))["start_checks"];
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_NEAR(checks[0]["modelled_change"], warming_um(60), 1e-3);
}

TEST(WarmStart, APauseIsTimeAtRest) {
  const std::string scenario = write_file("exact.yaml", exact_head());
  const auto morning = run_verb("morning_2", "simulate " + scenario + " --cyclogram morning");
  const Record day = record_in(run_verb("day_2", "simulate " + scenario + " --cyclogram day_with_pause"));
  const Record warm =
      record_in(run_verb("warm_2", "predict " + scenario + " --cyclogram afternoon --after-pause '25 min' --start " +
                                       (morning / "record.csv").string()));
  expect_continues(day, warm, 105 * 60.0, 2e-4);
}

// Friction that follows the oil, a chiller that switches and an ambient that warms by 1.5 K: the shipped motor spindle,
// within what the integrator's tolerance (1e-3 K, 2.9 um/K; switches may come a step apart).
TEST(WarmStart, OfAMachineThatSwitchesAgreesToTheIntegratorsTolerance) {
  const std::string scenario = write_file(
      "spindle.yaml", replaced(read_text("scenarios/lumped_spindle.yaml"), "  warm_up:",
                               "  first: [[60 min, 12000 rpm]]\n  second: [[40 min, 6000 rpm]]\n  both: [[60 min, 12000 "
                               "rpm], [40 min, 6000 rpm]]\n  warm_up:"));
  const auto first = run_verb("first", "simulate " + scenario + " --cyclogram first");
  const Record both = record_in(run_verb("both_2", "simulate " + scenario + " --cyclogram both"));
  const Record second = record_in(
      run_verb("second", "predict " + scenario + " --cyclogram second --start " + (first / "record.csv").string()));
  expect_continues(both, second, 3600.0, 0.05);
}

// The same morning in an ambient that is 5 K warmer: a linear machine that starts as warm as its ambient is 20 um further
// all along.
TEST(WarmStart, FollowsTheAmbientOfTheRecord) {
  const std::string scenario = write_file("exact.yaml", exact_head());
  const auto morning = run_verb("ambient_cold", "simulate " + scenario + " --cyclogram morning");
  const std::string warmer = write_file(
      "warmer.yaml", replaced(exact_head(), "[[0 h, 20 degC], [9 h, 20 degC]]", "[[0 h, 25 degC], [9 h, 25 degC]]"));
  const auto warm_morning = run_verb("ambient_warm", "simulate " + warmer + " --cyclogram morning");
  const auto after = [&](const std::string& name, const std::filesystem::path& record) {
    return record_in(
        run_verb(name, "predict " + scenario + " --cyclogram afternoon --start " + (record / "record.csv").string()));
  };
  const Record usual = after("after_cold", morning), other = after("after_warm", warm_morning);
  for (std::size_t i = 0; i < usual.n_samples(); ++i) {
    EXPECT_NEAR(other.at("ambient").values[i], 25.0, 1e-4);
    EXPECT_NEAR(other.at("nose_z").values[i] - usual.at("nose_z").values[i], 20.0, 1e-3);
  }
}

TEST(WarmStart, RefusesARecordThatIsNoRunAndTimesThatAreNone) {
  const std::string scenario = write_file("head.yaml", kHead);
  const std::string predict = "predict " + scenario + " --cyclogram afternoon ";
  const std::string no_speed = write_file("no_speed.csv", "time_s,t_head_degC\n0,20\n60,21\n");
  const std::string fine = write_file("fine.csv", "time_min,speed_rpm\n0,2000\n60,0\n");
  const auto refusal = [&](const std::string& arguments) {
    const CommandOutcome outcome = run_program(predict + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.output;
    return outcome.output;
  };
  EXPECT_THAT(refusal("--start " + no_speed), AllOf(HasSubstr("no_speed.csv"), HasSubstr("speed_rpm")));
  EXPECT_THAT(refusal("--start nowhere.csv"), HasSubstr("nowhere.csv"));
  EXPECT_THAT(refusal("--after-pause '5 min'"), HasSubstr("--start"));
  EXPECT_THAT(refusal("--start " + fine + " --after-pause '5 mm'"), AllOf(HasSubstr("--after-pause"), HasSubstr("5 mm")));
  EXPECT_THAT(refusal("--start " + fine + " --after-pause '-5 min'"), HasSubstr("a time from 0 s"));
}

TEST(WarmStart, RefusesToLeaveOutAnEffectOfTheRecordsRun) {
  const std::string scenario = write_file(
      "in.yaml",
      replaced(kHead, "start: ambient", "  - {type: heat_source, node: head, power: 50 W, in: morning}\nstart: ambient"));
  const std::string start = write_file("morning.csv", "time_min,speed_rpm\n0,2000\n60,0\n");
  const CommandOutcome outcome = run_program("predict " + scenario + " --cyclogram afternoon --start " + start);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("in.yaml:"), HasSubstr("holds in 'morning' alone")));
}

TEST(Iso230Figures, StandInSummaryReportAndTerminal) {
  const std::string scenario = write_file("head.yaml", kHead);
  const std::string csv = write_file("test.csv", "time_min,speed_rpm\n0,2000\n240,0\n300,0\n");
  for (const char* verb : {"predict", "simulate"}) {
    const auto out = fresh_folder(std::string("iso_") + verb) / "out";
    const CommandOutcome outcome =
        run_program(std::string(verb) + " " + scenario + " --cyclogram " + csv + " -o " + out.string());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output,
                AllOf(HasSubstr("ISO 230-3, thermal distortion"), HasSubstr("spindle running period t  240 min")));
    EXPECT_THAT(read_text(out / "report.html"), HasSubstr("d(X),60: first 60 min"));
    const Json summary = Json::parse(read_text(out / "summary.json"));
    const Json iso = std::string(verb) == "predict" ? summary["iso_230_3"] : summary["cyclograms"][0]["iso_230_3"];
    EXPECT_NEAR(iso["spindle_running_period_min"], 240.0, 1e-9);
    const Json nose = iso["channels"][0];
    EXPECT_EQ(nose["name"], "nose_z");
    EXPECT_EQ(nose["unit"], "um");
    EXPECT_NEAR(nose["range_first_60_min"], warming_um(60), 0.01);  // the integrator's 1e-4 of it
    EXPECT_NEAR(nose["range_running_period"], warming_um(240), 0.01);
    EXPECT_NEAR(nose["at_end_of_running_period"], warming_um(240), 0.01);
  }
  const auto out = fresh_folder("iso_short") / "out";
  const CommandOutcome outcome = run_program("predict " + scenario + " --cyclogram short -o " + out.string());
  EXPECT_THAT(outcome.output, HasSubstr("not available:  the spindle runs for 45 min"));
  EXPECT_THAT(Json::parse(read_text(out / "summary.json"))["iso_230_3"]["not_available"].get<std::string>(),
              HasSubstr("45 min"));
}

}  // namespace
}  // namespace driftwright::predict_verb_test
