// What is missing in words of the grammar: columns are what the machine does, evidence is what its formula says, and what
// is hidden is stated.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "diagnosis/inquiry.hpp"
#include "diagnosis/naming.hpp"
#include "diagnosis/scatter.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::statements_test {
namespace {

constexpr RecordNoise kNoise{.noise_K = 0.05};

/// A feed axis with its screw in five sections, whose error is read at two places, at the nut, and by a scale.
constexpr const char* kAxis = R"(name: axis
reference_temperature: 20 degC
start: ambient
machine: {generator: lumped}
effects:
  - {type: node, node: nut, capacity: 2.6 kJ/K}
  - {type: node, node: fixed, capacity: 3.3 kJ/K}
  - {type: node, node: far, capacity: 1.2 kJ/K}
  - {type: node, node: bed, capacity: 25 kJ/K}
  - {type: node, node: glass, capacity: 0.9 kJ/K}
  - {type: feed_axis, node: nut, screw: s, axis: x, position: position_x, stroke: stroke_x, mounting: fixed_supported, travel: 800 mm, fixed_gap: 140 mm, far_gap: 160 mm, section_length: 220 mm, diameter: 38 mm, lead: 20 mm, nut_length: 120 mm, torque: 1.2 N m, nut_conductance: 4 W/K, fixed_bearing: fixed, fixed_conductance: 3 W/K, far_bearing: far, far_conductance: 1.5 W/K}
  - {type: servo_loss, node: fixed, axis: x, power: 25 W, at_feed: 15 m/min}
  - {type: link, node: nut, to: bed, conductance: 9 W/K}
  - {type: link, node: fixed, to: bed, conductance: 12 W/K}
  - {type: link, node: far, to: bed, conductance: 8 W/K}
  - {type: link, node: glass, to: bed, conductance: 0.7 W/K}
  - {type: link, node: glass, to: ambient, conductance: 0.4 W/K}
  - {type: link, node: bed, to: ambient, conductance: 8 W/K}
  - {type: linear_scale, displacement: by_scale, body: glass, expansion: 8e-6 1/K, fixed_at: 400 mm, position: position_x}
ambient: [[0 min, 20 degC], [100 min, 21 degC], [300 min, 20.5 degC]]
sensors:
  - {name: t_nut, node: nut}
  - {name: t_fixed, node: fixed}
  - {name: t_far, node: far}
  - {name: t_bed, node: bed}
  - {name: t_glass, node: glass}
displacements:
  - {name: x, screw: s, at: [0 mm, 800 mm]}
  - {name: at_nut, screw: s}
  - {name: by_scale, sensitivities: [{node: bed, sensitivity: 0.3 um/K}]}
cyclograms:
  parts:
    columns: [duration, feed_x, position_x_mm, stroke_x_mm]
    rows: [[40 min, 15 m/min, 400 mm, 800 mm], [30 min, 0 m/min, 400 mm, 0 mm], [50 min, 10 m/min, 650 mm, 200 mm], [40 min, 6 m/min, 200 mm, 300 mm], [30 min, 0 m/min, 200 mm, 0 mm]]
solver: {output_interval: 2 min}
)";
constexpr RecordNoise kAxisNoise{.row_s = 120.0, .noise_K = 0.05, .noise_um = 1.0};

/// A fitter of the scenario's numbers beside records, its noise known.
struct Ground {
  std::unique_ptr<Fitter> fitter;

  explicit Ground(const Beside& b, const RecordNoise& as = kNoise) {
    std::vector<Knob> numbers = scatter(*b.twin);
    for (Knob& k : ambient_scatter(b.runs)) numbers.push_back(std::move(k));
    fitter = std::make_unique<Fitter>(*b.twin, b.runs, numbers,
                                      unknown_columns(*b.twin, nullptr, 1.0, b.runs, b.twin->as_written()));
    std::map<std::string, NoiseModel> noise;
    for (const MeasuredRun& run : b.runs) {
      for (const MeasuredChannel& c : run.channels)
        noise[c.name] = {.white = c.unit == "K" ? as.noise_K : 1e-6 * as.noise_um};
    }
    fitter->set_noise(noise);
  }
  [[nodiscard]] Posterior stated() const {
    Twin::Workspace workspace(fitter->twin());
    const Fit fit = fitter->fit({}, Eigen::VectorXd(0), workspace);
    fitter->settle({}, fit);
    return StatedBeside(*fitter, {}, fit).posterior({});
  }
};

