// The program on reduced models as a user runs it: the second run, against the full model, in sweeps, with no place to
// keep them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "base/csv_row.hpp"
#include "base/record.hpp"
#include "tests/app/csv_table.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/command_line.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::reduced_run_test {
namespace {

using fixtures::read_table, fixtures::Table;
namespace fs = std::filesystem;
using fixtures::ColumnAndHead, fixtures::write_column_and_head;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;

constexpr const char* kUpwards = "{type: natural_convection, surface: front, orientation: vertical, length: 100 mm}";

/// A cache of its own for the programs started from now on; the one before comes back at the end.
class Cache {
 public:
  explicit Cache(const std::string& path) { setenv("XDG_CACHE_HOME", path.c_str(), 1); }
  ~Cache() { setenv("XDG_CACHE_HOME", test_store().c_str(), 1); }
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;
};

/// There is no default store either: the user's own may hold the machine as an older program reduced it.
CommandOutcome run_without_home(const std::string& arguments) {
  const char* home = std::getenv("HOME");
  const std::string kept = home ? home : "";
  unsetenv("HOME");
  CommandOutcome outcome = run_program(arguments);
  if (home) setenv("HOME", kept.c_str(), 1);
  return outcome;
}

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), folder));
  }
  std::sort(files.begin(), files.end());
  return files;
}

void expect_same_files(const fs::path& a, const fs::path& b, std::size_t at_least) {
  EXPECT_EQ(files_below(a), files_below(b));
  EXPECT_GE(files_below(a).size(), at_least);
  for (const fs::path& file : files_below(a)) EXPECT_EQ(read_text(a / file), read_text(b / file)) << file;
}

/// Largest differences of two records, temperatures [K] and displacements [um].
std::pair<double, double> differences(const Record& a, const Record& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.channels.size(), b.channels.size());
  std::pair<double, double> worst = {0.0, 0.0};
  for (const Channel& c : a.channels) {
    const std::vector<double>& other = b.at(c.name).values;
    double& of = c.unit == "degC" ? worst.first : worst.second;
    for (std::size_t k = 0; k < c.values.size(); ++k) of = std::max(of, std::abs(c.values[k] - other[k]));
  }
  return worst;
}

ColumnAndHead lively(const std::string& model) {
  ColumnAndHead machine;
  machine.effects.emplace_back(ColumnAndHead::kFan);
  machine.effects.emplace_back(kUpwards);
  machine.solver = "{output_interval: 5 min, relative_tolerance: 1e-7, absolute_tolerance: 1e-7 K, model: " + model + "}";
  return machine;
}

TEST(ReducedRun, OfAKnownMachineGivesTheSameFilesWithoutItsMesh) {
  const fs::path folder = fresh_folder("known");
  const Cache cache((folder / "cache").string());
  const std::string scenario = write_column_and_head(folder, lively("reduced"));
  const CommandOutcome first = run_program("simulate " + scenario + " -o " + (folder / "first").string()),
                       second = run_program("simulate " + scenario + " -o " + (folder / "second").string());
  ASSERT_EQ(first.exit_code, 0) << first.output;
  ASSERT_EQ(second.exit_code, 0) << second.output;
  EXPECT_THAT(first.output, Not(HasSubstr("known from disk")));
  EXPECT_THAT(second.output, HasSubstr("known from disk"));
  expect_same_files(folder / "first", folder / "second", 5);
  // Another cyclogram that asks nearly the same is run on the same model, another material is not.
  ColumnAndHead other = lively("reduced");
  other.effects.pop_back();
  const std::string linear = write_column_and_head(folder, other, "linear");
  EXPECT_THAT(run_program("simulate " + linear + " -o " + (folder / "third").string()).output, Not(HasSubstr("known from")));
  other.cyclograms = "{other: [[50 min, 980 rpm], [30 min, 100 rpm]]}";
  write_column_and_head(folder, other, "linear");
  EXPECT_THAT(run_program("simulate " + linear + " -o " + (folder / "fourth").string()).output, HasSubstr("known from"));
  other.materials = "{column: steel_c45, head: cast_iron_gjl250}";
  write_column_and_head(folder, other, "linear");
  EXPECT_THAT(run_program("simulate " + linear + " -o " + (folder / "fifth").string()).output, Not(HasSubstr("known from")));
}

TEST(ReducedRun, IsTheFullModelToTheToleranceAtEveryRow) {
  const fs::path folder = fresh_folder("against_full");
  for (const char* model : {"full", "reduced"}) {
    const CommandOutcome outcome = run_program("simulate " + write_column_and_head(folder, lively(model), model) + " -o " +
                                               (folder / (std::string("of_") + model)).string());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  }
  const auto [worst_K, worst_um] = differences(read_record_csv((folder / "of_full/record.csv").string()),
                                               read_record_csv((folder / "of_reduced/record.csv").string()));
  EXPECT_GT(worst_K, 0.0);
  EXPECT_LT(worst_K, 5e-3);
  EXPECT_LT(worst_um, 1e-2);
}

