// `validate` on records as a user has them: with and without a machine in the scenario, with an ambient, without one. One
// file: its cases share what `validate` writes, which takes most of their time.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/record.hpp"
#include "tests/app/records_of_two_bodies.hpp"

namespace driftwright::validate_records_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class ValidateRecords : public RecordsOfTwoBodies {};

// Corrections of tens of um are held to 4 um, and to half a micrometre from one reading to the next: as judged, as written
// and on a control.
TEST_F(ValidateRecords, TheLimitsOfTheScenarioAreInEachFile) {
  const std::string limited =
      write_file("limited.yaml", std::string("name: limited\n") + kStudy + "limits: {correction: 4 um, step: 0.5 um}\n");
  int n_files = 0, n_components = 0;
  for (const auto& file : std::filesystem::directory_iterator(validated(limited).folder / "models")) {
    if (file.path().extension() == ".comp") {
      ++n_components;
      EXPECT_THAT(read_text(file.path()), HasSubstr("param rw float most_um = 4"));
    }
    if (file.path().extension() != ".json") continue;
    const Json predictor = Json::parse(read_text(file.path()));
    if (!predictor.contains("fail_safe") || predictor["fail_safe"].is_null()) continue;
    ++n_files;
    const Json& safe = predictor["fail_safe"];
    EXPECT_LE(safe["highest_um"].get<double>(), 4.0) << predictor["name"];
    EXPECT_GE(safe["lowest_um"].get<double>(), -4.0) << predictor["name"];
    EXPECT_LE(safe["most_rate_um_s"].get<double>() * safe["period_s"].get<double>(), 0.5 + 1e-12) << predictor["name"];
  }
  EXPECT_GT(n_files, 2);
  EXPECT_GT(n_components, 0);
}

TEST_F(ValidateRecords, PhysicsIsJudgedOnRecordsOfAMachine) {
  expect_exact(validate(machine_, "to_and_fro"));
}

// What is judged is what is deployed: each predictor's file corrects the judged record as `validate` said, to its last
// digit.
TEST_F(ValidateRecords, AFileCorrectsAsItWasJudged) {
  const auto out = fresh_folder("judged") / "out", corrected = fresh_folder("corrected") / "out";
  for (const std::string& scenario : {machine_, records_only_}) {
    const CommandOutcome judged =
        run_program("validate " + scenario + " --train " + record("warm_up") + " --train " + record("steps") + " --test " +
                    record("to_and_fro") + " --probe '30 min' --probe-noise '0.5 um' -o " + out.string());
    ASSERT_EQ(judged.exit_code, 0) << judged.output;
    const Json summary = Json::parse(read_text(out / "summary.json"));
    std::map<std::string, Json> probed;  // rows of the table
    for (const Json& row : summary["validation"]["probing"]) probed[row["name"].get<std::string>()] = row;
    int n = 0, n_probed = 0;
    for (const auto& file : std::filesystem::directory_iterator(out / "models")) {
      if (file.path().extension() != ".json") continue;
      ++n;
      const Json predictor = Json::parse(read_text(file.path()));
      const CommandOutcome run = run_program(
          "compensate " + scenario + " --model " + file.path().string() + " --through none --measured " +
          record("to_and_fro") + (predictor["probing"].is_null() ? "" : " --probe '30 min'") + " -o " + corrected.string());
      ASSERT_EQ(run.exit_code, 0) << run.output;
      const Json left = Json::parse(read_text(corrected / "summary.json"));
      if (!predictor["probing"].is_null()) {  // with the noise of the file, as it was judged
        ++n_probed;
        const Json& row = probed.at(predictor["name"].get<std::string>());
        EXPECT_NEAR(left["rms_probed_um"].get<double>(), row["probed_rms_um"].get<double>(), 1e-9) << predictor["name"];
        EXPECT_EQ(left["peak_probed_um"], row["probed_worst_peak_um"]) << predictor["name"];
        EXPECT_EQ(left["n_probings"], 6) << predictor["name"];  // of 200 min
        EXPECT_THAT(read_text(corrected / "corrected.csv"), HasSubstr("left_um,left_probed_um\n"));
      }
      const Json* s = strategy(summary, predictor["name"]);
      ASSERT_TRUE(s) << predictor["name"];
      EXPECT_EQ(left["peak_left_um"], (*s)["worst_peak_um"]) << predictor["name"];
      EXPECT_EQ(left["rms_left_um"], (*s)["overall_rms_um"]) << predictor["name"];
      EXPECT_EQ(predictor["baseline"], (*s)["baseline"]) << predictor["name"];
      if ((*s)["baseline"] == true) continue;  // it has no verdict
      EXPECT_EQ(predictor["judged"]["verdict"], (*s)["verdict"]) << predictor["name"];
      EXPECT_EQ(left["judged"], (*s)["verdict"]) << predictor["name"];
    }
    EXPECT_EQ(n, static_cast<int>(summary["validation"]["strategies"].size()));
    EXPECT_GT(n_probed, 5);
  }
}

