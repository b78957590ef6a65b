// Places of thermometers on small machines: closed forms, all sets, and what the program writes read again.

#include "studies/placement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "compensation/sensors/exchange_search.hpp"
#include "machine/simulated_run.hpp"
#include "mesh/reach.hpp"
#include "studies/placement_rivals.hpp"
#include "studies/placement_tests.hpp"
#include "studies/placement_yaml.hpp"
#include "tests/shared/best_of_all_sets.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"
#include "tests/studies/kept_in_memory.hpp"

namespace driftwright::studies::placement_test {
namespace {

using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::ThrowsMessage, ::testing::UnorderedElementsAre;

// Each is heated by its own source and cooled by its own link; the tool sees the difference.
constexpr const char* kTwoBodies = R"(name: two_bodies
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 20 kJ/K}
  - {type: node, node: base, capacity: 60 kJ/K}
  - {type: heat_source, node: head, power: 100 W, at_speed: 1000 rpm, exponent: 1}
  - {type: heat_source, node: base, power: 60 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: head, to: ambient, conductance: 5 W/K}
  - {type: link, node: base, to: ambient, conductance: 4 W/K}
sensors: [{name: t_head, node: head}]
displacements: [{name: nose, sensitivities: [{node: head, sensitivity: 2 um/K}, {node: base, sensitivity: -1 um/K}]}]
cyclograms:
  job: [[180 min, 1000 rpm]]
)";

scenarios::Scenario scenario_of(const std::string& text) {
  return scenarios::read_scenario(write_file("placement.yaml", text));
}

PlacementModel model_of(const scenarios::Scenario& scenario, const SpotRules& rules = {},
                        const std::vector<std::string>& mounted = {}) {
  std::vector<const Cyclogram*> cyclograms;
  for (const Cyclogram& c : scenario.cyclograms) cyclograms.push_back(&c);
  return placement_model(scenario, cyclograms, rules, mounted, {}, {});
}

// A body warms by T = P/G (1 - e^-x), x = t G / C. To ln P it owes T, to ln G: P/G x e^-x - T, to the logarithm of all
// rates P/G x e^-x. What one thermometer on the head leaves is conditioned by the covariance of all its readings until
// then.
TEST(Placement, OfTwoBodiesLeavesTheVarianceThatIsWorkedOutByHand) {
  const scenarios::Scenario scenario = scenario_of(kTwoBodies);
  const PlacementModel model = model_of(scenario);
  ASSERT_EQ(model.n_candidates, 2);
  ASSERT_EQ(model.spots[0].region, "head");
  const std::vector<MachineRun> runs =
      runs_in_all_ambients(scenario, scenario.cyclograms, {scenarios::Validation::Season{"", 0.0, 0.0}}, 36);
  ASSERT_EQ(runs.size(), 1u);
  const double noise_K = 0.1, scatter = 0.3, row_s = 300.0;
  const std::vector<compensation::RunSensitivity> numerical =
      sensitivities(model, runs, factor_states(model, runs), noise_K, model.rows);
  const double r =
      noise_K * noise_K + 0.1 * 0.1 * 1800.0 / row_s;  // the model misses by 0.1 K in the same way for half an hour
  EXPECT_NEAR(numerical.front().reading_K2, r, 1e-12);
  const Eigen::Index n_rows = 37;
  const auto by_hand = [&](double watt, double W_K, double J_K, double t_s) {  // ln P, ln G, ln rate
    const double x = t_s * W_K / J_K, steady_K = watt / W_K, now_K = steady_K * (1.0 - std::exp(-x)),
                 bend_K = steady_K * x * std::exp(-x);
    return Eigen::Vector3d(now_K, bend_K - now_K, bend_K);
  };
  Eigen::MatrixXd head = Eigen::MatrixXd::Zero(n_rows, 5), base = head;  // P, G of the head, P, G of the base, rate
  for (Eigen::Index i = 0; i < n_rows; ++i) {
    const Eigen::Vector3d h = by_hand(100.0, 5.0, 20e3, row_s * static_cast<double>(i)),
                          b = by_hand(60.0, 4.0, 60e3, row_s * static_cast<double>(i));
    head.row(i) << h(0), h(1), 0.0, 0.0, h(2);
    base.row(i) << 0.0, 0.0, b(0), b(1), b(2);
  }
  double sum = 0.0;
  for (Eigen::Index end : {9, 18, 27, 37}) {
    const Eigen::MatrixXd y = head.topRows(end);
    const Eigen::RowVectorXd d = 2.0 * head.row(end - 1) - base.row(end - 1);
    Eigen::MatrixXd yy = scatter * scatter * y * y.transpose();
    yy.diagonal().array() += r;
    const Eigen::VectorXd cross = scatter * scatter * y * d.transpose();
    sum += scatter * scatter * d.squaredNorm() - cross.dot(yy.ldlt().solve(cross));
  }
  const double by_hand_um = std::sqrt(sum / 4.0);
  const double um = compensation::ObserverLeft(numerical, {scatter}).of(std::vector<int>{0});
  EXPECT_NEAR(um, by_hand_um, 0.01 * by_hand_um);  // differences over 1 % of each factor
  EXPECT_GT(by_hand_um, 0.5);
}

