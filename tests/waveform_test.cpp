// Which heat is missing, row by row, what it looks like, and that windows which come again are one cause.

#include "diagnosis/waveform.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "diagnosis/extended_scenario.hpp"
#include "tests/lumped_records.hpp"

namespace driftwright::diagnosis::waveform_test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A heated box: heater, air, a wall that only its air touches.
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
ambient: [[0 h, 21 degC]]
sensors:
  - {name: inside, node: air}
  - {name: wall, node: wall}
displacements:
  - name: lift
    sensitivities:
      - {node: wall, sensitivity: 2 um/K}
cyclograms:
  day: [[4 min, 1000 rpm], [3 min, 0 rpm], [8 min, 1000 rpm], [5 min, 0 rpm], [10 min, 1000 rpm], [4 min, 0 rpm], [6 min, 1000 rpm]]
solver: {output_interval: 15 s}
)";
constexpr double kRow_s = 15.0, kNoise_K = 0.03, kNoise_um = 0.1;

std::string box_with(const std::string& entry) {
  return with_effect(kBox, entry);
}
std::vector<std::string> record(const std::string& path) {
  return noisy_records(path, "box_", kRow_s, kNoise_K, kNoise_um);
}

/// What the scenario as written misses.
std::vector<Waveform> waves_beside(const Beside& beside) {
  const Twin& twin = *beside.twin;
  Twin::Workspace space(twin);
  const MeasuredRun& run = beside.runs[0];
  return waveforms(twin, beside.runs, twin.as_written(),
                   {twin.read(twin.as_written(), run, twin.respond(twin.as_written(), run, space))});
}
std::vector<Waveform> waves_of(const std::string& entry) {
  const std::vector<std::string> truth = record(write_file("truth.yaml", box_with(entry)));
  return waves_beside(Beside(write_file("plain.yaml", box_with("")), truth));
}

constexpr const char* kLids =
    "{type: exchange_window, node: air, conductance: 15 W/K, windows: [[10 min, 11 min], [20.5 min, 21.5 min], [33 min, 34 "
    "min]]}";

TEST(AWaveform, ShowsLidsAsWindowsOfOneConductanceToTheAmbient) {
  const std::vector<Waveform> list = waves_of(kLids);
  ASSERT_FALSE(list.empty());
  const Waveform& w = list.front();
  EXPECT_EQ(w.where, "air");
  EXPECT_EQ(w.to, "ambient");
  EXPECT_EQ(w.shape.shape, Shape::kWindows);
  EXPECT_GT(w.explained, 0.99);
  EXPECT_NEAR(w.shape.size, 15.0, 3.0);  // K over a minute in which the air's time constant is 13 s, at rows of 15 s
  ASSERT_THAT(w.shape.windows_s, SizeIs(3));
  const std::vector<std::pair<double, double>> truth = {{600.0, 660.0}, {1230.0, 1290.0}, {1980.0, 2040.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(w.shape.windows_s[i].first, truth[i].first, kRow_s);
    EXPECT_NEAR(w.shape.windows_s[i].second, truth[i].second, kRow_s);
  }
}

TEST(AWaveform, ShowsNothingWhereNothingIsMissing) {
  for (const Waveform& w : waves_of("")) EXPECT_EQ(w.shape.shape, Shape::kNothing) << w.where << " " << word(w.shape.shape);
}

TEST(AWaveform, ShowsHeatThatIsConstantFromATimeOnOrFollowsSpeed) {
  const Waveform late = waves_of("{type: heat_source, node: wall, power: 12 W, from: 15 min}").front();
  EXPECT_EQ(late.where, "wall");
  EXPECT_EQ(late.shape.shape, Shape::kStep);
  EXPECT_NEAR(late.shape.time_s, 900.0, 60.0);
  EXPECT_NEAR(late.shape.size, 12.0, 1.5);
  EXPECT_EQ(late.to, "");
  const Waveform driven = waves_of("{type: heat_source, node: wall, power: 12 W, at_speed: 1000 rpm, exponent: 1}").front();
  EXPECT_EQ(driven.where, "wall");
  EXPECT_EQ(driven.shape.shape, Shape::kProportional);
  EXPECT_EQ(driven.shape.follows, "speed");
  EXPECT_NEAR(driven.shape.size, 0.012, 0.002);
}

TEST(AWaveform, ShowsWhatADisplacementFollowsBeside) {
  // The lift follows the air, too, which is measured; written is the wall alone.
  std::string truth = kBox;
  truth.replace(truth.find("{node: wall, sensitivity: 2 um/K}"), 33,
                "{node: wall, sensitivity: 2 um/K}\n      - {node: air, sensitivity: 1 um/K}");
  const Beside beside(write_file("plain.yaml", kBox), record(write_file("truth.yaml", truth)));
  const std::vector<Waveform> list = waves_beside(beside);
  const auto lift = std::find_if(list.begin(), list.end(), [](const Waveform& w) { return w.where == "lift"; });
  ASSERT_NE(lift, list.end());
  EXPECT_EQ(lift->of, Waveform::Of::kGrowth);
  EXPECT_EQ(lift->shape.shape, Shape::kProportional);
  EXPECT_THAT(lift->shape.follows, ::testing::AnyOf("mean of air", "inside"));
  EXPECT_NEAR(lift->shape.size, 1e-6, 0.05e-6);
  EXPECT_GT(lift->explained, 0.95);
}

TEST(Lids, AreOneCauseThatIsWrittenAndReadBack) {
  const std::vector<std::string> measured = record(write_file("truth.yaml", box_with(kLids)));
  const Beside beside(write_file("plain.yaml", box_with("")), measured);
  const Diagnosis d = beside.diagnosed();
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "exchange_window");
  EXPECT_EQ(d.causes[0].where, "air");
  EXPECT_NEAR(d.causes[0].parameters[0].value, 15.0, 2.0);
  EXPECT_FALSE(d.waveforms.empty());
  const Claim& claim = d.search.hypothesis[0];
  const Eigen::VectorXd x = d.search.fit.x.tail(static_cast<Eigen::Index>(claim.knobs.size()));
  const ExtendedScenario extended =
      extended_scenario(beside.scenario, *beside.twin, beside.runs, {{"it", "because", change_of(claim, x)}}, {});
  EXPECT_THAT(extended.not_written, IsEmpty());
  const Beside again(write_file("extended.yaml", extended.text), measured);
  double most_before = 0.0;
  for (const Waveform& w : waves_beside(beside)) most_before = std::max(most_before, w.log_likelihood_gain);
  EXPECT_GT(most_before, 1000.0);
  for (const Waveform& w : waves_beside(again))
    EXPECT_LT(w.log_likelihood_gain, 0.2 * most_before)
        << w.where;  // the claim alone is written here, not the numbers beside it
}