std::string first(const Posterior& p) {
  if (p.stated.empty()) return "nothing";
  std::string words = std::string(word(p.stated[0].says.quantity)) + " ";
  for (const std::string& place : p.stated[0].says.place) words += place + " ";
  return words + p.stated[0].says.follows;
}

/// Records of a machine that has one effect more than the scenario.
Posterior stated_of(const std::string& hidden, const std::string& prefix, std::uint64_t seed = 5) {
  const std::string scenario = write_file("plain.yaml", kTwoNodes);
  RecordNoise noise = kNoise;
  noise.seed = seed;
  const Beside beside(scenario, noisy_records(write_file("truth.yaml", with_effect(kTwoNodes, hidden)), prefix, noise));
  return Ground(beside).stated();
}

class ColumnTest : public testing::Test {
 protected:
  explicit ColumnTest(const char* machine = kTwoNodes)
      : path_(write_file("plain.yaml", machine)),
        beside_(path_, noisy_records(path_, "column_", kNoise)),
        ground_(beside_),
        space_(*ground_.fitter, beside_.twin->as_written()) {}

  /// Largest difference between a column and what a little of an effect does to the twin's readings, over the largest of
  /// that.
  double misses(const effects::Effect& effect, double amount, const std::function<bool(const Statement&)>& is_it) {
    const Twin& twin = *beside_.twin;
    Twin::Workspace workspace(twin);
    TwinState state = twin.as_written();
    state.push_back(effect);
    for (std::size_t i = 0; i < space_.columns.size(); ++i) {
      const Statement& says = space_.columns[i].says;
      if (!is_it(says)) continue;
      const std::vector<Eigen::MatrixXd> of =
          space_.readings({{.index = i,
                            .amount = std::vector<Eigen::VectorXd>(beside_.runs.size(),
                                                                   Eigen::VectorXd::Constant(1, amount / says.unit_size))}});
      double largest = 0.0, miss = 0.0;
      for (std::size_t r = 0; r < beside_.runs.size(); ++r) {
        const MeasuredRun& run = beside_.runs[r];
        const Eigen::MatrixXd with = twin.readings(state, run, workspace),
                              without = twin.readings(twin.as_written(), run, workspace);
        for (std::size_t c = 0; c < run.channels.size(); ++c) {
          const double scale = run.channels[c].unit == "K" ? 1.0 : 1e6;
          const Eigen::RowVectorXd is = scale * (with - without).row(run.channels[c].output);
          largest = std::max(largest, is.cwiseAbs().maxCoeff());
          miss = std::max(miss, (scale * of[r].row(static_cast<Eigen::Index>(c)) - is).cwiseAbs().maxCoeff());
        }
      }
      return miss / largest;
    }
    ADD_FAILURE() << "no such column";
    return 1.0;
  }

  std::string path_;
  Beside beside_;
  Ground ground_;
  StatementSpace space_;
};

TEST_F(ColumnTest, OfHeatIsWhatTheMachineDoes) {
  const auto at = [](const char* follows) {
    return [follows](const Statement& s) {
      return s.quantity == StatedQuantity::kHeat && s.place[0] == "column" && s.follows == follows;
    };
  };
  EXPECT_LT(misses(effects::make_effect("heat_source", effects::node("column"), {{"power", 5.0}}), 5.0, at("constant")),
            1e-3);
}

TEST_F(ColumnTest, OfAnExchangeIsWhatALittleOfItDoes) {
  effects::Effect link = effects::make_effect("link", effects::node("head"), {{"conductance", 0.01}});
  link.references["to"] = effects::ambient_node();
  EXPECT_LT(misses(link, 0.01,
                   [](const Statement& s) {
                     return s.quantity == StatedQuantity::kExchange &&
                            s.place == std::vector<std::string>{"head", "ambient"} && s.follows == "constant";
                   }),
            5e-3);
}

TEST_F(ColumnTest, OfAnAmbientIsWhatAnOffsetDoes) {
  EXPECT_LT(misses(effects::make_effect("ambient", effects::Place::kAmbient, effects::kAmbientName, {{"offset", 1.0}}), 1.0,
                   [](const Statement& s) { return s.quantity == StatedQuantity::kAmbient && s.follows == "constant"; }),
            1e-3);
}