/// Twelve bodies in a row, with heat, links and sensitivities drawn at random.
std::string chain(int seed) {
  Random random(static_cast<std::uint64_t>(seed), 77);
  std::string text =
                  "name: chain\nreference_temperature: 20 degC\nambient: 20 degC\nmachine: {generator: lumped}\neffects:\n",
              moved;
  for (int i = 0; i < 12; ++i) {
    text += fmt::format("  - {{type: node, node: b{}, capacity: {:.3f} kJ/K}}\n", i, random.log_uniform(2.0, 40.0));
    text += fmt::format("  - {{type: link, node: b{}, to: ambient, conductance: {:.3f} W/K}}\n", i,
                        random.log_uniform(0.5, 4.0));
    if (i > 0)
      text += fmt::format("  - {{type: link, node: b{}, to: b{}, conductance: {:.3f} W/K}}\n", i, i - 1,
                          random.log_uniform(2.0, 30.0));
    if (i % 3 == 0)
      text += fmt::format("  - {{type: heat_source, node: b{}, power: {:.1f} W, at_speed: 1000 rpm, exponent: {:.2f}}}\n", i,
                          random.log_uniform(20.0, 200.0), random.uniform(0.8, 2.0));
    moved += fmt::format("{}{{node: b{}, sensitivity: {:.3f} um/K}}", i > 0 ? ", " : "", i, random.normal());
  }
  return text + fmt::format(
                    "displacements: [{{name: nose, sensitivities: [{}]}}]\ncyclograms:\n  slow: [[120 min, 500 rpm], [120 "
                    "min, 0 rpm]]\n"
                    "  fast: [[120 min, 1000 rpm], [60 min, 0 rpm]]\n  mixed: [[60 min, 1000 rpm], [60 min, 300 rpm], [60 "
                    "min, 800 rpm]]\n",
                    moved);
}

