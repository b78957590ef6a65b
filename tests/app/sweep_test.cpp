// `driftwright sweep` as a user runs it: members are what `simulate` gives, failures stay alone, kill and shards change
// no byte. One file: all its cases read tables of small sweeps in one way.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "base/csv_row.hpp"
#include "base/file_bytes.hpp"
#include "base/record.hpp"
#include "tests/app/csv_table.hpp"
#include "tests/shared/command_line.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::sweep_test {
namespace {

using fixtures::read_table, fixtures::replaced, fixtures::Table;
namespace fs = std::filesystem;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;

std::string lumped() {
  return fs::absolute("scenarios/lumped_spindle.yaml").string();
}

std::string write_study(const fs::path& folder, const std::string& scenario, const std::string& rest) {
  const fs::path file = folder / "study.yaml";
  std::ofstream(file) << "name: study\nscenario: " << scenario << "\n" << rest;
  return file.string();
}

/// 40 members of the lumped spindle, a few milliseconds each.
const char* const kHypercube = R"(cyclograms: [shift]
design: latin_hypercube
samples: 40
seed: 11
vary:
  - {name: preload, key: "effects[bearing_friction@bearing_front].load", uniform: [200 N, 400 N]}
  - {name: flow, key: "effects[coolant].flow", log_uniform: [3 L/min, 9 L/min]}
collect: [nose_z, t_cooler.max]
)";

std::string cell(const Table& table, std::size_t member, const std::string& column) {
  const auto found = std::find(table[0].begin(), table[0].end(), column);
  EXPECT_NE(found, table[0].end()) << column;
  return found == table[0].end() ? "" : table[member][static_cast<std::size_t>(found - table[0].begin())];
}

/// The last value of a channel as `simulate` gives it, in the digits of a table.
std::string end_by_simulate(const fs::path& folder, const std::string& scenario, const std::string& cyclogram,
                            const std::string& channel) {
  std::ofstream(folder / "by_hand.yaml") << scenario;
  const CommandOutcome outcome = run_program("simulate " + (folder / "by_hand.yaml").string() + " --cyclogram " + cyclogram +
                                             " --force -o " + (folder / "by_hand").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  return fmt::format("{:.7g}", read_record_csv((folder / "by_hand" / "record.csv").string()).at(channel).values.back());
}

TEST(Sweep, MembersAreWhatSimulateGives) {
  const fs::path folder = fresh_folder("members");
  const std::string study = write_study(folder, lumped(), R"(design: list
vary:
  - {name: preload, key: "effects[bearing_friction@bearing_front].load", values: [300 N, 250 N]}
  - {name: tolerance, key: solver.relative_tolerance, values: [1e-4, 1e-5]}
)");
  const CommandOutcome outcome = run_program("sweep " + study + " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("study: 2 members, 0 failed"), HasSubstr("shift_nose_z_peak_um")));
  const Table table = read_table(folder / "out" / "sweep.csv");
  ASSERT_EQ(table.size(), 3u);
  std::string scenario = read_text(lumped());
  EXPECT_EQ(cell(table, 1, "shift_nose_z_end_um"), end_by_simulate(folder, scenario, "shift", "nose_z"));
  scenario =
      replaced(replaced(scenario, "load: 300 N", "load: 250 N"), "relative_tolerance: 1e-4", "relative_tolerance: 1e-5");
  EXPECT_EQ(cell(table, 2, "shift_nose_z_end_um"), end_by_simulate(folder, scenario, "shift", "nose_z"));
  EXPECT_EQ(cell(table, 2, "warm_up_t_stator_end_degC"), end_by_simulate(folder, scenario, "warm_up", "t_stator"));
  EXPECT_EQ(cell(table, 2, "preload_N"), "250");
  EXPECT_THAT(read_text(folder / "out" / "report.html"), AllOf(HasSubstr("Rank correlation"), HasSubstr("<svg")));
  EXPECT_FALSE(fs::exists(folder / "out.parts")) << "nothing is left beside the results";
}

TEST(Sweep, AMemberThatFailsCostsNoOther) {
  const fs::path folder = fresh_folder("failing");
  const std::string rest = R"(design: list
cyclograms: [warm_up]
vary:
  - name: power
    key: effects[motor_loss@shaft].power
    values: [90 W, 0.9 MW, 90 W, 1 MW, 80 W]
collect: [nose_z.end]
)";
  const CommandOutcome outcome =
      run_program("sweep " + write_study(folder, lumped(), rest) + " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("member 2 failed: cyclogram 'warm_up': a law refused the state, bearing_friction "
                              "bearing_front: oil temperature"),
                    HasSubstr("member 4 failed: "), HasSubstr("2 of 5 members failed; the column `status` of ")));
  const Table table = read_table(folder / "out" / "sweep.csv");
  ASSERT_EQ(table.size(), 6u);
  EXPECT_THAT(cell(table, 2, "status"), HasSubstr("gave up: "));
  EXPECT_THAT(cell(table, 4, "status"), HasSubstr("gave up: "));
  EXPECT_EQ(cell(table, 2, "warm_up_nose_z_end_um"), "");
  EXPECT_EQ(cell(table, 1, "status"), "done");
  EXPECT_EQ(cell(table, 1, "warm_up_nose_z_end_um"), cell(table, 3, "warm_up_nose_z_end_um"));
  EXPECT_LT(std::stod(cell(table, 5, "warm_up_nose_z_end_um")), std::stod(cell(table, 1, "warm_up_nose_z_end_um")));
  EXPECT_THAT(read_text(folder / "out" / "report.html"), HasSubstr("2 of 5 members failed"));
}

