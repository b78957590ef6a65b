// `validate` on records as a user has them: with and without a machine in the scenario, with a hall, without one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/command_line.hpp"

namespace driftwright {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

// A spindle and a column of lumped nodes whose films do not follow temperatures.
constexpr const char* kMachine = R"(name: two_bodies
reference_temperature: 20 degC
start: hall
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 6 kJ/K}
  - {type: node, node: column, capacity: 60 kJ/K}
  - {type: heat_source, node: spindle, power: 120 W, at_speed: 3000 rpm, exponent: 1.3}
  - {type: link, node: spindle, to: column, conductance: 6 W/K}
  - {type: link, node: spindle, to: hall, conductance: 2 W/K}
  - {type: link, node: column, to: hall, conductance: 8 W/K}
hall: [[0 h, 20 degC], [5 h, 22 degC]]
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
    machine_ = write_file("two_bodies.yaml", std::string(kMachine) + kStudy + "  train: [warm_up, steps]\n  judge: to_and_fro\n");
    records_only_ = write_file("records_only.yaml", std::string("name: records_only\n") + kStudy);
    for (const char* name : {"warm_up", "steps", "to_and_fro"}) {
      const CommandOutcome run =
          run_program("simulate " + machine_ + " --cyclogram " + name + " -o " + (folder_ / name).string());
      ASSERT_EQ(run.exit_code, 0) << run.output;
    }
  }
  static std::string record(const std::string& name) { return (folder_ / name / "record.csv").string(); }
  /// The part `validation` of the summary.
  static Json validate(const std::string& scenario, const std::string& test_record) {
    const auto out = fresh_folder("validated") / "out";
    const CommandOutcome run = run_program("validate " + scenario + " --train " + record("warm_up") + " --train " +
                                           record("steps") + " --test " + test_record + " -o " + out.string());
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return run.exit_code == 0 ? Json::parse(read_text(out / "summary.json")) : Json{};
  }
  static const Json* strategy(const Json& summary, const std::string& name) {
    for (const Json& s : summary["validation"]["strategies"]) {
      if (s["name"] == name) return &s;
    }
    return nullptr;
  }
  static inline std::filesystem::path folder_;
  static inline std::string machine_, records_only_;
};

TEST_F(ValidateRecords, PhysicsIsJudgedOnRecordsOfAMachine) {
  const Json summary = validate(machine_, record("to_and_fro"));
  for (const char* name : {"thermal modes of the model", "model fitted to the training runs", "observer"}) {
    const Json* s = strategy(summary, name);
    ASSERT_TRUE(s) << name;
    // the model is the machine itself: what it leaves are the seven digits of the record
    EXPECT_LT((*s)["worst_peak_um"].get<double>(), 0.05) << name << s->dump();
  }
}

TEST_F(ValidateRecords, AmbientAloneIsNoReasonToFail) {
  const Json summary = validate(records_only_, record("to_and_fro"));
  EXPECT_TRUE(strategy(summary, "transfer functions from speed"));
  EXPECT_FALSE(strategy(summary, "observer"));
  EXPECT_THAT(summary["validation"]["left_out"].dump(), HasSubstr("the scenario has no machine"));
}

TEST_F(ValidateRecords, AHallThermometerThatNeverReadIsSaid) {
  std::string text = read_text(record("to_and_fro"));
  std::istringstream lines(text);
  std::string line, emptied;
  std::ptrdiff_t column = -1;
  while (std::getline(lines, line)) {
    if (line.starts_with("#")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (column < 0) {
      column = std::find(cells.begin(), cells.end(), "ambient_degC") - cells.begin();
    } else {
      cells.at(static_cast<std::size_t>(column)).clear();
    }
    for (std::size_t i = 0; i < cells.size(); ++i) emptied += (i ? "," : "") + cells[i];
    emptied += "\n";
  }
  const Json summary = validate(records_only_, write_file("no_hall.csv", emptied));
  EXPECT_THAT(summary["warnings"].dump(), HasSubstr("no hall temperature"));
}

}  // namespace
}  // namespace driftwright
