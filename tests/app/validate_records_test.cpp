// `validate` on records as a user has them: with and without a machine in the scenario, with an ambient, without one. One
// file: its cases share records that take most of its time to simulate.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/csv_row.hpp"
#include "base/record.hpp"
#include "tests/shared/command_line.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::validate_records_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

// A spindle and a column of lumped nodes whose films do not follow temperatures.
constexpr const char* kMachine = R"(name: two_bodies
reference_temperature: 20 degC
start: ambient
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 6 kJ/K}
  - {type: node, node: column, capacity: 60 kJ/K}
  - {type: heat_source, node: spindle, power: 120 W, at_speed: 3000 rpm, exponent: 1.3}
  - {type: link, node: spindle, to: column, conductance: 6 W/K}
  - {type: link, node: spindle, to: ambient, conductance: 2 W/K}
  - {type: link, node: column, to: ambient, conductance: 8 W/K}
ambient: [[0 h, 20 degC], [5 h, 22 degC]]
sensors:
  - {name: t_spindle, node: spindle}
  - {name: t_column, node: column}
displacements:
  - name: tip_z
    sensitivities:
      - {node: spindle, sensitivity: 2 um/K}
      - {node: column, sensitivity: 5 um/K}
cyclograms:
  warm_up: [[150 min, 3000 rpm], [90 min, 0 rpm]]
  steps: [[60 min, 1000 rpm], [60 min, 2000 rpm], [60 min, 3000 rpm], [60 min, 0 rpm]]
  to_and_fro: [[40 min, 2500 rpm], [40 min, 0 rpm], [40 min, 1500 rpm], [40 min, 0 rpm], [40 min, 3000 rpm]]
)";
// Its oil thins, and its bearing gets tighter as the spindle outruns the column: 150 W cold and 100 W 20 K warmer, at 3000
// rpm.
constexpr const char* kOil =
    "{type: bearing_friction, node: spindle, count: 2, f0: 1, viscosity_40: 25 mm^2/s, viscosity_100: 5.4 mm^2/s, "
    "mean_diameter: 90 mm, f1: 0.0006, load: 300 N, preload_growth: 10 N/K, inner: {node: spindle}, outer: {node: column}}";
constexpr const char* kStudy = R"(study:
  target: tip_z
  sensors_to_choose: 2
  count_from_start: true
  tolerance: 3 um
)";

class ValidateRecords : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fresh_folder("validate_records");
    machine_ = scenario("two_bodies", [](std::string&) {});
    records_only_ = write_file("records_only.yaml", std::string("name: records_only\n") + kStudy);
    for (const char* name : {"warm_up", "steps", "to_and_fro"}) simulate(machine_, name, name);
    oiled_ = scenario("oiled", [](std::string& t) {
      replace(t, "{type: heat_source, node: spindle, power: 120 W, at_speed: 3000 rpm, exponent: 1.3}", kOil);
    });
    for (const char* name : {"warm_up", "steps", "to_and_fro"}) simulate(oiled_, name, std::string("oiled_") + name);
  }
  /// The machine, edited.
  static std::string scenario(const std::string& name, const std::function<void(std::string&)>& edit) {
    std::string text = std::string(kMachine) + kStudy + "  train: [warm_up, steps]\n  judge: to_and_fro\n";
    edit(text);
    return write_file(name + ".yaml", text);
  }
  static void replace(std::string& text, const std::string& what, const std::string& by) {
    text = fixtures::replaced(text, what, by);
  }
  static void simulate(const std::string& scenario, const std::string& cyclogram, const std::string& into) {
    const CommandOutcome run =
        run_program("simulate " + scenario + " --cyclogram " + cyclogram + " -o " + (folder_ / into).string());
    ASSERT_EQ(run.exit_code, 0) << run.output;
  }
  static std::string record(const std::string& name) { return (folder_ / name / "record.csv").string(); }
  /// A record whose rows are edited, the header left: cells of a row, and its index.
  static std::string edited(const std::string& name, const std::string& file,
                            const std::function<bool(std::vector<std::string>&, const std::vector<std::string>&)>& keep) {
    std::istringstream lines(read_text(record(name)));
    std::string line, text;
    std::vector<std::string> header;
    while (std::getline(lines, line)) {
      if (line.starts_with("#")) continue;
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (header.empty()) {
        header = cells;
      } else if (!keep(cells, header)) {
        continue;
      }
      for (std::size_t i = 0; i < cells.size(); ++i) text += (i ? "," : "") + cells[i];
      text += "\n";
    }
    std::filesystem::create_directories(folder_ / file);
    std::ofstream(folder_ / file / "record.csv") << text;
    return file;
  }
  struct Validated {
    std::filesystem::path folder;
    std::string said;
    Json summary;
  };
  /// What `validate` writes of a scenario and records; each is run once.
  /// @param of  "", or the first part of the names of another machine's records
  static const Validated& validated(const std::string& scenario, const std::string& judged = "to_and_fro",
                                    const std::string& of = "") {
    static std::map<std::string, Validated> all;
    const auto [at, is_new] = all.try_emplace(scenario + " " + of + judged);
    Validated& v = at->second;
    if (!is_new) return v;
    v.folder = fresh_folder(fmt::format("validated_{}", all.size())) / "out";
    const CommandOutcome run =
        run_program("validate " + scenario + " --train " + record(of + "warm_up") + " --train " + record(of + "steps") +
                    " --test " + record(of + judged) + " -o " + v.folder.string());
    EXPECT_EQ(run.exit_code, 0) << run.output;
    v.said = run.output;
    if (run.exit_code == 0) v.summary = Json::parse(read_text(v.folder / "summary.json"));
    return v;
  }
  static const Json& validate(const std::string& scenario, const std::string& judged, const std::string& of = "") {
    return validated(scenario, judged, of).summary;
  }
  static const Json* strategy(const Json& summary, const std::string& name) {
    for (const Json& s : summary["validation"]["strategies"]) {
      if (s["name"] == name) return &s;
    }
    return nullptr;
  }
  /// The model is the machine itself: what it leaves are the seven digits of the record, and the ambient between its rows.
  static void expect_exact(const Json& summary) {
    for (const char* name : {"thermal modes of the model", "model fitted to the training runs", "observer"}) {
      const Json* s = strategy(summary, name);
      ASSERT_TRUE(s) << name << summary["validation"]["left_out"];
      EXPECT_LT((*s)["worst_peak_um"].get<double>(), 0.05) << name << s->dump();
    }
  }
  static void expect_left_out(const Json& summary, const std::string& why) {
    EXPECT_FALSE(strategy(summary, "observer"));
    EXPECT_TRUE(strategy(summary, "ridge, all sensors"));
    EXPECT_THAT(summary["validation"]["left_out"].dump(), HasSubstr(why));
  }
  static inline std::filesystem::path folder_;
  static inline std::string machine_, records_only_, oiled_;
};

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

