// Fits that come nowhere near are given up, and only these.

#include <gtest/gtest.h>

#include "diagnosis/candidates.hpp"
#include "diagnosis/fit.hpp"
#include "diagnosis/scatter.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::given_up_fits_test {
namespace {

constexpr double kHopeless = 1e-3;  // a misfit that no fit reaches

class GivenUpFits : public testing::Test {
 protected:
  /// @param truth  what the records have and the scenario lacks
  void open(const std::string& truth) {
    beside_.emplace(write_file("plain.yaml", kTwoNodes),
                    noisy_records(write_file("truth.yaml", with_effect(kTwoNodes, truth)), "it_"));
    fitter_.emplace(*beside_->twin, beside_->runs, scatter(*beside_->twin), std::vector<Prediction>{});
    const NoiseModel kelvin{0.03, 0.0, 0.0};
    fitter_->set_noise({{"t_head", kelvin}, {"t_column", kelvin}, {"nose", {2e-7, 0.0, 0.0}}});
  }
  [[nodiscard]] Fit fit(const std::string& effect, const std::string& where, double of_interest) const {
    Twin::Workspace workspace(*beside_->twin);
    const std::vector<Candidate> list = candidates(*beside_->twin, beside_->runs, {});
    for (std::size_t c = 0; c < list.size(); ++c) {
      if (list[c].effect != effect || list[c].where != where) continue;
      const Variant& v = list[c].variants.front();
      Eigen::VectorXd start = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(v.knobs.size()));
      start[0] = v.trial_x;
      return fitter_->fit({{c, 0, v.knobs, v.all_or_nothing, v.price_nats, v.happens}}, start, workspace, of_interest);
    }
    ADD_FAILURE() << "no candidate " << effect << " at " << where;
    return {};
  }

  std::optional<Beside> beside_;
  std::optional<Fitter> fitter_;
};

TEST_F(GivenUpFits, AreThoseThatFallSlowlyFarAboveWhatIsOfInterest) {
  open("{type: heat_source, node: column, power: 400 W, exponent: 0}");
  const Fit wrong = fit("sensor_lag", "t_column", Fitter::kAny);
  ASSERT_FALSE(wrong.prediction.empty());
  ASSERT_GT(wrong.misfit, 1000.0);
  EXPECT_TRUE(fit("sensor_lag", "t_column", kHopeless).prediction.empty());
}

TEST_F(GivenUpFits, AreNotThoseThatEndAtIt) {
  open("{type: heat_source, node: column, power: 400 W, exponent: 0}");
  const Fit wrong = fit("sensor_lag", "t_column", Fitter::kAny), kept = fit("sensor_lag", "t_column", wrong.misfit);
  ASSERT_FALSE(kept.prediction.empty());
  EXPECT_EQ(kept.misfit, wrong.misfit);
}

TEST_F(GivenUpFits, AreNotThoseThatComeFromFarAway) {
  open("{type: heat_source, node: column, power: 400 W, exponent: 0}");
  const Fit right = fit("heat_source", "column", Fitter::kAny);
  const Fit guarded = fit("heat_source", "column", right.misfit);
  ASSERT_FALSE(guarded.prediction.empty());
  EXPECT_EQ(guarded.misfit, right.misfit);
}

}  // namespace
}  // namespace driftwright::diagnosis::given_up_fits_test