TEST(Placement, OnTwelveBodiesIsTheBestOfAllSetsOfThree) {
  int n_equal = 0, n_all = 0;
  double worst = 1.0;
  for (int seed = 1; seed <= 6; ++seed) {
    const scenarios::Scenario scenario = scenario_of(chain(seed));
    const PlacementModel model = model_of(scenario);
    const std::vector<MachineRun> runs =
        runs_in_all_ambients(scenario, scenario.cyclograms, {scenarios::Validation::Season{"", 0.0, 3.0}}, 24);
    const compensation::ObserverLeft observer(sensitivities(model, runs, factor_states(model, runs), 0.1, model.rows),
                                              {0.1, 0.3});
    const compensation::RegressionLeft regression(
        scattered_runs(model, runs, 1, scattered_states(model, runs, {0.1, 0.3}, {1, 2}), model.rows, model.ambient), 0.1);
    const compensation::LeftOfBoth both(observer, regression);
    const compensation::LeftWithLoss with_loss(both);
    for (const compensation::DriftLeft* left :
         {static_cast<const compensation::DriftLeft*>(&observer), static_cast<const compensation::DriftLeft*>(&regression),
          static_cast<const compensation::DriftLeft*>(&both), static_cast<const compensation::DriftLeft*>(&with_loss)}) {
      const double ratio = compensation::best_sets(*left, 3).back().left_um / fixtures::best_of_all_sets_um(*left, 3);
      EXPECT_GE(ratio, 1.0 - 1e-9);
      worst = std::max(worst, ratio);
      n_equal += ratio < 1.0 + 1e-9 ? 1 : 0;
      ++n_all;
    }
  }
  EXPECT_EQ(n_equal, n_all) << "worst ratio " << worst;
}

TEST(Placement, JudgedOnWhatItHasNotSeenIsBetterThanRandomAndByGrade) {
  const Placement p = *place_thermometers(scenario_of(chain(1)), {.n = 3, .n_most = 4}, {});
  ASSERT_EQ(p.others.size(), 4u);
  ASSERT_EQ(p.chosen.left.size(), 4u);
  for (const ChosenBy& other : p.others) {
    if (other.way != "grey grade" && other.way != "random") continue;
    EXPECT_LT(p.chosen.left[2].observer_um, other.left[2].observer_um) << other.way;
    EXPECT_LT(p.chosen.left[2].regression_um, other.left[2].regression_um) << other.way;
  }
  EXPECT_LT(p.chosen.left[2].observer_um, 0.5 * p.without.observer_um);
  EXPECT_LT(p.without.observer_um, p.drift_um);
  EXPECT_GE(p.losses.front().worst.observer_um, p.losses.front().all.observer_um);
  // Cyclograms that were not chosen on; the same numbers once more.
  for (const std::string& name : p.judged_on) EXPECT_EQ(std::count(p.chosen_on.begin(), p.chosen_on.end(), name), 0) << name;
  EXPECT_EQ(place_thermometers(scenario_of(chain(1)), {.n = 3, .n_most = 4}, {})->chosen.left[2].observer_um,
            p.chosen.left[2].observer_um);
  // What the observer may expect by its design, and what it does on machines that were drawn: alike within a factor of two.
  EXPECT_NEAR(std::log(p.chosen.left[2].observer_um / p.observer_um[2]), 0.0, std::log(2.0));
}

// Three shards and what puts them together: the same to the last bit, and nothing that is kept is worked out again.
TEST(Placement, OfShardsIsThatOfOneRun) {
  const scenarios::Scenario scenario = scenario_of(chain(1));
  const PlacementOptions how{.n = 2, .n_most = 3};
  const Placement whole = *place_thermometers(scenario, how, {});
  KeptInMemory kept;
  for (const char* shard : {"1/3", "2/3", "3/3"})
    EXPECT_FALSE(place_thermometers(scenario, how, {}, kept.of(shard))) << shard;
  const int n_worked = kept.n_worked;
  const Placement merged = *place_thermometers(scenario, how, {}, kept.of(""));
  EXPECT_EQ(kept.n_worked, n_worked);
  EXPECT_EQ(merged.chosen.sets, whole.chosen.sets);
  EXPECT_EQ(merged.objective_um, whole.objective_um);
  EXPECT_EQ(merged.drift_um, whole.drift_um);
  ASSERT_EQ(merged.others.size(), whole.others.size());
  for (std::size_t w = 0; w < whole.others.size(); ++w) {
    EXPECT_EQ(merged.others[w].sets, whole.others[w].sets);
    for (std::size_t n = 0; n < whole.others[w].left.size(); ++n)
      EXPECT_EQ(merged.others[w].left[n].observer_um, whole.others[w].left[n].observer_um);
  }
  ASSERT_EQ(merged.tests.size(), whole.tests.size());
  for (std::size_t t = 0; t < whole.tests.size(); ++t)
    EXPECT_EQ(merged.tests[t].left.regression_um, whole.tests[t].left.regression_um);
  // One piece is lost: it alone is worked out again.
  kept.kept.erase(std::prev(kept.kept.end()));
  EXPECT_EQ(place_thermometers(scenario, how, {}, kept.of(""))->tests.back().left.observer_um,
            whole.tests.back().left.observer_um);
  EXPECT_EQ(kept.n_worked, n_worked + 1);
}