// A machine that is its own model, run for ten hours without ever coming back to balance. What follows 6 h goes on from
// what came before, so that the model is exact there, too; had the part begun at 0, or cold, it would be off by the 30 um
// that the machine has gone by then.
TEST_F(ValidateRecords, APartOfALongRecordGoesOnFromWhatCameBefore) {
  const std::string week = scenario("long_record", [](std::string& t) {
    replace(
        t, "  to_and_fro:",
        "  week: [[2 h, 3000 rpm], [1 h, 0 rpm], [2 h, 1500 rpm], [1 h, 0 rpm], [2 h, 2500 rpm], [30 min, 0 rpm], [90 min, "
        "2000 rpm]]\n  to_and_fro:");
  });
  simulate(week, "week", "week");
  const auto out = fresh_folder("parts") / "out";
  const CommandOutcome run = run_program("validate " + week + " --train " + record("week") + ":0h..6h --test " +
                                         record("week") + ":6h..10h -o " + out.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const Json summary = Json::parse(read_text(out / "summary.json"));
  expect_exact(summary);
  for (const Json& l : summary["validation"]["left_out"])  // of three thermometers no three modes
    EXPECT_THAT(l["name"].get<std::string>(), HasSubstr("common modes"));
  EXPECT_EQ(summary["validation"]["trained_on"].size(), 2u);
  EXPECT_THAT(summary["warnings"].dump(), AllOf(HasSubstr("cut into 2 runs"), HasSubstr("at 3.00 h"),
                                                HasSubstr("the later run continues the earlier one")));
  EXPECT_THAT(run.output, HasSubstr("record.csv:6h..10h"));
  const Json* nothing = strategy(summary, "no correction");
  ASSERT_TRUE(nothing);
  EXPECT_GT((*nothing)["worst_peak_um"].get<double>(), 20.0);

  // rows after the fitted ones may be corrected, as `validate` judged them; a part that holds one of the others may not
  const std::string file = (out / "models/ridge_all_sensors.json").string();
  const auto compensate = [&](const std::string& part) {
    return run_program("compensate " + week + " --model " + file + " --through none --measured " + record("week") + part +
                       " -o " + (out / "corrected").string());
  };
  for (const char* part : {"", ":5h..10h", ":..1h", ":2h..2.5h", ":0h..6h"})
    EXPECT_THAT(compensate(part).output, HasSubstr("it was fitted on")) << part;
  const CommandOutcome corrected = compensate(":6h..10h");
  ASSERT_EQ(corrected.exit_code, 0) << corrected.output;
  const Json left = Json::parse(read_text(out / "corrected/summary.json"));
  EXPECT_EQ(left["peak_left_um"], (*strategy(summary, "ridge, all sensors"))["worst_peak_um"]);
  EXPECT_THAT(left["iso_230_3"]["not_available"].dump(), HasSubstr("goes on from what came before"));
  const Record rows = read_record_csv((out / "corrected/corrected.csv").string());
  EXPECT_EQ(rows.time_s.front(), 0.0);
  EXPECT_NEAR(rows.time_s.back(), 4.0 * 3600.0, 1.0);

  const CommandOutcome selected =
      run_program("select " + week + " --train " + record("week") + " -o " + (out / "selected").string());
  EXPECT_EQ(selected.exit_code, 0) << selected.output;
  EXPECT_THAT(selected.output, AllOf(HasSubstr("cut into"), Not(HasSubstr("not possible"))));
}

// Three files of one recording: lags of the third begin with what the second holds, in `validate` and in `compensate
// --after`.
TEST_F(ValidateRecords, ARecordThatContinuesAnotherIsCorrectedAsJudged) {
  const std::string shifts = scenario("shifts", [](std::string& t) {
    replace(t, "  to_and_fro:",
            "  day: [[1 h, 3000 rpm], [1 h, 0 rpm], [1 h, 1500 rpm], [30 min, 2500 rpm], [90 min, 0 rpm], [1 h, 2000 "
            "rpm]]\n  to_and_fro:");
  });
  simulate(shifts, "day", "day");
  const std::string scenario =
      write_file("continued.yaml", "name: continued\nstudy: {target: tip_z, sensors_to_choose: 2, tolerance: 3 um}\n");
  for (int part = 0; part < 3; ++part) {
    edited("day", fmt::format("day_{}", part), [&](std::vector<std::string>& cells, const std::vector<std::string>&) {
      return std::min(2, static_cast<int>(std::stod(cells[0]) / 7200.0)) == part;
    });
  }
  const auto out = fresh_folder("continued") / "out";
  const CommandOutcome judged = run_program("validate " + scenario + " --train " + record("day_0") + " --train " +
                                            record("day_1") + " --test " + record("day_2") + " -o " + out.string());
  ASSERT_EQ(judged.exit_code, 0) << judged.output;
  const Json summary = Json::parse(read_text(out / "summary.json"));
  const auto compensate = [&](const std::string& file, const std::string& further) {
    return run_program("compensate " + scenario + " --model " + file + " --through none" + further + " -o " +
                       (out / "corrected").string());
  };
  const std::string measured = " --measured " + record("day_2");
  bool differs = false;  // of one with a memory
  for (const auto& file : std::filesystem::directory_iterator(out / "models")) {
    if (file.path().extension() != ".json") continue;
    const std::string path = file.path().string();
    const auto peak_um = [&](const std::string& further) {
      const CommandOutcome run = compensate(path, further);
      EXPECT_EQ(run.exit_code, 0) << run.output;
      return Json::parse(read_text(out / "corrected/summary.json"))["peak_left_um"];
    };
    const Json* s = strategy(summary, Json::parse(read_text(file.path()))["name"]);
    ASSERT_TRUE(s) << path;
    EXPECT_EQ(peak_um(measured + " --after " + record("day_1")), (*s)["worst_peak_um"]) << path;
    differs = differs || peak_um(measured) != (*s)["worst_peak_um"];
  }
  EXPECT_TRUE(differs);
  const std::string file = (out / "models/ridge_all_sensors.json").string();
  EXPECT_THAT(compensate(file, measured + " --after " + record("day_0")).output, HasSubstr("does not continue"));
  EXPECT_THAT(compensate(file, measured + ":0h..1h --after " + record("day_1")).output, HasSubstr("whole records"));
  EXPECT_THAT(compensate(file, " --after " + record("day_1")).output, HasSubstr("--after requires --measured"));
}

// A simulated run is corrected by the readings that it was judged by: noise and steps of `validation`, drawn as there.
TEST_F(ValidateRecords, ASimulatedRunIsCorrectedAsItWasJudged) {
  const auto out = fresh_folder("simulated") / "out";
  const std::string noisy = scenario("noisy", [](std::string& t) {
    replace(t, "  to_and_fro:", "  third: [[90 min, 2000 rpm], [60 min, 0 rpm]]\n  to_and_fro:");
    t += "solver: {model: reduced}\nvalidation:\n  train: [warm_up, steps, third]\n  families: {other: [to_and_fro]}\n  "
         "sensor_noise: 0.1 K\n"
         "  sensor_resolution: 0.1 K\n";
  });
  const CommandOutcome judged = run_program("validate " + noisy + " -o " + out.string());
  ASSERT_EQ(judged.exit_code, 0) << judged.output;
  const Json summary = Json::parse(read_text(out / "summary.json"));
  const auto compensate = [&](const std::string& scenario, const std::string& name, const std::string& further) {
    return run_program("compensate " + scenario + " --model " + (out / "models" / name).string() + " " + further + " -o " +
                       (out / "corrected").string());
  };
  for (const char* name : {"ridge_all_sensors.json", "observer.json"}) {
    const CommandOutcome run = compensate(noisy, name, "--through none");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("with noise and steps"));
    const double left_um = Json::parse(read_text(out / "corrected/summary.json"))["rms_left_um"];
    const Json file = Json::parse(read_text(out / "models" / name));
    EXPECT_NEAR(left_um, (*strategy(summary, file["name"]))["overall_rms_um"].get<double>(), 1e-6 * left_um) << name;
  }
  const CommandOutcome exact = compensate(machine_, "ridge_all_sensors.json", "--through none");
  EXPECT_THAT(exact.output, HasSubstr("thermometers read exactly"));
  EXPECT_LT(Json::parse(read_text(out / "corrected/summary.json"))["rms_left_um"].get<double>(),
            (*strategy(summary, "ridge, all sensors"))["overall_rms_um"].get<double>());
  EXPECT_THAT(compensate(noisy, "ridge_all_sensors.json", "--through none --cyclogram steps").output,
              HasSubstr("it was fitted on"));

  // a plan is none of what was judged
  const CommandOutcome planned = compensate(noisy, "ridge_all_sensors.json", "--through schedule");
  EXPECT_EQ(planned.exit_code, 0) << planned.output;
  EXPECT_THAT(planned.output, AllOf(HasSubstr("follows readings live"), HasSubstr("margin of")));
  const Json plan = Json::parse(read_text(out / "corrected/summary.json"));
  EXPECT_EQ(plan["judged_as"], "live");
  EXPECT_LE(plan["margin_um"].get<double>(), 1.5);

  const std::string other = scenario("other_names", [](std::string& t) { replace(t, "name: t_column", "name: t_back"); });
  const CommandOutcome unknown = compensate(other, "ridge_all_sensors.json", "--through none");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.output, AllOf(HasSubstr("'t_column'"), HasSubstr("no sensor of"), Not(HasSubstr("simulating"))));
}