TEST(Sweep, AValueThatFitsNoMemberIsRefusedBeforeAnythingRuns) {
  struct Refused {
    const char *name, *design, *values, *what;
  };
  for (const Refused& r : {Refused{"range", "list", "values: [90 W, -1 W, 80 W]", "-1 W lies outside"},
                           Refused{"unit", "grid", "values: [90 W, 80 kg]", "wrong unit 'kg'"},
                           Refused{"bare", "grid", "from: 80\n    to: 90\n    steps: 3", "has no unit"},
                           Refused{"end", "latin_hypercube\nsamples: 4", "uniform: [80 W, 3 MW]", "lies outside"}}) {
    const fs::path folder = fresh_folder(std::string("refused_") + r.name);
    const std::string rest = fmt::format(
        "design: {}\ncyclograms: [warm_up]\nvary:\n  - key: effects[motor_loss@shaft].power\n    {}\n", r.design, r.values);
    const CommandOutcome outcome =
        run_program("sweep " + write_study(folder, lumped(), rest) + " -o " + (folder / "out").string());
    EXPECT_EQ(outcome.exit_code, 2) << r.name << outcome.output;
    EXPECT_THAT(outcome.output, AllOf(HasSubstr("study.yaml:"), HasSubstr(r.what), HasSubstr("no member was simulated")))
        << r.name;
    EXPECT_FALSE(fs::exists(folder / "out.parts")) << r.name;
  }
}

TEST(Sweep, ValuesOfAListMayGoTogetherAndFitNoneAlone) {
  // A window's new begin lies after its old end.
  const fs::path folder = fresh_folder("together");
  std::ofstream(folder / "two.yaml") << R"(name: two
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: body, capacity: 5 kJ/K}
  - {type: heat_source, node: body, power: 20 W, from: 0 min, until: 10 min}
  - {type: link, node: body, to: ambient, conductance: 4 W/K}
ambient: 20 degC
sensors: [{name: t_body, node: body}]
cyclograms: {rest: [[60 min, 0 rpm]]}
)";
  const std::string rest = R"(design: list