// If one body contains all information, a mounted thermometer there leaves nothing for others.
TEST(Placement, CountsThermometersThatAreThere) {
  const scenarios::Scenario scenario = scenario_of(kTwoBodies);
  const Placement p = *place_thermometers(scenario, {.n = 1, .n_most = 1, .mounted = {"t_head"}}, {});
  const std::vector<int>& set = p.chosen.sets.front();
  ASSERT_EQ(set.size(), 2u);
  EXPECT_EQ(p.spots[static_cast<std::size_t>(set[0])].sensor, "t_head");
  EXPECT_EQ(p.spots[static_cast<std::size_t>(set[1])].region, "base");
  EXPECT_THAT(p.names, ElementsAre("p1"));
}

TEST(Placement, RefusesWhatTheMachineHasNot) {
  const scenarios::Scenario scenario = scenario_of(kTwoBodies);
  const auto refused = [&](const PlacementOptions& options) {
    return [&, options] { (void)place_thermometers(scenario, options, {}); };
  };
  EXPECT_THAT(refused({.n = 1, .where = {.regions = {"haed"}}}),
              ThrowsMessage<InputError>(HasSubstr(
                  "--region 'haed': the machine has no such lumped node; there are head, base. Did you mean 'head'?")));
  EXPECT_THAT(refused({.n = 1, .where = {.excluded = {"bse"}}}), ThrowsMessage<InputError>(HasSubstr("--exclude 'bse'")));
  EXPECT_THAT(refused({.n = 1, .where = {.excluded = {"head", "base"}}}),
              ThrowsMessage<InputError>(HasSubstr("no lumped node is left")));
  EXPECT_THAT(refused({.n = 3}),
              ThrowsMessage<InputError>(HasSubstr("3 thermometers are to be placed, and there are 2 places")));
  EXPECT_THAT(refused({.n = 1, .mounted = {"t_haed"}}), ThrowsMessage<InputError>(HasSubstr("Did you mean 't_head'?")));
  EXPECT_THAT(
      refused({.n = 1, .channels = {"nsoe"}}),
      ThrowsMessage<InputError>(HasSubstr("--channel 'nsoe': the machine has no such displacement; there are nose.")));
  EXPECT_THAT(refused({.n = 1, .train = {"job"}, .test = {"job"}}),
              ThrowsMessage<InputError>(HasSubstr("'job' is to be chosen on (--train) and judged by (--test)")));
  EXPECT_THAT(refused({.n = 1, .train = {"jbo"}}), ThrowsMessage<InputError>(HasSubstr("jbo")));
}