TEST(Fp3AtLength, EveryReadingIsThatOfTheFullModelWithinFiveMillikelvin) {
  // The finite elements themselves, in time ten times more accurate than the comparison requires.
  std::string text = read_text("scenarios/fp3_spindle.yaml");
  for (const auto& [what, instead] :
       {std::pair{"model: reduced", "model: full"}, std::pair{"relative_tolerance: 1e-3", "relative_tolerance: 1e-5"},
        std::pair{"absolute_tolerance: 5e-3 K", "absolute_tolerance: 1e-4 K"},
        std::pair{"fields_format: vtu", "fields_format: none"}})
    text = fixtures::replaced(text, what, instead);
  const fs::path folder = fresh_folder("fp3_full");
  std::string said;  // of the full model, at the end
  for (const auto& [scenario, out] : {std::pair{std::string("scenarios/fp3_spindle.yaml"), "reduced"},
                                      std::pair{write_file("fp3_full.yaml", text), "full"}}) {
    const CommandOutcome outcome =
        run_program("simulate " + scenario + " --cyclogram heat_cool_1600 -o " + (folder / out).string());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    said = outcome.output;
  }
  EXPECT_THAT(said, HasSubstr("full model of"));
  const Record exact = read_record_csv((folder / "full/record.csv").string()),
               small = read_record_csv((folder / "reduced/record.csv").string());
  ASSERT_EQ(exact.time_s, small.time_s);
  for (const Channel& c : exact.channels) {
    const double allowed = c.unit == "degC" ? 5e-3 : c.unit == "um" ? 0.01 : 0.1;
    double worst = 0.0;
    for (std::size_t k = 0; k < c.values.size(); ++k)
      worst = std::max(worst, std::abs(c.values[k] - small.at(c.name).values[k]));
    EXPECT_LT(worst, allowed) << c.name;
    RecordProperty(c.name, std::to_string(worst));
  }
}

TEST(ReducedRun, GoesOnWithNowhereToKeepTheModel) {
  const fs::path folder = fresh_folder("nowhere");
  const std::string scenario = write_column_and_head(folder, lively("reduced"));
  const std::string no_folder = write_file("no_folder", "");
  {
    const Cache cache(no_folder);
    const CommandOutcome outcome = run_program("simulate " + scenario + " -o " + (folder / "a").string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, AllOf(HasSubstr("note: the reduced model is not kept"), HasSubstr(no_folder)));
  }
  unsetenv("XDG_CACHE_HOME");
  const CommandOutcome homeless = run_without_home("simulate " + scenario + " -o " + (folder / "b").string());
  EXPECT_EQ(homeless.exit_code, 0);
  expect_same_files(folder / "a", folder / "b", 5);
}

TEST(ReducedRun, ADamagedFolderIsMadeAnew) {
  const fs::path folder = fresh_folder("damaged");
  const Cache cache((folder / "cache").string());
  const std::string scenario = write_column_and_head(folder, lively("reduced"));
  ASSERT_EQ(run_program("simulate " + scenario + " -o " + (folder / "a").string()).exit_code, 0);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "cache")) {
    if (entry.path().filename() == "exchanges.npy") fs::resize_file(entry.path(), 200);
  }
  const CommandOutcome again = run_program("simulate " + scenario + " -o " + (folder / "b").string());
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.output,
              AllOf(Not(HasSubstr("known from disk")), HasSubstr("damaged and made anew"), HasSubstr("exchanges.npy")));
  expect_same_files(folder / "a", folder / "b", 5);
  EXPECT_THAT(run_program("simulate " + scenario + " -o " + (folder / "c").string()).output, HasSubstr("known from disk"));
}

double number(const Table& table, std::size_t member, const std::string& column) {
  const auto found = std::find(table[0].begin(), table[0].end(), column);
  if (found == table[0].end()) throw std::runtime_error("no column " + column);
  return std::stod(table.at(member)[static_cast<std::size_t>(found - table[0].begin())]);
}

const char* const kStudy = R"(name: study
scenario: scenario.yaml
design: latin_hypercube
samples: 12
seed: 3
vary:
  - {name: film, key: "effects[convection].film", uniform: [7 W/(m^2 K), 15 W/(m^2 K)]}
  - {name: power, key: "effects[heat_source].power", uniform: [25 W, 70 W]}
collect: [t_head.end, z.end]
)";

