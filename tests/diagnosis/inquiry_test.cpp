// What is said without some of the rows owes nothing to them: neither noise nor statements, neither priors nor numbers to
// start from.

#include "diagnosis/inquiry.hpp"

#include <gtest/gtest.h>

#include "diagnosis/leftover.hpp"
#include "diagnosis/scatter.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::inquiry_test {
namespace {

constexpr const char* kBox = R"(name: box
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: heater, capacity: 2400 J/K}
  - {type: node, node: wall, capacity: 9000 J/K}
  - {type: heat_source, node: heater, power: 40 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: heater, to: wall, conductance: 3 W/K}
  - {type: link, node: wall, to: ambient, conductance: 1.5 W/K}
ambient: [[0 h, 21 degC]]
sensors:
  - {name: heater, node: heater}
  - {name: wall, node: wall}
cyclograms:
  day: [[60 min, 1000 rpm], [40 min, 0 rpm], [90 min, 1000 rpm], [50 min, 500 rpm]]
  evening: [[50 min, 400 rpm], [70 min, 1000 rpm], [40 min, 0 rpm], [60 min, 800 rpm]]
solver: {output_interval: 60 s}
)";
constexpr double kNoise_K = 0.03;

/// The records, the second with readings of its own where they are spoilt.
class TwoRecords : public testing::Test {
 protected:
  TwoRecords()
      : beside_(write_file("plain.yaml", kBox),
                noisy_records(
                    write_file("truth.yaml", with_effect(kBox, "{type: heat_source, node: wall, power: 4 W, exponent: 0}")),
                    "box_", {.noise_K = kNoise_K, .noise_um = 0.1})) {}

  /// An inquiry about the first record beside a diagnosis of both.
  Inquiry of_the_first(bool is_spoilt) {
    std::vector<MeasuredRun>& runs = is_spoilt ? spoilt_ : beside_.runs;
    if (is_spoilt) {
      spoilt_ = beside_.runs;
      Random random(3, 0);
      for (MeasuredChannel& c : spoilt_[1].channels) {
        for (double& v : c.value) v += 5.0 + 0.5 * random.normal();
      }
    }
    const Twin& twin = *beside_.twin;
    standing_ = candidates(twin, runs, {});
    std::vector<Knob> numbers = scatter(twin);
    for (Knob& k : ambient_scatter(runs)) numbers.push_back(std::move(k));
    fresh_ = std::make_unique<Fitter>(twin, runs, numbers, unknown_columns(twin, nullptr, 1.0, runs, twin.as_written()));
    Twin::Workspace workspace(twin);
    as_written_ = fresh_->predict({}, Eigen::VectorXd::Zero(fresh_->n_nuisance()), workspace);
    first_ = runs;
    for (MeasuredChannel& c : first_[1].channels) c.value.setConstant(std::nan(""));
    return inquire({.twin = twin,
                    .coarse = nullptr,
                    .options = how_,
                    .candidates = standing_,
                    .fresh = *fresh_,
                    .as_written = as_written_},
                   first_, false, {});
  }

  Beside beside_;
  std::vector<MeasuredRun> spoilt_, first_;
  std::vector<Candidate> standing_;
  std::unique_ptr<Fitter> fresh_;
  Prediction as_written_;
  DiagnosisOptions how_;
};

// A thermometer that bends away by 2 K in a parabola over its record, of which the last third is not known. Curves that
// are fitted to two thirds say anything of the last one.
TEST_F(TwoRecords, NothingIsLeftWhereThereIsNoReading) {
  std::vector<MeasuredRun> runs = beside_.runs;
  MeasuredRun& run = runs[0];
  Prediction none;
  for (const MeasuredRun& r : runs)
    none.push_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(beside_.twin->outputs().name.size()),
                                         static_cast<Eigen::Index>(r.time_s.size())));
  const Eigen::Index n = run.channels[0].value.size(), n_known = 2 * n / 3;
  Random random(9, 0);
  double squares = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double bent_K = 2.0 * std::pow(static_cast<double>(i) / static_cast<double>(n), 2);
    run.channels[0].value[i] = i < n_known ? bent_K + kNoise_K * random.normal() : std::nan("");
    if (i < n_known) squares += bent_K * bent_K;
  }
  run.channels.resize(1);
  runs[1].channels.clear();
  const NoiseModel noise{.white = kNoise_K};
  const std::vector<Leftover> left = leftovers(runs, none, {{run.channels[0].name, noise}});
  ASSERT_EQ(left.size(), 1U);
  EXPECT_NEAR(left[0].rms, std::sqrt(squares / static_cast<double>(n_known)), 0.02);
}

TEST_F(TwoRecords, WhatIsSaidOfOneOwesNothingToTheOther) {
  const Inquiry plain = of_the_first(false);
  const double nothing = plain.search.statements.nothing;
  const Eigen::VectorXd x = plain.search.fit.x;
  const std::map<std::string, NoiseModel> noise = plain.noise;
  const std::size_t n_claims = plain.search.hypothesis.size();
  EXPECT_NEAR(noise.at("heater").total(), kNoise_K, 0.15 * kNoise_K);
  const Inquiry spoilt = of_the_first(true);
  EXPECT_EQ(spoilt.noise.at("heater").total(), noise.at("heater").total());
  EXPECT_EQ(spoilt.search.statements.nothing, nothing);
  ASSERT_EQ(spoilt.search.hypothesis.size(), n_claims);
  EXPECT_EQ(spoilt.search.fit.x, x);
}

}  // namespace
}  // namespace driftwright::diagnosis::inquiry_test
