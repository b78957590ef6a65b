// What is found is written, all of it: for each shipped scenario every law of every candidate, as text of a scenario that
// is read back, does to the same reduced machine what it did to the twin; at one place each, and under the label long at
// every place.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <tuple>

#include "base/parallel.hpp"
#include "diagnosis/extended_scenario.hpp"
#include "diagnosis/focus.hpp"
#include "diagnosis/scatter.hpp"
#include "machine/machine.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::diagnosis::every_finding_test {
namespace {

constexpr double kSame_K = 1e-3, kSame_um = 0.01;
constexpr double kRows = 30.0;       // of a record
constexpr double kLongest_s = 2e5;   // of it: what lasts ten days is cut
constexpr double kShort_s = 3600.0;  // where laws look at temperatures, and a run is integrated in steps

/// A record of a cyclogram with every channel that the scenario has.
MeasuredRun run_of(const scenarios::Scenario& s, Cyclogram cyclogram, const solver::Outputs& outputs, double longest_s) {
  MeasuredRun run;
  run.name = cyclogram.name;
  double end_s = 0.0;
  std::vector<Cyclogram::Section> kept;
  for (const auto& section : cyclogram.sections) {
    if (end_s >= longest_s || kept.size() >= 40) break;
    kept.push_back(section);
    kept.back().duration_s = std::min(section.duration_s, longest_s - end_s);
    end_s += kept.back().duration_s;
  }
  cyclogram.sections = kept;
  for (const auto& [name, unit, high] :
       {std::tuple{"oven", "W", 300.0}, std::tuple{"valve", "percent", 60.0}, std::tuple{"stove", "degC", 70.0}}) {
    const TimeSeries rows{{0.0, 0.2 * end_s, 0.5 * end_s, 0.7 * end_s}, {0.0, high, 0.0, high}};
    if (!cyclogram.column(name)) cyclogram.columns.push_back({name, unit, rows});
  }
  run.cyclogram = cyclogram;
  run.path = s.path;  // in place of its file, which is not opened
  run.ambient = s.machine->ambient;
  for (double row = 0.0; row <= kRows; row += 1.0) run.time_s.push_back(std::min(end_s, row / kRows * end_s));
  set_grid(run);
  for (std::size_t o = 0; o < outputs.name.size(); ++o) {
    if (outputs.ambient[static_cast<Eigen::Index>(o)] == 1.0) continue;
    run.channels.push_back({outputs.name[o], static_cast<int>(o), outputs.unit[o],
                            Eigen::VectorXd::Zero(static_cast<Eigen::Index>(run.time_s.size()))});
  }
  return run;
}

enum class Places { kOneEach, kAll };

void expect_written_and_read_back(const char* name, Places places) {
  const scenarios::Scenario scenario = scenarios::read_scenario(std::string("scenarios/") + name);
  ASSERT_TRUE(scenario.machine);
  const scenarios::PlacedMachine placed = scenarios::place(*scenario.machine);
  const solver::Outputs names = scenarios::output_names(*scenario.machine, placed);
  bool looks = false;
  placed.balance.for_each_law(
      [&](const std::string&, const effects::Law& law) { looks = looks || !law.probes.empty() || !law.thermostat.empty(); });
  std::vector<MeasuredRun> runs;
  for (const Cyclogram& c : scenario.cyclograms) {
    if (runs.size() < 2) runs.push_back(run_of(scenario, c, names, looks ? kShort_s : kLongest_s));
  }
  const AugmentedModel augmented = augment(scenario, placed.mesh, runs);
  const scenarios::ReducedMachine machine = scenarios::reduce(
      augmented.model, scenarios::build(augmented.model, scenarios::place(augmented.model, placed.mesh)), augmented.plan);
  const Twin whole(augmented, machine, {});
  const Focus focused = focus(whole, runs, scatter(whole), candidates(whole, runs, {}));
  const Twin twin(augmented, focused.machine, {.relative_tolerance = 1e-6, .absolute_tolerance_K = 1e-5});

  struct Job {
    std::string law, name;  // of the effect; with its place
    std::function<void(TwinState&)> change;
  };
  std::vector<Job> jobs;
  for (const Candidate& c : candidates(twin, runs, {})) {
    for (const Variant& v : c.variants) {
      for (const std::size_t g : {std::size_t{0}, v.grid.size() - 1}) {
        if (g > 0 && v.grid.size() == 1) continue;
        Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(v.knobs.size()));
        x[0] = v.all_or_nothing ? v.trial_x : 2.7182818 * v.trial_x;  // digits without end
        for (std::size_t k = 0; k < v.grid[g].size(); ++k) x[static_cast<Eigen::Index>(k + 1)] = 0.987654321 * v.grid[g][k];
        jobs.push_back({c.effect + ", " + v.law, c.effect + " at " + c.where + ", " + v.law,
                        change_of({0, 0, v.knobs, v.all_or_nothing}, x)});
      }
    }
  }
  for (const Knob& k : scatter(twin))
    jobs.push_back({"scatter " + k.effect + " " + k.name, "scatter " + k.effect + " at " + k.where + " " + k.name,
                    [k](TwinState& s) { k.set(s, k.value(1.2345678 * k.prior_sd)); }});
  ASSERT_GT(jobs.size(), 50u);
  if (places == Places::kOneEach) {
    std::map<std::string, Job> last;
    for (const Job& job : jobs) last[job.law] = job;
    jobs.clear();
    for (const auto& [law, job] : last) jobs.push_back(job);
    ASSERT_GT(jobs.size(), 20u);
  }