class AxisColumnTest : public ColumnTest {
 protected:
  AxisColumnTest() : ColumnTest(kAxis) {}
};

// What a displacement reads at the recorded position of an axis is part of the machine's answer.
TEST_F(AxisColumnTest, OfHeatInASectionMovesTheNutWhereItIs) {
  EXPECT_LT(misses(effects::make_effect("heat_source", effects::node("s_2"), {{"power", 5.0}}), 5.0,
                   [](const Statement& s) {
                     return s.quantity == StatedQuantity::kHeat && s.place[0] == "s_2" && s.follows == "constant";
                   }),
            5e-3);
}

/// log N(r; 0, 1 + A A' + w² x x') - log N(r; 0, 1 + A A'), by the covariances themselves.
TEST_F(ColumnTest, EvidenceIsThatOfTheGaussian) {
  StatementOptions one_width;
  one_width.widths = {0.7};
  Random random(11, 0);
  const Eigen::Index n = space_.rows.back().first + space_.rows.back().n;
  Eigen::VectorXd r(n);
  Eigen::MatrixXd a(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    r[i] = 2.0 * random.normal();
    for (Eigen::Index k = 0; k < 3; ++k) a(i, k) = random.normal();
  }
  const StatementEvidence evidence(space_, one_width, r, a);
  const auto log_normal = [&](const Eigen::MatrixXd& covariance) {
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    const Eigen::MatrixXd l = factor.matrixL();
    return -0.5 * factor.solve(r).dot(r) - l.diagonal().array().log().sum();
  };
  const Eigen::MatrixXd noise = Eigen::MatrixXd::Identity(n, n) + a * a.transpose();
  std::vector<Item> set;
  double before = log_normal(noise);
  Eigen::MatrixXd covariance = noise;
  for (const std::size_t which : {std::size_t{0}, std::size_t{40}}) {  // alone, then on top of the first
    const Scored s = evidence.scored(set)[which];
    ASSERT_EQ(s.when, When::kGiven);
    set.push_back(evidence.item(s));
    covariance += 0.49 * set.back().columns.x * set.back().columns.x.transpose();
    const double now = log_normal(covariance);
    EXPECT_NEAR(s.log_evidence, now - before, 1e-6 * std::abs(now));
    before = now;
  }
}

TEST(Statements, NothingIsStatedOfAMachineThatIsAsTheScenarioSays) {
  int n_silent = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) n_silent += stated_of("", "none_", seed).nothing > 0.5;
  EXPECT_EQ(n_silent, 8);
}

TEST(Statements, SayQuantityPlaceAndWhatItFollows) {
  const std::vector<std::pair<std::string, std::string>> hidden = {
      {"{type: heat_source, node: column, power: 12 W, runs: while_spindle_turns}", "heat column running"},
      {"{type: heat_source, node: column, power: 12 W, exponent: 0, from: 100 min, in: tuesday}", "heat column window"},
      {"{type: link, node: head, to: ambient, conductance: 3 W/K}", "exchange head ambient constant"},
      {"{type: sensor_bias, sensor: t_column, bias: 0.6 K}", "reading t_column constant"},
      {"{type: sensor_lag, sensor: t_head, lag: 4 min}", "reading t_head itself before"},
      {"{type: mount_shift, displacement: nose, shift: 3 um, time: 70 min, in: friday}", "displacement nose window"},
      {"{type: clock_offset, offset: 6 min}", "clock clock constant"}};
  for (const auto& [effect, says] : hidden) {
    const Posterior p = stated_of(effect, "hidden_");
    EXPECT_EQ(first(p), says) << effect;
    EXPECT_LT(p.nothing, 0.1) << effect;
    ASSERT_FALSE(p.stated.empty()) << effect;
    EXPECT_GT(p.stated[0].probability, 0.5) << effect;
  }
}

TEST(Statements, SizesHoldTheTruth) {
  const Posterior p = stated_of("{type: heat_source, node: column, power: 12 W, runs: while_spindle_turns}", "size_");
  ASSERT_FALSE(p.stated.empty());
  EXPECT_LT(p.stated[0].low, 12.0);
  EXPECT_GT(p.stated[0].high, 12.0);
}