// Laws of temperature are linearised about the training records; the rows say so, and the file is what was judged.
TEST_F(ValidateRecords, LawsOfTemperatureAreLinearisedAndTheRowSaysSo) {
  const Json summary = validate(oiled_, "to_and_fro", "oiled_");
  const Json& v = summary["validation"];
  const Json* nothing = strategy(summary, "no correction");
  ASSERT_TRUE(nothing);
  for (const Json& l : v["left_out"])  // of three thermometers no three modes
    EXPECT_THAT(l["name"].get<std::string>(), HasSubstr("common modes"));
  for (const char* name : {"thermal modes of the model", "model fitted to the training runs", "observer"}) {
    const Json* s = strategy(summary, name);
    ASSERT_TRUE(s) << name << v["left_out"];
    EXPECT_THAT((*s)["model"].get<std::string>(), HasSubstr("linearised at")) << name;
    EXPECT_THAT((*s)["decided"].get<std::string>(), HasSubstr("from the nonlinear one")) << name;
    EXPECT_LT((*s)["worst_peak_um"].get<double>(), 0.05 * (*nothing)["worst_peak_um"].get<double>()) << name;
  }
  EXPECT_EQ((*strategy(summary, "ridge, all sensors"))["model"], "");
  EXPECT_GT(v["linearised_error_um"].get<double>(), 0.01);
  EXPECT_LT(v["linearised_error_um"].get<double>(), 1.0);  // of 66 um; with the power at its mean alone 3.6 um
  ASSERT_EQ(v["linearised_laws"].size(), 1U);
  EXPECT_GT(v["linearised_laws"][0]["at_degC"].get<double>(), 22.0);
}