vary:
  - {key: "effects[heat_source].from", values: [0 min, 20 min]}
  - {key: "effects[heat_source].until", values: [10 min, 30 min]}
)";
  const CommandOutcome outcome =
      run_program("sweep " + write_study(folder, "two.yaml", rest) + " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}

TEST(Sweep, AMemberWithoutAWayOutForHeatCostsNoOtherOfAReducedSweep) {
  // One basis cannot span a machine that loses no heat: each member then gets its own.
  const fs::path folder = fresh_folder("failing_reduced");
  std::ofstream(folder / "one_node.yaml") << R"(name: one_node
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: body, capacity: 5 kJ/K}
  - {type: heat_source, node: body, power: 20 W}
  - {type: link, node: body, to: ambient, conductance: 4 W/K}
ambient: [[0 h, 20 degC]]
sensors: [{name: t_body, node: body}]
cyclograms: {rest: [[60 min, 0 rpm]]}
solver: {model: reduced}
)";
  const std::string rest = R"(design: list
cyclograms: [rest]
vary:
  - name: link
    key: effects[link@body@ambient].conductance
    values: [4 W/K, 0 W/K, 5 W/K]
collect: [t_body.end]
)";
  const CommandOutcome outcome =
      run_program("sweep " + write_study(folder, "one_node.yaml", rest) + " -o " + (folder / "out").string());
  const Table table = read_table(folder / "out" / "sweep.csv");
  ASSERT_EQ(table.size(), 4u) << outcome.output;
  EXPECT_EQ(cell(table, 1, "status"), "done");
  EXPECT_THAT(cell(table, 2, "status"), HasSubstr("refused: "));
  EXPECT_EQ(cell(table, 3, "status"), "done");
  // C = 5 kJ/K, 60 min: 20 + P/G (1 - exp(-G t / C))
  EXPECT_NEAR(std::stod(cell(table, 1, "rest_t_body_end_degC")), 20.0 + 5.0 * (1.0 - std::exp(-4.0 * 3600.0 / 5000.0)),
              0.01);
  EXPECT_NEAR(std::stod(cell(table, 3, "rest_t_body_end_degC")), 20.0 + 4.0 * (1.0 - std::exp(-5.0 * 3600.0 / 5000.0)),
              0.01);
}