TEST(Statements, ACourseThatTheCatalogueHasNoWordForIsSaidToFollowNothing) {
  const Posterior p = stated_of("{type: heat_source, node: column, power: 25 W, period: 97 min, until: 400 min}", "wave_");
  ASSERT_FALSE(p.stated.empty());
  EXPECT_EQ(p.stated[0].says.quantity, StatedQuantity::kHeat) << first(p);
  EXPECT_EQ(p.stated[0].says.place, std::vector<std::string>{"column"}) << first(p);
}

// Readings of three thermometers move together by a share of the air: one number says it, at all of them.
TEST(Statements, WhatAllThermometersHaveInCommonIsOneStatement) {
  const Posterior p = stated_of(
      "{type: sensor_place, sensor: t_head, body: ambient, share: 0.12}\n"
      "  - {type: sensor_place, sensor: t_column, body: ambient, share: 0.12}",
      "common_");
  ASSERT_FALSE(p.stated.empty());
  EXPECT_EQ(p.stated[0].says.place, (std::vector<std::string>{"t_head", "t_column"})) << first(p);
  EXPECT_EQ(p.stated[0].says.follows, "difference to ambient");
}

// Faults of a feed axis: a nut heats whatever section it is at, a scale's reference point moves nothing but its reading.
struct AxisFault {
  const char *name, *was, *is;  ///< parts of the scenario's text
  const char *says, *law, *effect;
};
class FaultOfAnAxis : public testing::TestWithParam<AxisFault> {};

TEST_P(FaultOfAnAxis, IsStatedWithItsPlaceAndWhatItFollows) {
  const AxisFault& fault = GetParam();
  std::string truth = kAxis;
  const auto at = truth.find(fault.was);
  ASSERT_NE(at, std::string::npos);
  truth.replace(at, std::string(fault.was).size(), fault.is);
  const std::string name = fault.name;
  const Beside beside(write_file(name + "_plain.yaml", kAxis),
                      noisy_records(write_file(name + "_truth.yaml", truth), name + "_", kAxisNoise));
  const Posterior p = Ground(beside, kAxisNoise).stated();
  EXPECT_EQ(first(p), fault.says);
  EXPECT_LT(p.nothing, 0.1);
  ASSERT_FALSE(p.stated.empty());
  EXPECT_GT(p.stated[0].probability, 0.5);
  EXPECT_THAT(words(p.stated[0].says), testing::HasSubstr(fault.law));
  const auto names = named_by(p, candidates(*beside.twin, beside.runs, {}), *beside.twin, beside.runs, {});
  EXPECT_TRUE(std::any_of(names.begin(), names.end(), [&](const Candidate& c) {
    return c.effect == fault.effect && c.where == p.stated[0].says.place[0];
  })) << fault.effect;
}

