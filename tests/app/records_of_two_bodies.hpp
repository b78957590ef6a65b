#pragma once
// A machine of two bodies, another whose oil thins, records of three runs of each, and what `validate` writes of them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/shared/command_line.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright {

// A spindle and a column of lumped nodes whose films do not follow temperatures.
inline constexpr const char* kMachine = R"(name: two_bodies
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
inline constexpr const char* kOil =
    "{type: bearing_friction, node: spindle, count: 2, f0: 1, viscosity_40: 25 mm^2/s, viscosity_100: 5.4 mm^2/s, "
    "mean_diameter: 90 mm, f1: 0.0006, load: 300 N, preload_growth: 10 N/K, inner: {node: spindle}, outer: {node: column}}";
inline constexpr const char* kStudy = R"(study:
  target: tip_z
  sensors_to_choose: 2
  count_from_start: true
  tolerance: 3 um
)";

class RecordsOfTwoBodies : public ::testing::Test {
 protected:
  using Json = nlohmann::json;
  static void SetUpTestSuite() {
    folder_ = fresh_folder("two_bodies");
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
    EXPECT_THAT(summary["validation"]["left_out"].dump(), ::testing::HasSubstr(why));
  }
  static inline std::filesystem::path folder_;
  static inline std::string machine_, records_only_, oiled_;
};

}  // namespace driftwright