// Shapes by themselves.

struct Drawn {
  std::vector<double> edge_s;
  Eigen::VectorXd value, sd;
  explicit Drawn(const std::function<double(double)>& course) : value(200), sd(Eigen::VectorXd::Constant(200, 0.2)) {
    Random random(1, 0);
    for (int i = 0; i <= 200; ++i) edge_s.push_back(30.0 * i);
    for (int i = 0; i < 200; ++i) value[i] = course(30.0 * i + 15.0) + 0.2 * random.normal();
  }
  [[nodiscard]] WaveShape shape(const std::vector<NamedCourse>& courses = {}) const {
    return shape_of(edge_s, value, sd, {}, courses);
  }
};

TEST(AShape, IsToldFromOthers) {
  const WaveShape constant = Drawn([](double) { return 5.0; }).shape();
  EXPECT_EQ(constant.shape, Shape::kConstant);
  EXPECT_NEAR(constant.size, 5.0, 0.1);
  const WaveShape step = Drawn([](double t_s) { return t_s > 2400.0 ? 4.0 : 1.0; }).shape();
  EXPECT_EQ(step.shape, Shape::kStep);
  EXPECT_NEAR(step.size, 3.0, 0.1);
  EXPECT_NEAR(step.time_s, 2400.0, 30.0);
  const WaveShape decay =
      Drawn([](double t_s) { return t_s > 1800.0 ? -6.0 * std::exp(-(t_s - 1800.0) / 600.0) : 0.0; }).shape();
  EXPECT_EQ(decay.shape, Shape::kDecay);
  EXPECT_NEAR(decay.time_s, 1800.0, 90.0);
  EXPECT_LT(decay.size, 0.0);
  const WaveShape wave = Drawn([](double t_s) { return 3.0 * std::sin(2.0 * std::numbers::pi * t_s / 750.0); }).shape();
  EXPECT_EQ(wave.shape, Shape::kPeriodic);
  EXPECT_NEAR(wave.period_s, 750.0, 20.0);
  EXPECT_NEAR(wave.size, 3.0, 0.2);
  const auto is_open = [](double t_s) { return (t_s > 900.0 && t_s < 1200.0) || (t_s > 3000.0 && t_s < 3600.0); };
  const WaveShape windows = Drawn([&](double t_s) { return is_open(t_s) ? 4.0 : 0.0; }).shape();
  EXPECT_EQ(windows.shape, Shape::kWindows);
  ASSERT_THAT(windows.windows_s, SizeIs(2));
  EXPECT_NEAR(windows.windows_s[0].first, 900.0, 30.0);
  EXPECT_NEAR(windows.windows_s[1].second, 3600.0, 30.0);
  EXPECT_NEAR(windows.size, 4.0, 0.2);
  NamedCourse sun{"sun", "W/m^2", Eigen::VectorXd(200)};
  for (int i = 0; i < 200; ++i) sun.value[i] = std::pow(std::sin(0.05 * i), 2) * (i % 7);
  const Drawn drawn([&](double t_s) { return 0.7 * sun.value[static_cast<Eigen::Index>(t_s / 30.0)]; });
  const WaveShape follows = drawn.shape({sun});
  EXPECT_EQ(follows.shape, Shape::kProportional);
  EXPECT_EQ(follows.follows, "sun");
  EXPECT_NEAR(follows.size, 0.7, 0.02);
  EXPECT_EQ(Drawn([&](double t_s) {
              double sum = 0.0;
              for (const double period_s : {2111.0, 1523.0, 1171.0, 911.0, 677.0, 541.0})
                sum += std::sin(2.0 * std::numbers::pi * t_s / period_s + period_s);
              return sum;
            })
                .shape()
                .shape,
            Shape::kOther);
}

}  // namespace
}  // namespace driftwright::diagnosis::waveform_test