INSTANTIATE_TEST_SUITE_P(
    Statements, FaultOfAnAxis,
    ::testing::Values(AxisFault{"a_tight_nut", "torque: 1.2 N m", "torque: 2.4 N m", "heat nut own heat", "at position_x",
                                "feed_axis"},
                      AxisFault{"a_warm_bearing", "ambient: [[",
                                "  - {type: servo_loss, node: far, axis: x, power: 20 W, at_feed: 15 m/min}\nambient: [[",
                                "heat far power of feed_x", "feed_x", "heat_source"},
                      AxisFault{"a_scale_fixed_at_its_end", "fixed_at: 400 mm", "fixed_at: 800 mm",
                                "displacement by_scale temperature of glass", "glass", "linear_scale"}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(Statements, NothingIsStatedOfAnAxisThatIsAsTheScenarioSays) {
  const std::string path = write_file("axis_plain.yaml", kAxis);
  EXPECT_GT(Ground(Beside(path, noisy_records(path, "axis_none_", kAxisNoise)), kAxisNoise).stated().nothing, 0.5);
}

// The course of any shape at the place of a window: more than half of its 25 W in the window, less than half elsewhere.
TEST(Statements, TheCourseAtAPlaceIsWhatActedThere) {
  const Posterior p =
      stated_of("{type: heat_window, node: column, power: 25 W, windows: [[100 min, 160 min]], in: tuesday}", "course_");
  const auto heat = std::find_if(p.stated.begin(), p.stated.end(), [](const Stated& s) {
    return s.says.quantity == StatedQuantity::kHeat && s.says.place == std::vector<std::string>{"column"};
  });
  ASSERT_NE(heat, p.stated.end()) << first(p);
  ASSERT_FALSE(heat->course.empty());
  for (const StatedCourse& c : heat->course) {
    ASSERT_EQ(c.edge_s.size(), c.value.size() + 1);
    for (std::size_t i = 0; i < c.value.size(); ++i) {
      const double begin_min = c.edge_s[i] / 60.0, end_min = c.edge_s[i + 1] / 60.0;
      const bool is_in = c.record.find("tuesday") != std::string::npos;
      const bool is_beside = !is_in || end_min < 95.0 || begin_min > 165.0;
      if (is_in && begin_min > 105.0 && end_min < 155.0) {
        EXPECT_GT(c.value[i], 12.5) << c.record << " " << begin_min;
      } else if (is_beside) {
        EXPECT_LT(std::abs(c.value[i]), 12.5) << c.record << " " << begin_min;
      }
    }
  }
}

// What the catalogue calls a statement: effects of its quantity at its place, and no others.
TEST(Naming, IsByQuantityAndPlace) {
  const auto statement = [](StatedQuantity q, std::vector<std::string> place, std::string follows = "constant") {
    return Statement{
        .quantity = q, .place = std::move(place), .follows = std::move(follows), .law = {}, .in_run = {}, .unit = {}};
  };
  const Statement heat = statement(StatedQuantity::kHeat, {"head"}),
                  path = statement(StatedQuantity::kExchange, {"head", "column"}),
                  swap = statement(StatedQuantity::kReading, {"t_head", "t_column"}, "exchanged"),
                  all = statement(StatedQuantity::kHeat, {"all"});
  EXPECT_TRUE(says(heat, "friction_law", "head"));
  EXPECT_FALSE(says(heat, "friction_law", "column"));
  EXPECT_FALSE(says(heat, "link", "head,ambient"));
  EXPECT_TRUE(says(path, "link", "column,head"));
  EXPECT_FALSE(says(path, "link", "head,base"));
  EXPECT_TRUE(says(swap, "sensor_swap", "t_head,t_column"));
  EXPECT_FALSE(says(swap, "sensor_swap", "t_head,t_base"));
  EXPECT_TRUE(says(all, "run_state", "monday"));
  EXPECT_FALSE(says(heat, "run_state", "monday"));
  EXPECT_TRUE(says(heat, "a_kind_of_somebody_else", "head"));
  EXPECT_TRUE(says(heat, "feed_axis", "head"));
  EXPECT_FALSE(says(path, "feed_axis", "head"));
  EXPECT_TRUE(says(statement(StatedQuantity::kDisplacement, {"nose"}), "linear_scale", "nose"));
}

// A window of a statement becomes a window of the catalogue, at its times; candidates elsewhere are gone.
TEST(Naming, MakesWindowsOfTheCatalogueAtTheTimesOfAStatement) {
  const std::string path = write_file("plain.yaml", kTwoNodes);
  const Beside beside(path, noisy_records(path, "naming_", kNoise));
  Posterior p;
  p.nothing = 0.0;
  p.stated.push_back({.says = {.quantity = StatedQuantity::kHeat,
                               .place = {"column"},
                               .follows = "window",
                               .law = "two windows",
                               .in_run = {1, 0, 0},
                               .windows = {{.run = 0, .begin_s = 1200.0, .end_s = 3000.0, .wide_s = 300.0},
                                           {.run = 0, .begin_s = 6000.0, .end_s = 9000.0, .wide_s = 300.0}},
                               .record = {beside.runs[0].name, beside.runs[1].name, beside.runs[2].name},
                               .unit = "W"},
                      .size = 20.0});
  p.stated.front().windows = {p.stated.front().says, 20.0};
  const std::vector<Candidate> list = named_by(p, candidates(*beside.twin, beside.runs, {}), *beside.twin, beside.runs, {});
  ASSERT_FALSE(list.empty());
  const auto window = std::find_if(list.begin(), list.end(), [](const Candidate& c) { return c.effect == "heat_window"; });
  for (const Candidate& c : list) EXPECT_EQ(c.where, "column") << c.effect;
  ASSERT_NE(window, list.end());
  ASSERT_EQ(window->variants.size(), 1U);
  EXPECT_EQ(window->variants[0].in, beside.runs[0].name);
  EXPECT_EQ(window->variants[0].knobs.size(), 5U);  // size, two begins and ends
  EXPECT_NEAR(window->variants[0].trial_x, 20.0, 1e-9);
}

}  // namespace
}  // namespace driftwright::diagnosis::statements_test