TEST_F(ValidateRecords, AFileOfALinearisedObserverCorrectsAsItWasJudged) {
  const auto corrected = fresh_folder("corrected") / "out";
  const Validated& judged = validated(oiled_, "to_and_fro", "oiled_");
  EXPECT_THAT(judged.said, HasSubstr("Strategies with physics use a model that is linearised at"));
  const CommandOutcome run =
      run_program("compensate " + oiled_ + " --model " + (judged.folder / "models/observer.json").string() +
                  " --through none --measured " + record("oiled_to_and_fro") + " -o " + corrected.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const Json left = Json::parse(read_text(corrected / "summary.json"));
  const Json* s = strategy(judged.summary, "observer");
  ASSERT_TRUE(s);
  EXPECT_EQ(left["peak_left_um"], (*s)["worst_peak_um"]);
  EXPECT_EQ(left["rms_left_um"], (*s)["overall_rms_um"]);
}

// The shipped spindle under `model: full`: with its chiller, which switches, no linear model follows it; without it the oil
// that thins and the preload that grows are linearised.
TEST_F(ValidateRecords, TheShippedSpindleTakesPartWithoutItsChiller) {
  const auto of_itself = [](const std::string& scenario) {
    const auto out = fresh_folder("shipped") / "out";
    const CommandOutcome run = run_program("validate " + scenario + " -o " + out.string());
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return run.exit_code == 0 ? Json::parse(read_text(out / "summary.json")) : Json{};
  };
  expect_left_out(of_itself("scenarios/lumped_spindle.yaml"), "thermostat 'cooler' of the scenario's machine switches");
  std::string text = read_text("scenarios/lumped_spindle.yaml");
  const std::size_t from = text.find("  # --- cooling jacket");
  ASSERT_NE(from, std::string::npos);
  text.erase(from, text.find("ambient: [[0 h") - from);
  replace(text, "  - {name: t_cooler, node: cooler}\n", "");
  replace(text, "to: ambient, conductance: 4 W/K}", "to: ambient, conductance: 80 W/K}");
  const Json summary = of_itself(write_file("uncooled.yaml", text));
  const Json& v = summary["validation"];
  const Json* nothing = strategy(summary, "no correction");
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(v["left_out"].empty()) << v["left_out"];
  for (const char* name : {"thermal modes of the model", "model fitted to the training runs", "observer"}) {
    const Json* s = strategy(summary, name);
    ASSERT_TRUE(s) << name << v["left_out"];
    EXPECT_THAT((*s)["model"].get<std::string>(), HasSubstr("linearised at")) << name;
    EXPECT_LT((*s)["overall_rms_um"].get<double>(), 0.5 * (*nothing)["overall_rms_um"].get<double>()) << name;
  }
  EXPECT_LT((*strategy(summary, "observer"))["worst_peak_um"].get<double>(),
            0.25 * (*nothing)["worst_peak_um"].get<double>());
  EXPECT_GT(v["linearised_error_um"].get<double>(), 0.0);
  EXPECT_LT(v["linearised_error_um"].get<double>(), 3.0);  // of 60 um; 0.4 um in a model of this machine in Python
  EXPECT_EQ(v["linearised_laws"].size(), 2U);
  EXPECT_TRUE(strategy(summary, v["chosen"].get<std::string>()));
}

// Where `validate` would have left a model out, its file corrects nothing.
TEST_F(ValidateRecords, AModelFollowsNoRecordThatItCannot) {
  const std::string model = (validated(machine_).folder / "models/observer.json").string(),
                    out = (fresh_folder("judged") / "corrected").string();
  const auto refused = [&](const std::string& scenario, const std::string& measured) {
    const CommandOutcome run = run_program("compensate " + scenario + " --model " + model + " --through none --measured " +
                                           measured + " -o " + out);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    return run.output;
  };
  const std::filesystem::path trained = record("warm_up");
  for (const std::string& spelling :
       {trained.string(), (trained.parent_path() / "." / trained.filename()).string(),
        std::filesystem::relative(trained).string(), "./" + std::filesystem::relative(trained).string(),
        trained.string() + ":0h..", trained.string() + ":..1h", trained.string() + ":2h..3h"})
    EXPECT_THAT(refused(machine_, spelling), HasSubstr("it was fitted on")) << spelling;
  EXPECT_THAT(refused(records_only_, record("to_and_fro")), HasSubstr("is a model of a machine"));
  edited("to_and_fro", "warm_start", [](std::vector<std::string>& cells, const std::vector<std::string>& header) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (header[i] == "t_spindle_degC" && cells[0] != header[0]) cells[i] = std::to_string(std::stod(cells[i]) + 8.0);
    }
    return true;
  });
  EXPECT_THAT(refused(machine_, record("warm_start")), HasSubstr("starts as warm as the ambient"));
}

// The recorded ambient drives the model, not the scenario's; and a record's clock may start anywhere.
TEST_F(ValidateRecords, InAnotherAmbientAndFromAnotherTimeOn) {
  simulate(
      scenario("warm_ambient",
               [](std::string& t) { replace(t, "[[0 h, 20 degC], [5 h, 22 degC]]", "[[0 h, 27 degC], [2 h, 25 degC]]"); }),
      "to_and_fro", "in_summer");
  edited("in_summer", "later", [](std::vector<std::string>& cells, const std::vector<std::string>&) {
    cells[0] = std::to_string(std::stod(cells[0]) + 5000.0);
    return true;
  });
  expect_exact(validate(machine_, "later"));
}