// The column is on the floor and carries the head. Its foot, its top and the part of the head on it cannot be reached; the
// rest of the head's bottom is visible from below.
TEST(Reach, EndsAtTheFloorAndAtJoints) {
  const mesh::Mesh mesh = fixtures::column_and_head();
  const std::vector<bool> reached = mesh::reachable_nodes(mesh, mesh::skin_of(mesh));
  const int n_column =
      mesh.cells.nodes(mesh.cells_in(mesh.region("head")).front())[0];  // nodes of the head come after those of the column
  int n_seen = 0, n_hidden = 0;
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const Eigen::Vector3d x = mesh.coords.col(node);
    const bool in_plan =
        x.x() > 1e-6 && x.x() < 0.1 - 1e-6 && x.y() > 1e-6 && x.y() < 0.1 - 1e-6;  // of the column, not on its sides
    const bool is_head = node >= n_column;
    if (in_plan && (x.z() < 1e-6 || (std::abs(x.z() - 0.3) < 1e-6) || (!is_head && x.z() < 0.3))) {
      EXPECT_FALSE(reached[static_cast<std::size_t>(node)]) << x.transpose();
      ++n_hidden;
    }
    const bool on_side = std::abs(x.x()) < 1e-6 && x.z() > 0.05 && x.z() < 0.25 && x.y() > 0.02 && x.y() < 0.08;
    const bool on_top = x.z() > 0.4 - 1e-6, below = is_head && std::abs(x.z() - 0.3) < 1e-6 && x.y() > 0.12;
    if (on_side || on_top || below) {
      EXPECT_TRUE(reached[static_cast<std::size_t>(node)]) << x.transpose();
      ++n_seen;
    }
  }
  EXPECT_GT(n_seen, 20);
  EXPECT_GT(n_hidden, 10);
}

// Points avoid excluded regions, and their temperatures are those that the written scenario simulates there. A thermometer
// that may be anywhere gives at least as much information.
TEST(Placement, OnAMeshIsWrittenAsSensorsThatReadWhatWasForetold) {
  const std::filesystem::path folder = fresh_folder("placed");
  fixtures::ColumnAndHead machine;
  machine.cyclograms = "{cycle: [[40 min, 1000 rpm], [20 min, 0 rpm], [30 min, 600 rpm]], slow: [[90 min, 400 rpm]]}";
  const std::string path = fixtures::write_column_and_head(folder, machine);
  const scenarios::Scenario scenario = scenarios::read_scenario(path);
  const Placement anywhere = *place_thermometers(scenario, {.n = 2, .n_most = 2, .where = {.n_points = 60}}, {});
  const Placement p =
      *place_thermometers(scenario, {.n = 2, .n_most = 2, .where = {.excluded = {"head"}, .n_points = 60}}, {});
  EXPECT_THAT(anywhere.regions, UnorderedElementsAre("column", "head"));
  EXPECT_LE(anywhere.objective_um[1], p.objective_um[1] * (1.0 + 1e-9));
  std::vector<std::string> entries;
  for (std::size_t i = 0; i < 2; ++i) {
    const Spot& spot = p.spots[static_cast<std::size_t>(p.chosen.sets[1][i])];
    EXPECT_EQ(spot.region, "column");
    entries.push_back(sensor_entry(p.names[i], spot));
  }
  ASSERT_EQ(p.told_um.size(), p.mesh.n_nodes());
  for (Eigen::Index node = 0; node < p.told_um.size(); ++node) {  // the column alone is coloured
    const Eigen::Vector3d x = p.mesh.coords.col(node);
    if (x.z() > 0.3 + 1e-6) {
      EXPECT_TRUE(std::isnan(p.told_um[node])) << x.transpose();
    } else if (x.z() < 0.3 - 1e-6 && x.x() < 1e-6) {
      EXPECT_LE(p.told_um[node], p.told_nothing_um) << x.transpose();
    }
  }
  const std::string written = (folder / "placed.yaml").string();
  write_file("placed/placed.yaml", with_sensors(path, entries, {"placed"}));
  const scenarios::Scenario placed = scenarios::read_scenario(written);
  EXPECT_EQ(placed.machine->sensors.size(), scenario.machine->sensors.size() + 2);
  const PlacementModel model = model_of(scenario, {.n_points = 60});
  const scenarios::Model again = scenarios::open_model(placed, {}, {}, false);
  const std::vector<scenarios::SimulatedRun> runs =
      scenarios::simulate_cyclograms(placed, again, {&placed.cyclogram("cycle")}, {});
  MachineRun run = scenarios::felt_run(*scenario.machine, scenario.cyclogram("cycle"));
  run.readings.time_s = runs[0].record.time_s;
  const Eigen::MatrixXd states = states_of(model, model.system, run);
  for (std::size_t i = 0; i < 2; ++i) {
    const int node = p.spots[static_cast<std::size_t>(p.chosen.sets[1][i])].node;
    const Eigen::VectorXd foretold =
        states.transpose() * model.opened.reduced()->temperature.row(node).cast<double>().transpose();
    const std::vector<double>& simulated = runs[0].record.at(p.names[i]).values;
    for (std::size_t k = 0; k < simulated.size(); ++k)
      EXPECT_NEAR(20.0 + foretold[static_cast<Eigen::Index>(k)], simulated[k], 0.03) << k;
  }
}