  std::vector<std::string> wrong(jobs.size());
  std::vector<double> apart(jobs.size(), 0.0);
  const std::filesystem::path folder = fresh_folder("every_finding");
  for_each_index(
      jobs.size(), [&] { return Twin::Workspace(twin); },
      [&](std::size_t j, Twin::Workspace& workspace) {
        TwinState found = twin.as_written();
        jobs[j].change(found);
        const ExtendedScenario extended =
            extended_scenario(scenario, twin, runs, {{jobs[j].name, "because", jobs[j].change}}, {"head"});
        if (!extended.not_written.empty()) {
          wrong[j] = "not written: " + extended.not_written.front();
          return;
        }
        const std::filesystem::path path = folder / (std::to_string(j) + ".yaml");
        std::ofstream(path) << extended.text;
        TwinState read;
        try {
          read = scenarios::read_scenario(path.string()).machine->effects;
        } catch (const InputError& e) {
          wrong[j] = std::string("not read: ") + e.what();
          return;
        }
        std::filesystem::remove(path);
        for (const MeasuredRun& run : runs) {
          const Eigen::MatrixXd predicted = twin.readings(found, run, workspace),
                                written = twin.readings(read, run, workspace);
          for (Eigen::Index o = 0; o < predicted.rows(); ++o) {
            const bool is_K = twin.outputs().unit[static_cast<std::size_t>(o)] == "K";
            const double scale = is_K ? 1.0 / kSame_K : 1e6 / kSame_um;
            apart[j] = std::max(apart[j], scale * (predicted.row(o) - written.row(o)).cwiseAbs().maxCoeff());
          }
        }
        if (!(apart[j] <= 1.0)) wrong[j] = "apart by " + std::to_string(apart[j]) + " times what is allowed";
      });
  int n_wrong = 0;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    if (wrong[j].empty()) continue;
    if (++n_wrong <= 20) ADD_FAILURE() << jobs[j].name << ": " << wrong[j];
  }
  EXPECT_EQ(n_wrong, 0);
  testing::Test::RecordProperty("findings", static_cast<int>(jobs.size()));
  testing::Test::RecordProperty("largest_difference_of_allowed",
                                std::to_string(*std::max_element(apart.begin(), apart.end())));
}

class EveryFinding : public testing::TestWithParam<const char*> {};
TEST_P(EveryFinding, IsWrittenAndReadBackAsTheTwinHadIt) {
  expect_written_and_read_back(GetParam(), Places::kOneEach);
}
class EveryFindingAtLength : public testing::TestWithParam<const char*> {};
TEST_P(EveryFindingAtLength, IsWrittenAndReadBackAsTheTwinHadItAtEveryPlace) {
  expect_written_and_read_back(GetParam(), Places::kAll);
}

const auto kShipped = ::testing::Values("lumped_spindle.yaml", "fp3_spindle.yaml", "cnc_mill_13.yaml", "c_frame.yaml",
                                        "gantry_table.yaml", "measured/heated_plate.yaml", "measured/incubator.yaml",
                                        "measured/lathe.yaml", "measured/printer_frame.yaml", "measured/test_house.yaml");
std::string name_of(const testing::TestParamInfo<const char*>& one) {
  std::string name = one.param;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}
// Of the machines with a mesh one, the FP3; the others are run at every place AtLength.
INSTANTIATE_TEST_SUITE_P(Shipped, EveryFinding,
                         ::testing::Values("lumped_spindle.yaml", "fp3_spindle.yaml", "measured/heated_plate.yaml",
                                           "measured/incubator.yaml", "measured/lathe.yaml", "measured/printer_frame.yaml",
                                           "measured/test_house.yaml"),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Shipped, EveryFindingAtLength, kShipped, name_of);

}  // namespace
}  // namespace driftwright::diagnosis::every_finding_test