// What the scenario's effects say of drive, ambient and single runs holds for records of that name, too.
TEST_F(ValidateRecords, EffectsOnDriveAmbientAndSingleRunsAct) {
  const std::string doubted = scenario("doubted", [](std::string& t) {
    replace(t, "ambient: [[",
            "  - {type: heat_source, node: column, power: 20 W, in: doubtful}\n  - {type: speed_override, factor: 1.2, in: "
            "doubtful}\n"
            "  - {type: ambient, offset: 1 K, in: doubtful}\nambient: [[");
    replace(t, "  to_and_fro:", "  doubtful: [[60 min, 2500 rpm], [60 min, 1000 rpm]]\n  to_and_fro:");
  });
  simulate(doubted, "doubtful", "simulated");
  std::filesystem::create_directories(folder_ / "d");
  std::filesystem::copy_file(record("simulated"), folder_ / "d" / "doubtful.csv");
  const auto out = fresh_folder("validated") / "out";
  const CommandOutcome run =
      run_program("validate " + doubted + " --train " + record("warm_up") + " --train " + record("steps") + " --test " +
                  (folder_ / "d" / "doubtful.csv").string() + " -o " + out.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  expect_exact(Json::parse(read_text(out / "summary.json")));
}

TEST_F(ValidateRecords, WhatAModelCannotKnowLeavesItOutWithTheReason) {
  expect_left_out(validate(records_only_, "to_and_fro"), "the scenario has no machine");
  const auto with = [](const std::string& name, const std::string& what, const std::string& by) {
    return scenario(name, [&](std::string& t) { replace(t, what, by); });
  };
  expect_left_out(validate(with("reference", "start: ambient\n", ""), "to_and_fro"), "start: ambient");
  expect_left_out(
      validate(with("biased", "ambient: [[", "  - {type: sensor_bias, sensor: t_column, bias: 2 K}\nambient: [["),
               "to_and_fro"),
      "what instruments read");
  expect_left_out(validate(with("renamed", "name: t_column", "name: t_back"), "to_and_fro"), "no sensor 't_column'");
  expect_left_out(
      validate(
          with("thermostat", "ambient: [[",
               "  - {type: fixed_temperature, node: column, temperature: [[0 h, 20 degC], [5 h, 25 degC]]}\nambient: [["),
          "to_and_fro"),
      "");
  expect_left_out(
      validate(
          with("chiller", "ambient: [[",
               "  - {type: coolant, node: column, tank: cooler, flow: 4 L/min, passage_conductance: 60 W/K, volume: 2 L, "
               "tank_exchange: 3 W/K, pump_power: 40 W, cooling_power: 900 W, set_point: 25 degC, hysteresis: 2 K, "
               "runs: always}\nambient: [["),
          "to_and_fro"),
      "thermostat 'cooler' of the scenario's machine switches");
  int row = 0;
  edited("to_and_fro", "warm", [&](std::vector<std::string>&, const std::vector<std::string>&) { return ++row > 50; });
  expect_left_out(validate(machine_, "warm"), "begins with t_spindle at");
  edited("to_and_fro", "reversed", [](std::vector<std::string>& cells, const std::vector<std::string>& header) {
    cells[static_cast<std::size_t>(std::find(header.begin(), header.end(), "speed_rpm") - header.begin())] = "-10";
    return true;
  });
  expect_left_out(validate(machine_, "reversed"), "does not say what drove the machine");
}

TEST_F(ValidateRecords, AnAmbientThermometerThatNeverReadIsSaid) {
  edited("to_and_fro", "no_ambient", [](std::vector<std::string>& cells, const std::vector<std::string>& header) {
    cells[static_cast<std::size_t>(std::find(header.begin(), header.end(), "ambient_degC") - header.begin())].clear();
    return true;
  });
  for (const std::string& scenario : {records_only_, machine_}) {
    const Json summary = validate(scenario, "no_ambient");
    EXPECT_THAT(summary["warnings"].dump(), AllOf(HasSubstr("no ambient temperature"), HasSubstr("used from none")));
    EXPECT_TRUE(strategy(summary, "transfer functions from speed"));
  }
}

// The same training, judged by a run and by one whose drift goes the other way, three times as far: what is left differs,
// what is chosen does not.
TEST_F(ValidateRecords, ChoosesWithoutALookAtWhatItIsJudgedBy) {
  const std::string other =
      edited("to_and_fro", "reversed", [](std::vector<std::string>& cells, const std::vector<std::string>& header) {
        for (std::size_t c = 0; c < header.size(); ++c) {
          if (header[c].starts_with("tip_z")) cells[c] = fmt::format("{}", -3.0 * std::stod(cells[c]));
        }
        return true;
      });
  std::vector<Json> judged;
  for (const std::string& test : {std::string("to_and_fro"), other})
    judged.push_back(validate(records_only_, test)["validation"]);
  EXPECT_FALSE(judged[0]["chosen"].get<std::string>().empty());
  EXPECT_EQ(judged[0]["chosen"], judged[1]["chosen"]);
  EXPECT_EQ(judged[0]["why_chosen"], judged[1]["why_chosen"]);
  for (std::size_t s = 0; s < judged[0]["strategies"].size(); ++s) {
    EXPECT_EQ(judged[0]["strategies"][s]["name"], judged[1]["strategies"][s]["name"]);
    EXPECT_EQ(judged[0]["strategies"][s]["left_out_um"], judged[1]["strategies"][s]["left_out_um"]);
  }
  EXPECT_NE(judged[0]["strategies"].back()["overall_rms_um"], judged[1]["strategies"].back()["overall_rms_um"]);
}

/// The record as a logger in Germany would have written it, of a clock that is set back in between.
std::string as_logged(const std::string& record) {
  std::istringstream lines(read_text(record));
  std::string line, text = "Messung\r\n\r\nZeit;Drehzahl;Halle;T Spindel;T S\xE4ule;Z [mm]\r\n";  // Latin-1
  bool is_header = true;
  while (std::getline(lines, line)) {
    if (line.starts_with("#")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (is_header) {
      EXPECT_EQ(line, "time_s,speed_rpm,ambient_degC,t_spindle_degC,t_column_degC,tip_z_um");
      is_header = false;
      continue;
    }
    const int seconds = std::stoi(cells[0]) + 3600 + 1800,
              local = seconds < 3 * 3600 ? seconds : seconds - 3600;  // from 1:30 on
    char stamp[64];
    std::snprintf(stamp, sizeof stamp, "27.10.2024 %02d:%02d:%02d", local / 3600, local / 60 % 60, local % 60);
    char rest[256];
    std::snprintf(rest, sizeof rest, ";-%s;%s;%s;%s;%.9f\r\n", cells[1].c_str(), cells[2].c_str(), cells[3].c_str(),
                  cells[4].c_str(), 1e-3 * std::stod(cells[5]));
    std::string logged = std::string(stamp) + rest;
    std::replace(logged.begin() + 19, logged.end(), '.', ',');
    text += logged;
  }
  return text;
}
constexpr const char* kColumns = R"yaml(columns:
  decimal: ","
  time: {column: Zeit, format: "%d.%m.%Y %H:%M:%S", zone: Europe/Berlin}
  channels:
    speed: {column: Drehzahl, unit: rpm, magnitude: true}
    t_spindle: {column: T Spindel, unit: degC}
    t_column: {column: T Säule, unit: degC}
    ambient: {column: Halle, unit: degC}
    tip_z: {column: "Z [mm]", unit: mm}
)yaml";

// Every verb that takes records: the same numbers from a logger's files as from records of ours.
TEST_F(ValidateRecords, ReadsLoggersFilesWithEveryVerb) {
  const std::string mapped = scenario("mapped", [](std::string& t) { t += kColumns; });
  std::string plain, logged;
  for (const char* name : {"warm_up", "steps"}) {
    plain += " --train " + record(name);
    logged += " --train " + write_file(std::string(name) + ".log", as_logged(record(name)));
  }
  const std::string judged = write_file("to_and_fro.log", as_logged(record("to_and_fro")));
  const CommandOutcome notes = run_program("select " +
                                           scenario("fewer",
                                                    [](std::string& t) {
                                                      t += kColumns;
                                                      replace(t, "    ambient: {column: Halle, unit: degC}\n", "");
                                                    }) +
                                           logged + " -o " + (fresh_folder("verbs") / "notes").string());
  const std::size_t first = notes.output.find("not read: column 'Halle'");
  ASSERT_NE(first, std::string::npos) << notes.output;
  EXPECT_EQ(notes.output.find("not read", first + 1), std::string::npos) << notes.output;  // once, not for each file
  int n_runs = 0;
  const auto json = [&](const std::string& arguments, const std::string& file) {
    const auto out = fresh_folder("verbs") / std::to_string(++n_runs);
    const CommandOutcome run = run_program(arguments + " -o " + out.string());
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return Json::parse(read_text(out / file));
  };
  const Json &a = validated(machine_).summary,
             &b = json("validate " + mapped + logged + " --test " + judged, "summary.json");
  ASSERT_EQ(a["validation"]["strategies"].size(), b["validation"]["strategies"].size());
  for (std::size_t s = 0; s < a["validation"]["strategies"].size(); ++s) {
    const double of_a = a["validation"]["strategies"][s]["worst_peak_um"],
                 of_b = b["validation"]["strategies"][s]["worst_peak_um"];
    EXPECT_NEAR(of_a, of_b, 1e-3 + 1e-3 * of_a) << a["validation"]["strategies"][s]["name"];
  }
  const Json ranked_a = json("select " + machine_ + plain, "summary.json"),
             ranked_b = json("select " + mapped + logged, "summary.json");
  EXPECT_NEAR(ranked_a["channels"][0]["grade"], ranked_b["channels"][0]["grade"], 1e-5);

  const auto predicted = fresh_folder("predicted");
  for (const auto& [scenario, file, into] :
       {std::tuple{machine_, record("to_and_fro"), "a"}, std::tuple{mapped, judged, "b"}}) {
    const CommandOutcome run =
        run_program("predict " + scenario + " --cyclogram " + file + " -o " + (predicted / into).string());
    ASSERT_EQ(run.exit_code, 0) << run.output;
  }
  const Record by_record = read_record_csv((predicted / "a/record.csv").string()),
               by_log = read_record_csv((predicted / "b/record.csv").string());
  EXPECT_NEAR(by_record.at("tip_z").values.back(), by_log.at("tip_z").values.back(), 1e-6);

  const Json of_records = json("calibrate " + machine_ + " --measured " + record("steps"), "calibration.json"),
             of_logs = json("calibrate " + mapped + " --measured " + (temporary_folder() / "steps.log").string(),
                            "calibration.json");
  EXPECT_EQ(of_records["verdict"], of_logs["verdict"]);
  const Json& distortion = of_records["iso_230_3"].at(0);
  EXPECT_EQ(distortion["run"], "record");
  EXPECT_EQ(distortion["channels"].at(0)["unit"], "um");
  const Record steps = read_record_csv(record("steps"));
  const std::vector<double>& drift_um = steps.at(distortion["channels"][0]["name"].get<std::string>()).values;
  const auto [low, high] = std::minmax_element(drift_um.begin(), drift_um.end());
  EXPECT_NEAR(distortion["channels"][0]["range_whole_record"].get<double>(), *high - *low, 1e-4 * (*high - *low));
  EXPECT_EQ(
      run_program("diagnose " + mapped + " --measured " + judged + " -o " + (predicted / "diagnosis").string()).exit_code,
      0);

  EXPECT_THAT(run_program("check " + mapped).output,
              AllOf(HasSubstr("`columns`"), HasSubstr("'Zeit', format '%d.%m.%Y %H:%M:%S', local time of Europe/Berlin"),
                    HasSubstr("tip_z_um             'Z [mm]' in mm")));
  const std::string wrong = write_file("wrong.yaml", std::string("name: wrong\nstudy: {target: tip_x}\n") + kColumns);
  EXPECT_THAT(run_program("check " + wrong).output, AllOf(HasSubstr("'tip_x'"), HasSubstr("no column")));
  for (const auto& [target, exit_code] : {std::pair{"tip_z_um", 0}, std::pair{"ambient", 2}}) {
    const std::string by_header =
        write_file("by_header.yaml", fmt::format("name: by_header\nstudy: {{target: {}}}\n", target) + kColumns);
    EXPECT_EQ(run_program("check " + by_header).exit_code, exit_code) << target;
  }
}

}  // namespace
}  // namespace driftwright::validate_records_test