TEST(Placement, OfAMachineAtAPoseIsWrittenAsDrawn) {
  fixtures::ColumnAndHead machine;
  machine.more = "axes: {y: {moves: [head], along: y, range: [0 mm, 50 mm], at: 50 mm}}\n";
  const scenarios::Scenario scenario =
      scenarios::read_scenario(fixtures::write_column_and_head(fresh_folder("placed_at_a_pose"), machine));
  int n_of_head = 0;
  for (const Spot& spot : model_of(scenario, {.n_points = 30}).spots) {
    if (spot.region != "head") continue;
    ++n_of_head;
    EXPECT_GE(spot.at_m.y(), -1e-9);
    EXPECT_LE(spot.at_m.y(), 0.2 + 1e-9) << "the head was drawn over 200 mm";
  }
  EXPECT_GE(n_of_head, 12);
}

TEST(PlacedSensors, AreWrittenIntoAFileWhosePathsStandInQuotes) {
  const auto folder = fresh_folder("placed_quoted");
  const std::string text =
      "machine: {mesh: \"a machine.step\"}\nsensors:\n  - {name: t, node: 'a # b'}   # the first\ncyclograms: {c: {csv: "
      "'run.csv'}}\n";
  EXPECT_EQ(with_sensors(write_file("placed_quoted/a.yaml", text), {"{name: p1, node: a}"}, {}),
            fmt::format("machine: {{mesh: \"{0}/a machine.step\"}}\nsensors:\n  - {{name: t, node: 'a # b'}}   # the "
                        "first\n  - {{name: p1, node: a}}   # placed\n"
                        "cyclograms: {{c: {{csv: \"{0}/run.csv\"}}}}\n",
                        folder.string()));
  const std::string aliased =
      write_file("placed_quoted/b.yaml", "of: &x run.csv\nsensors: []\ncyclograms:\n  c: {csv: *x}\n");
  EXPECT_REFUSED(with_sensors(aliased, {"{name: p1, node: a}"}, {}), "b.yaml:1:", "give it as an absolute one");
}

TEST(PlacementTests, OfEquallyGoodTheShortestIsEnough) {
  const std::vector<TriedTest> tests = {
      {"a", 3600.0, {1.0, 5.0}}, {"b", 7200.0, {1.05, 2.1}}, {"c", 7200.0, {1.3, 2.05}}, {"d", 14400.0, {0.97, 2.0}}};
  EXPECT_EQ(least_test(tests, &Residual::observer_um), 0);
  EXPECT_EQ(least_test(tests, &Residual::regression_um), 2);
  EXPECT_EQ(least_test({}, &Residual::observer_um), -1);
  for (const Cyclogram& c : possible_tests({Drive{.speed_rpm = 500.0}, Drive{.speed_rpm = 1000.0}}))
    EXPECT_GT(c.duration_s(), 3599.0) << c.name;
}

}  // namespace
}  // namespace driftwright::studies::placement_test
