// What a fit leaves, of rows of which some have no reading.

#include "diagnosis/leftover.hpp"

#include <gtest/gtest.h>

#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::leftover_test {
namespace {

constexpr double kNoise_K = 0.03;

// A thermometer that bends away by 2 K in a parabola over its record, of which the last third is not known. Curves that
// are fitted to two thirds say anything of the last one.
TEST(Leftover, NothingIsLeftWhereThereIsNoReading) {
  const Beside beside(write_file("plain.yaml", kTwoNodes), noisy_records(write_file("truth.yaml", kTwoNodes), "leftover_",
                                                                         {.noise_K = kNoise_K, .noise_um = 0.1}));
  std::vector<MeasuredRun> runs = beside.runs;
  MeasuredRun& run = runs[0];
  Prediction none;
  for (const MeasuredRun& r : runs)
    none.push_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(beside.twin->outputs().name.size()),
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
  for (std::size_t r = 1; r < runs.size(); ++r) runs[r].channels.clear();
  const NoiseModel noise{.white = kNoise_K};
  const std::vector<Leftover> left = leftovers(runs, none, {{run.channels[0].name, noise}});
  ASSERT_EQ(left.size(), 1U);
  EXPECT_NEAR(left[0].rms, std::sqrt(squares / static_cast<double>(n_known)), 0.02);
}

}  // namespace
}  // namespace driftwright::diagnosis::leftover_test