TEST(Sweep, SaysByIndicesAndATornadoWhichNumberDecides) {
  const fs::path folder = fresh_folder("sobol");
  const std::string study = write_study(folder, fs::absolute("scenarios/first_machine.yaml").string(), R"(design: sobol
samples: 32
vary:
  - {name: power, key: "effects[heat_source].power", uniform: [100 W, 200 W]}
  - {name: capacity, key: "effects[node@housing].capacity", uniform: [18.9 kJ/K, 19.1 kJ/K]}
collect: [nose_z.end]
)");
  const CommandOutcome outcome = run_program("sweep " + study + " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(read_table(folder / "out" / "sweep.csv").size(), 1u + 4u * 32u);
  const Table indices = read_table(folder / "out" / "tables" / "sobol_indices.csv");
  ASSERT_EQ(indices.size(), 3u);
  EXPECT_EQ(cell(indices, 1, "varied"), "power_W");
  EXPECT_NEAR(std::stod(cell(indices, 1, "total")), 1.0, 0.25) << "32 samples";
  EXPECT_LT(std::stod(cell(indices, 2, "total")), 1e-3);
  const Table tornado = read_table(folder / "out" / "tables" / "tornado.csv");
  EXPECT_EQ(cell(tornado, 1, "varied"), "power_W") << "the longest bar first";
  EXPECT_NEAR(std::stod(cell(tornado, 1, "at_high")) / std::stod(cell(tornado, 1, "at_low")), 197.5 / 102.5, 1e-3)
      << "the drift is proportional to the power";
  const CommandOutcome too_many = run_program("sweep " + write_study(folder, lumped(), R"(design: sobol
samples: 400000
vary: [{key: "effects[coolant].flow", uniform: [3 L/min, 9 L/min]}]
)"));
  EXPECT_EQ(too_many.exit_code, 2);
  EXPECT_THAT(too_many.output, HasSubstr("take 3 members a sample; at most 1000000 members, 333333 samples, are allowed"));
}

TEST(Sweep, GivesTheSameBytesOnOneAndTwoThreads) {
  const fs::path folder = fresh_folder("threads");
  const std::string study = write_study(folder, lumped(), kHypercube);
  for (const char* n : {"1", "2"}) {
    setenv("OMP_NUM_THREADS", n, 1);
    EXPECT_EQ(run_program("sweep " + study + " -o " + (folder / n).string()).exit_code, 0);
  }
  unsetenv("OMP_NUM_THREADS");
  const std::string one = read_text(folder / "1" / "sweep.csv");
  EXPECT_GT(one.size(), 2000u);
  EXPECT_EQ(one, read_text(folder / "2" / "sweep.csv"));
  EXPECT_EQ(read_text(folder / "1" / "report.html"), read_text(folder / "2" / "report.html"));
}

TEST(Sweep, ShardsAtOnceGiveTheBytesOfOneRun) {
  const fs::path folder = fresh_folder("shards");
  const std::string study = write_study(folder, lumped(), kHypercube), out = (folder / "out").string();
  EXPECT_EQ(run_program("sweep " + study + " -o " + (folder / "whole").string()).exit_code, 0);
  const CommandOutcome too_early = run_program("sweep " + study + " --merge -o " + out);
  EXPECT_EQ(too_early.exit_code, 2);
  EXPECT_THAT(too_early.output, HasSubstr("40 of 40 members have no row in"));
  std::vector<std::thread> shards;
  for (int i = 1; i <= 3; ++i) {
    shards.emplace_back([&, i] {
      const CommandOutcome shard = run_program(fmt::format("sweep {} --shard {}/3 -o {}", study, i, out));
      EXPECT_EQ(shard.exit_code, 0) << shard.output;
      EXPECT_THAT(shard.output, HasSubstr(fmt::format("shard {} of 3, {} members", i, i == 3 ? 14 : 13)));
    });
  }
  for (std::thread& shard : shards) shard.join();
  EXPECT_TRUE(fs::exists(folder / "out.parts" / "sweep.2of3.csv"));
  EXPECT_FALSE(fs::exists(folder / "out"));
  fs::rename(folder / "out.parts" / "sweep.2of3.csv", folder / "sweep.2of3.csv");
  const CommandOutcome one_missing = run_program("sweep " + study + " --merge -o " + out);
  EXPECT_EQ(one_missing.exit_code, 2);
  EXPECT_THAT(one_missing.output, HasSubstr("13 of 40 members have no row in"));
  fs::rename(folder / "sweep.2of3.csv", folder / "out.parts" / "sweep.2of3.csv");
  EXPECT_EQ(run_program("sweep " + study + " --merge -o " + out).exit_code, 0);
  EXPECT_EQ(read_text(folder / "out" / "sweep.csv"), read_text(folder / "whole" / "sweep.csv"));
  EXPECT_EQ(read_text(folder / "out" / "report.html"), read_text(folder / "whole" / "report.html"));
  EXPECT_FALSE(fs::exists(folder / "out.parts"));
}

/// Starts a sweep and kills it with SIGKILL once it has written some rows; returns their number.
std::size_t run_and_kill(const std::string& study, const fs::path& out) {
  const fs::path rows = out.string() + ".parts/sweep.csv.partial";
  const pid_t child = fork();
  if (child == 0) {
    execl(DRIFTWRIGHT_PROGRAM, "driftwright", "sweep", study.c_str(), "-o", out.c_str(), nullptr);
    _exit(127);
  }
  const auto n_lines = [&] {
    const std::string text = fs::exists(rows) ? read_text(rows) : "";
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  };
  for (int i = 0; i < 6000 && n_lines() < 6; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it had ended before it could be killed";
  return n_lines() - 2;  // content and header
}

TEST(Sweep, GoesOnWhereItWasKilled) {
  const fs::path folder = fresh_folder("killed");
  const std::string study = write_study(folder, lumped(), replaced(kHypercube, "samples: 40", "samples: 250"));
  const fs::path out = folder / "out", partial = folder / "out.parts" / "sweep.csv.partial";
  const std::size_t n_rows = run_and_kill(study, out);
  ASSERT_GE(n_rows, 4u);
  ASSERT_LT(n_rows, 250u);
  EXPECT_FALSE(fs::exists(out)) << "no table looks whole";
  fs::copy(folder / "out.parts", folder / "marked.parts");
  EXPECT_EQ(run_program("sweep " + study + " -o " + out.string()).exit_code, 0);
  EXPECT_EQ(run_program("sweep " + study + " -o " + (folder / "whole").string()).exit_code, 0);
  EXPECT_EQ(read_text(out / "sweep.csv"), read_text(folder / "whole" / "sweep.csv"));
  EXPECT_FALSE(fs::exists(partial));
  // That rows are taken over, not computed again, shows by a mark in one of them.
  const fs::path marked = folder / "marked.parts" / "sweep.csv.partial";
  std::string text = read_text(marked);
  const std::size_t done = text.find(",done"), begin = text.rfind('\n', done) + 1, tab = text.find('\t', done);
  std::string row = text.substr(begin, tab - begin);
  row.insert(row.find(",done"), "123456");  // more digits than a table has
  text.replace(begin, text.find('\n', tab) - begin, row + "\t" + content_hash(row));
  std::ofstream(marked) << text << "240,torn";
  EXPECT_EQ(run_program("sweep " + study + " -o " + (folder / "marked").string()).exit_code, 0);
  const std::string table = read_text(folder / "marked" / "sweep.csv");
  EXPECT_THAT(table, AllOf(HasSubstr("123456,done"), Not(HasSubstr("torn"))));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 252);  // comment, header, members
}

TEST(Sweep, AChangedStudyTakesNoStaleRows) {
  const fs::path folder = fresh_folder("stale");
  const fs::path out = folder / "out";
  std::string study = write_study(folder, lumped(), replaced(kHypercube, "samples: 40", "samples: 250"));
  ASSERT_GE(run_and_kill(study, out), 4u);
  study = write_study(folder, lumped(), replaced(kHypercube, "seed: 11", "seed: 12"));
  const CommandOutcome outcome = run_program("sweep " + study + " -o " + out.string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("rows of an earlier version of this study or its scenario are dropped"));
  EXPECT_EQ(run_program("sweep " + study + " -o " + (folder / "whole").string()).exit_code, 0);
  EXPECT_EQ(read_text(out / "sweep.csv"), read_text(folder / "whole" / "sweep.csv"));
}

TEST(Sweep, RefusesBadInputBeforeAnythingRuns) {
  const fs::path folder = fresh_folder("refused");
  const std::string study = write_study(folder, lumped(), kHypercube), out = (folder / "out").string();
  for (const char* shard : {"0/3", "4/3", "x/3", "3", "1/", "-1/3"}) {
    const CommandOutcome outcome = run_program(fmt::format("sweep {} --shard={} -o {}", study, shard, out));
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.output, HasSubstr("must be i/n with 1 <= i <= n"));
  }
  EXPECT_EQ(run_program("sweep " + study + " --merge --shard 1/2 -o " + out).exit_code, 2);
  EXPECT_EQ(run_program("sweep " + lumped() + " -o " + out).exit_code, 2);
  fs::create_directories(out);
  std::ofstream(folder / "out" / "thesis.tex") << "mine";
  const CommandOutcome foreign = run_program("sweep " + study + " -o " + out);
  EXPECT_EQ(foreign.exit_code, 2);
  EXPECT_THAT(foreign.output, HasSubstr("thesis.tex"));
  EXPECT_FALSE(fs::exists(folder / "out.parts"));
}

/// A steel column of 100 x 100 x 300 mm of 2 x 2 x 4 linear bricks, as Abaqus text.
std::string column_inp() {
  std::string text = "*NODE\n";
  const auto node = [](int i, int j, int k) { return 1 + i + 3 * j + 9 * k; };
  for (int k = 0; k <= 4; ++k) {
    for (int j = 0; j <= 2; ++j) {
      for (int i = 0; i <= 2; ++i) text += fmt::format("{}, {}, {}, {}\n", node(i, j, k), 50 * i, 50 * j, 75 * k);
    }
  }
  text += "*ELEMENT, TYPE=C3D8, ELSET=column\n";
  int n = 0;
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 2; ++i) {
        text += fmt::format("{}, {}, {}, {}, {}, {}, {}, {}, {}\n", ++n, node(i, j, k), node(i + 1, j, k),
                            node(i + 1, j + 1, k), node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1),
                            node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1));
      }
    }
  }
  return text;
}