TEST(ReducedSweep, MembersAreWhatTheFullModelOfTheirValuesGives) {
  const fs::path folder = fresh_folder("sweep_members");
  write_column_and_head(folder, lively("reduced"));
  std::ofstream(folder / "study.yaml") << kStudy;
  const CommandOutcome outcome =
      run_program("sweep " + (folder / "study.yaml").string() + " -o " + (folder / "out").string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const Table table = read_table(folder / "out" / "sweep.csv");
  ASSERT_EQ(table.size(), 13u);
  for (const std::size_t member : {1u, 6u, 12u}) {
    for (const char* model : {"full", "reduced"}) {
      ColumnAndHead one = lively(model);
      one.effects[0] = fmt::format("{{type: heat_source, region: head, power: {} W, at_speed: 1000 rpm, exponent: 1}}",
                                   number(table, member, "power_W"));
      one.effects[1] =
          fmt::format("{{type: convection, surface: outside, film: {} W/(m^2 K)}}", number(table, member, table[0][1]));
      const fs::path out = folder / fmt::format("{}_{}", model, member);
      const CommandOutcome alone =
          run_program("simulate " + write_column_and_head(folder, one, "one") + " -o " + out.string());
      ASSERT_EQ(alone.exit_code, 0) << alone.output;
      const Record record = read_record_csv((out / "record.csv").string());
      // A member's model spans all members, its own only itself: each is within 5 mK of the full one.
      const double allowed_K = std::string(model) == "full" ? 5e-3 : 1e-2;
      EXPECT_NEAR(number(table, member, "cycle_t_head_end_degC"), record.at("t_head").values.back(), allowed_K) << model;
      EXPECT_NEAR(number(table, member, "cycle_z_end_um"), record.at("z").values.back(), 2.0 * allowed_K) << model;
    }
  }
}

TEST(ReducedSweep, ShardsAndAWarmCacheGiveTheBytesOfOneRun) {
  const fs::path folder = fresh_folder("sweep_shards");
  write_column_and_head(folder, lively("reduced"));
  std::ofstream(folder / "study.yaml") << kStudy;
  const std::string study = (folder / "study.yaml").string(), out = (folder / "out").string();
  {
    const Cache cache((folder / "one").string());
    ASSERT_EQ(run_program("sweep " + study + " -o " + (folder / "whole").string()).exit_code, 0);
    ASSERT_EQ(run_program("sweep " + study + " -o " + (folder / "again").string()).exit_code, 0);
  }
  const Cache cache((folder / "two").string());
  std::vector<std::thread> shards;
  for (int i = 1; i <= 3; ++i) {
    shards.emplace_back([&, i] {
      const CommandOutcome shard = run_program(fmt::format("sweep {} --shard {}/3 -o {}", study, i, out));
      EXPECT_EQ(shard.exit_code, 0) << shard.output;
    });
  }
  for (std::thread& shard : shards) shard.join();
  ASSERT_EQ(run_program("sweep " + study + " --merge -o " + out).exit_code, 0);
  EXPECT_EQ(read_text(folder / "out/sweep.csv"), read_text(folder / "whole/sweep.csv"));
  EXPECT_EQ(read_text(folder / "again/sweep.csv"), read_text(folder / "whole/sweep.csv"));
  std::size_t n_models = 0;  // one for all members
  for (const auto& entry : fs::directory_iterator(folder / "two" / "driftwright")) n_models += entry.is_directory();
  EXPECT_EQ(n_models, 1u);
}

TEST(ReducedSweep, FullAndReducedMembersStandSideBySide) {
  const fs::path folder = fresh_folder("sweep_mixed");
  write_column_and_head(folder, lively("reduced"));
  std::ofstream(folder / "study.yaml") << R"(name: study
scenario: scenario.yaml
design: list
vary:
  - {name: model, key: solver.model, values: [full, reduced, reduced, full]}
  - {name: material, key: materials.column, values: [steel_c45, steel_c45, cast_iron_gjl250, cast_iron_gjl250]}
collect: [t_head.end, z.end]
)";
  const CommandOutcome outcome =
      run_program("sweep " + (folder / "study.yaml").string() + " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  const Table table = read_table(folder / "out" / "sweep.csv");
  ASSERT_EQ(table.size(), 5u);
  for (const auto& [full, small] : {std::pair{1u, 2u}, std::pair{4u, 3u}}) {
    EXPECT_NEAR(number(table, full, "cycle_z_end_um"), number(table, small, "cycle_z_end_um"), 0.01);
    EXPECT_NE(number(table, full, "cycle_z_end_um"), number(table, small, "cycle_z_end_um"));
  }
  EXPECT_GT(std::abs(number(table, 1, "cycle_z_end_um") - number(table, 4, "cycle_z_end_um")), 0.1);
}

}  // namespace
}  // namespace driftwright::reduced_run_test