// Each cyclogram of a family, named or drawn, in each season: as it is driven, and what the observer leaves of it.
TEST_F(ValidateRecords, EachFamilyIsJudgedInEachSeason) {
  const auto out = fresh_folder("seasons") / "out";
  const std::string seasons = scenario("seasons", [](std::string& t) {
    t += "solver: {model: reduced}\nvalidation:\n  train: [warm_up, steps]\n  families:\n    other: [to_and_fro]\n"
         "    drawn: {count: 2, sections: 3, duration: 2 h, speeds: [500 rpm, 1500 rpm, 3000 rpm]}\n"
         "  seasons: {summer: {offset: 8 K, swing: 3 K}}\n";
  });
  const CommandOutcome judged = run_program("validate " + seasons + " -o " + out.string());
  ASSERT_EQ(judged.exit_code, 0) << judged.output;
  std::istringstream lines(read_text(out / "strategies.csv"));
  std::map<std::string, double> uncorrected_um;  // family, season and run
  int n_observed = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> cells = csv_cells(line);  // strategy, family, season, run, failed, peak before, .., left
    if (cells.size() < 8 || !cells[4].empty()) continue;
    if (cells[0] == "no correction") uncorrected_um[cells[1] + " " + cells[2] + " " + cells[3]] = std::stod(cells[7]);
    if (cells[0] != "observer") continue;
    ++n_observed;
    EXPECT_LT(std::stod(cells[7]), 0.01 * std::stod(cells[5])) << line;
  }
  ASSERT_EQ(uncorrected_um.size(), 6U);
  EXPECT_EQ(n_observed, 6);
  const Record run = read_record_csv(record("to_and_fro"));
  double peak_um = 0.0;
  for (double um : run.at("tip_z").values) peak_um = std::max(peak_um, std::abs(um - run.at("tip_z").values.front()));
  EXPECT_NEAR(uncorrected_um.at("other as trained to_and_fro"), peak_um, 1e-4 * peak_um);  // the solver's relative tolerance
  for (const char* cyclogram : {"other {} to_and_fro", "drawn {} drawn_random_01", "drawn {} drawn_random_02"}) {
    const auto in = [&](const char* season) { return uncorrected_um.at(fmt::format(fmt::runtime(cyclogram), season)); };
    EXPECT_GT(in("summer"), 1.01 * in("as trained")) << cyclogram;
  }
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