const char* const kColumn = R"(name: column
reference_temperature: 20 degC
machine:
  mesh: column.inp
  units: mm
  surfaces:
    - {name: foot, region: column, plane: {through: [0 mm, 0 mm, 0 mm], normal: [0, 0, -1]}}
    - {name: outside, remaining: true}
materials: {column: cast_iron_gjl250}
supports: [{surface: foot, fixed: [x, y, z]}]
effects:
  - {type: heat_source, region: column, power: 20 W, at_speed: 1000 rpm, exponent: 1}
  - {type: convection, surface: outside, film: 10 W/(m^2 K)}
ambient: [[0 min, 20 degC]]
sensors: [{name: t, region: column, at: [50 mm, 50 mm, 300 mm]}]
displacements:
  - {name: z, along: z, tool: {region: column, at: [50 mm, 50 mm, 300 mm]}, table: {region: column, at: [50 mm, 50 mm, 0 mm]}}
cyclograms: {warm_up: [[60 min, 1000 rpm]]}
solver: {output_interval: 10 min}
)";

TEST(Sweep, MembersThatShareAMeshOrAMachineAreWhatSimulateGivesToo) {
  const fs::path folder = fresh_folder("shared");
  std::ofstream(folder / "column.inp") << column_inp();
  std::ofstream(folder / "column.yaml") << kColumn;
  const std::string study = write_study(folder, "column.yaml", R"(design: grid
vary:
  - {name: material, key: materials.column, values: [cast_iron_gjl250, steel_c45]}
  - {name: film, key: "effects[convection@outside].film", values: [10 W/(m^2 K), 40 W/(m^2 K)]}
  - {name: drive, key: cyclograms.warm_up, values: {low: [[60 min, 1000 rpm]], high: [[60 min, 3000 rpm]]}}
)");
  for (const char* n : {"1", "2", "4"}) {  // groups one after the other, and side by side
    setenv("OMP_NUM_THREADS", n, 1);
    const CommandOutcome outcome = run_program("sweep " + study + " -o " + (folder / n).string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  }
  unsetenv("OMP_NUM_THREADS");
  EXPECT_EQ(read_text(folder / "1" / "sweep.csv"), read_text(folder / "2" / "sweep.csv"));
  EXPECT_EQ(read_text(folder / "1" / "sweep.csv"), read_text(folder / "4" / "sweep.csv"));
  const Table table = read_table(folder / "1" / "sweep.csv");
  ASSERT_EQ(table.size(), 9u);
  std::size_t member = 0;
  for (const char* material : {"cast_iron_gjl250", "steel_c45"}) {
    for (const char* film : {"10 W/(m^2 K)", "40 W/(m^2 K)"}) {
      for (const char* speed : {"1000 rpm]]", "3000 rpm]]"}) {
        std::string scenario = replaced(kColumn, "column: cast_iron_gjl250", std::string("column: ") + material);
        scenario = replaced(replaced(scenario, "10 W/(m^2 K)", film), "1000 rpm]]", speed);
        ++member;
        EXPECT_EQ(cell(table, member, "warm_up_z_end_um"), end_by_simulate(folder, scenario, "warm_up", "z")) << member;
        EXPECT_EQ(cell(table, member, "material"), material);
      }
    }
  }
}

TEST(Sweep, MembersThatDifferInInstrumentsDriveAndMaterialsAreWhatSimulateGives) {
  const fs::path folder = fresh_folder("instruments");
  const std::string scenario = replaced(kColumn, "effects:\n",
                                        "effects:\n"
                                        "  - {type: expansion, region: column, factor: 1.00}\n"
                                        "  - {type: speed_override, factor: 1.000}\n"
                                        "  - {type: mount_shift, displacement: z, shift: 1.0 um, time: 30 min}\n");
  std::ofstream(folder / "column.inp") << column_inp();
  std::ofstream(folder / "column.yaml") << scenario;
  const std::string study = write_study(folder, "column.yaml", R"(design: grid
vary:
  - {name: expansion, key: "effects[expansion].factor", values: ["1.00", "2.00"]}
  - {name: override, key: "effects[speed_override].factor", values: ["1.000", "1.200"]}
  - {name: shift, key: "effects[mount_shift].shift", values: [1.0 um, -3.0 um]}
)");
  const CommandOutcome outcome = run_program("sweep " + study + " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  const Table table = read_table(folder / "out" / "sweep.csv");
  ASSERT_EQ(table.size(), 9u);
  std::size_t member = 0;
  for (const char* expansion : {"1.00}", "2.00}"}) {
    for (const char* factor : {"1.000}", "1.200}"}) {
      for (const char* shift : {"1.0 um", "-3.0 um"}) {
        const std::string one =
            replaced(replaced(replaced(scenario, "1.00}", expansion), "1.000}", factor), "1.0 um", shift);
        EXPECT_EQ(cell(table, ++member, "warm_up_z_end_um"), end_by_simulate(folder, one, "warm_up", "z")) << member;
      }
    }
  }
  const auto z_um = [&](std::size_t m) { return std::stod(cell(table, m, "warm_up_z_end_um")); };
  EXPECT_NEAR(z_um(1) - z_um(2), 4.0, 1e-4);                // seven digits of some 10 um
  EXPECT_NEAR(z_um(5) - 1.0, 2.0 * (z_um(1) - 1.0), 1e-4);  // one region: all of it expands twice
  EXPECT_GT(std::abs(z_um(3) - 1.0), 1.05 * std::abs(z_um(1) - 1.0));
}

TEST(Sweep, AMeshThatCannotBeMadeFailsItsMembersAlone) {
  const fs::path folder = fresh_folder("no_mesh");
  std::ofstream(folder / "column.inp") << column_inp();
  std::ofstream(folder / "column.yaml") << kColumn;
  std::ofstream(folder / "broken.inp") << "no mesh at all\n";
  const std::string study = write_study(folder, "column.yaml", R"(design: grid
vary:
  - {name: mesh, key: machine.mesh, values: [column.inp, broken.inp]}
  - {name: film, key: "effects[convection@outside].film", values: [10 W/(m^2 K), 40 W/(m^2 K)]}
collect: [z.end]
)");
  const CommandOutcome outcome = run_program("sweep " + study + " -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  const Table table = read_table(folder / "out" / "sweep.csv");
  EXPECT_EQ(cell(table, 1, "status"), "done");
  EXPECT_EQ(cell(table, 2, "status"), "done");
  EXPECT_THAT(cell(table, 3, "status"), AllOf(HasSubstr("refused: "), HasSubstr("broken.inp")));
  EXPECT_THAT(cell(table, 4, "status"), AllOf(HasSubstr("refused: "), HasSubstr("broken.inp")));
}

TEST(LumpedSweep, GivesWhatItsHeaderSays) {
  const fs::path folder = fresh_folder("lumped_sweep");
  const CommandOutcome outcome = run_program("sweep scenarios/lumped_sweep.yaml -o " + (folder / "out").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  const Table table = read_table(folder / "out" / "sweep.csv");
  ASSERT_EQ(table.size(), 49u);
  for (std::size_t member = 1; member <= 48; ++member) {
    EXPECT_EQ(cell(table, member, "status"), "done");
    EXPECT_NEAR(std::stod(cell(table, member, "warm_up_nose_z_peak_um")), 57.2, 1.1);
  }
}

}  // namespace
}  // namespace driftwright::sweep_test
