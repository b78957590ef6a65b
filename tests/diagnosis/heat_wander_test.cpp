// Where a model errs: which body gets unknown heat, how much, and that readings bent by it weigh as their covariance says.

#include "diagnosis/heat_wander.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "diagnosis/scatter.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::heat_wander_test {
namespace {

constexpr const char* kBox = R"(name: box
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: heater, capacity: 240 J/K}
  - {type: node, node: air, capacity: 200 J/K}
  - {type: node, node: wall, capacity: 900 J/K}
  - {type: heat_source, node: heater, power: 40 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: heater, to: air, conductance: 2.3 W/K}
  - {type: link, node: air, to: wall, conductance: 3 W/K}
  - {type: link, node: air, to: ambient, conductance: 0.8 W/K}
  - {type: link, node: wall, to: ambient, conductance: 0.5 W/K}
ambient: [[0 h, 21 degC]]
sensors:
  - {name: heater, node: heater}
  - {name: inside, node: air}
  - {name: wall, node: wall}
displacements:
  - name: lift
    sensitivities:
      - {node: wall, sensitivity: 2 um/K}
cyclograms:
  day: [[40 min, 1000 rpm], [30 min, 0 rpm], [80 min, 1000 rpm], [50 min, 0 rpm], [100 min, 1000 rpm]]
solver: {output_interval: 60 s}
)";
// Heat in the wall that comes and goes: 8, -5, 12, -9 and 6 W, an hour each; RMS 8.4 W.
constexpr const char* kComesAndGoes =
    "{type: heat_window, node: wall, power: 8 W, windows: [[0 min, 60 min]]}\n"
    "  - {type: heat_window, node: wall, power: -5 W, windows: [[60 min, 120 min]]}\n"
    "  - {type: heat_window, node: wall, power: 12 W, windows: [[120 min, 180 min]]}\n"
    "  - {type: heat_window, node: wall, power: -9 W, windows: [[180 min, 240 min]]}\n"
    "  - {type: heat_window, node: wall, power: 6 W, windows: [[240 min, 300 min]]}";
constexpr double kNoise_K = 0.03, kNoise_um = 0.1;

std::optional<HeatWander> wander_of(const std::string& truth) {
  const std::vector<std::string> records = noisy_records(write_file("truth.yaml", with_effect(kBox, truth)), "box_",
                                                         {.noise_K = kNoise_K, .noise_um = kNoise_um});
  const Beside beside(write_file("plain.yaml", kBox), records);
  Fitter fitter(*beside.twin, beside.runs, scatter(*beside.twin), {});
  const NoiseModel kelvin{kNoise_K, 0.0, 0.0};
  fitter.set_noise({{"heater", kelvin}, {"inside", kelvin}, {"wall", kelvin}, {"lift", {1e-6 * kNoise_um, 0.0, 0.0}}});
  Twin::Workspace workspace(*beside.twin);
  return heat_wander(fitter, beside.twin->as_written(),
                     fitter.predict({}, Eigen::VectorXd::Zero(fitter.n_nuisance()), workspace), workspace);
}

TEST(HeatWander, IsInTheBodyThatWasHeatedAndAsLarge) {
  const std::optional<HeatWander> wander = wander_of(kComesAndGoes);
  ASSERT_TRUE(wander);
  EXPECT_EQ(wander->bodies.front().body.name, "wall");
  EXPECT_GT(wander->bodies.front().share, 0.8);
  EXPECT_GT(wander->bodies.front().sd_W, 8.4 / 1.7);
  EXPECT_LT(wander->bodies.front().sd_W, 8.4 * 1.7);
}

// Knots are 13 min apart. For heat that changes sign every 7 min the result is the shortest correlation time that is tried;
// for heat that is constant for all five hours it is the longest.
TEST(HeatWander, SaysWhereItsTimeIsAnEndOfThoseTried) {
  std::string fast;
  for (int i = 0; i < 20; ++i)
    fast += fmt::format("{}{{type: heat_window, node: wall, power: {} W, windows: [[{} min, {} min]]}}",
                        i == 0 ? "" : "\n  - ", i % 2 == 0 ? 30 : -30, 15 * i, 15 * i + 7);
  const std::optional<HeatWander> quick = wander_of(fast);
  ASSERT_TRUE(quick);
  EXPECT_EQ(quick->limit, HeatWander::Limit::kAtMost) << quick->time_s;
  const std::optional<HeatWander> slow = wander_of("{type: heat_source, node: wall, power: 12 W, exponent: 0}");
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->limit, HeatWander::Limit::kAtLeast) << slow->time_s;
}

TEST(HeatWander, IsHardlyAnyWhereNothingIsMissing) {
  const std::optional<HeatWander> wander = wander_of("");
  if (!wander) return;
  for (const BodyWander& b : wander->bodies) EXPECT_LT(b.sd_W, 0.2) << b.body.name;
}

TEST(AComparison, WhitensWhatChannelsShare) {
  MeasuredRun run;
  run.name = "run";
  run.time_s = {0.0, 60.0, 120.0, 180.0, 240.0};
  const Eigen::VectorXd there = Eigen::VectorXd::Zero(5);
  Eigen::VectorXd with_a_gap = there;
  with_a_gap[2] = std::nan("");
  run.channels = {{.name = "a", .output = 0, .unit = "K", .value = there},
                  {.name = "b", .output = 1, .unit = "K", .value = with_a_gap}};
  const std::map<std::string, NoiseModel> noise = {{"a", {0.5, 0.3, 100.0}}, {"b", {2.0, 0.0, 0.0}}};
  Random random(3, 0);
  Eigen::MatrixXd root(10, 3);
  for (double& v : root.reshaped()) v = random.normal();
  const Comparison comparison({run}, noise, {root});
  const std::vector<Eigen::Index> rows = {0, 1, 2, 3, 4, 5, 6, 8, 9};  // without the gap
  Eigen::MatrixXd w(9, 9), covariance(9, 9);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Eigen::MatrixXd one = Eigen::MatrixXd::Zero(2, 5);
    one(rows[i] / 5, rows[i] % 5) = 1.0;
    w.col(static_cast<Eigen::Index>(i)) = comparison.whitened({one});
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const Eigen::Index a = rows[i], b = rows[j];
      double own = 0.0;
      if (a < 5 && b < 5) own = 0.3 * 0.3 * std::exp(-60.0 * static_cast<double>(std::abs(a - b)) / 100.0);
      if (a == b) own += a < 5 ? 0.25 : 4.0;
      covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = own + root.row(a).dot(root.row(b));
    }
  }
  EXPECT_LT((w * covariance * w.transpose() - Eigen::MatrixXd::Identity(9, 9)).cwiseAbs().maxCoeff(), 1e-10);
}

}  // namespace
}  // namespace driftwright::diagnosis::heat_wander_test
