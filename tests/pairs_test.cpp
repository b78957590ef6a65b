// Pairs of causes by linear theory, of signatures made for it.

#include "diagnosis/pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace driftwright::diagnosis::pairs_test {
namespace {

constexpr Eigen::Index kRows = 400;

/// Readings in sigmas, and the candidates that they are held against: a, b, what looks like both of them and like nothing else, and one that says nothing.
struct Made {
  std::vector<Candidate> candidates;
  std::vector<Signature> signatures;
  Eigen::VectorXd readings;

  explicit Made(double a, double b, double low = -1e300) {
    const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(kRows, 0.0, 1.0);
    add("a", (3.0 * t).sin(), low);
    add("b", (t > 0.6).select(1.0, Eigen::ArrayXd::Zero(kRows)), low);
    add("both", (3.0 * t).sin() + (t > 0.6).select(1.0, Eigen::ArrayXd::Zero(kRows)) + 0.5 * (20.0 * t).cos(), low);
    add("neither", (11.0 * t).cos(), low);
    Random random(7, 0);
    readings = a * signatures[0].column + b * signatures[1].column;
    for (double& r : readings) r += random.normal();
  }
  void add(const std::string& name, const Eigen::ArrayXd& column, double low) {
    Knob size;
    size.scale = Knob::Scale::kLinear;
    size.prior_sd = 2.0;
    size.low = low;
    const Variant law{.law = name, .knobs = {size}, .trial_x = 1.0, .grid = {{}}};
    signatures.push_back({candidates.size(), 0, Eigen::VectorXd::Ones(1), column.matrix()});
    candidates.push_back({"effect", name, {law}});
  }
  /// @param known  a number that is fitted anyway, as an offset of all readings
  [[nodiscard]] std::vector<ScoredPair> pairs(std::size_t n, bool known = true) const {
    const Eigen::MatrixXd offset = Eigen::MatrixXd::Constant(kRows, known ? 1 : 0, 1.0);
    return best_pairs(candidates, signatures, Projection(offset, Eigen::VectorXd::Ones(offset.cols()), readings), n);
  }
};

TEST(Pairs, AreFoundWhereAThirdCauseDoesBestByItself) {
  const Made made(1.2, 1.0);
  const std::vector<ScoredPair> pairs = made.pairs(3);
  ASSERT_EQ(pairs.size(), 3u);
  const ScoredPair& best = pairs.front();
  const auto size_of = [&](std::size_t candidate) {
    return best.first.candidate == candidate ? best.first.start[0] : best.second.start[0];
  };
  ASSERT_EQ(best.first.candidate + best.second.candidate, 1u) << best.first.candidate << ", " << best.second.candidate;
  EXPECT_NEAR(size_of(0), 1.2, 0.45);  // three sigmas, the offset of all readings being free
  EXPECT_NEAR(size_of(1), 1.0, 0.45);
  EXPECT_GT(best.gain, pairs[1].gain + 3.0);
}

// What both bring, all paid, is what the evidence of a fit of both says: by the closed form of normal priors.
TEST(Pairs, BringTheEvidenceOfAFitOfBoth) {
  const Made made(0.6, 0.5);  // within the prior: its tails are those of a normal one there
  const std::vector<ScoredPair> pairs = made.pairs(1);
  Eigen::MatrixXd slopes(kRows, 3);
  slopes << Eigen::VectorXd::Ones(kRows), made.signatures[0].column, made.signatures[1].column;
  const Projection with(slopes, Eigen::Vector3d(1.0, 2.0, 2.0), made.readings);
  const Projection without(slopes.leftCols(1), Eigen::VectorXd::Ones(1), made.readings);
  EXPECT_NEAR(pairs.front().gain, with.log_evidence - without.log_evidence, 0.2);
}

TEST(Pairs, HaveBothWithinTheirRange) {  // where b would have to be negative there is no pair of the two
  const Made made(1.2, -1.0, 0.0);
  const std::vector<ScoredPair> pairs = made.pairs(10);
  EXPECT_FALSE(pairs.empty());
  for (const ScoredPair& p : pairs) {
    EXPECT_NE(p.first.candidate, p.second.candidate);
    EXPECT_NE(p.first.candidate + p.second.candidate, 1u);
    EXPECT_EQ(p.first.start.size(), 1);
    EXPECT_EQ(p.second.start.size(), 1);
  }
}

}  // namespace
}  // namespace driftwright::diagnosis::pairs_test
