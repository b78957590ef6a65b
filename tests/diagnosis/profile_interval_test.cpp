// Intervals against closed forms: a machine that nothing heats, so that no scatter moves its readings.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/random.hpp"
#include "diagnosis/interval.hpp"
#include "diagnosis/scatter.hpp"
#include "studies/measured_twin.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::diagnosis::profile_interval_test {
namespace {

constexpr int kRows = 240;
constexpr double kNoise_K = 0.1, kNoise_m = 0.5e-6, kShift_m = 4e-6, kShiftAt_s = 60.0 * 100.0;

class ProfileInterval : public testing::Test {
 protected:
  ProfileInterval() {
    const std::string scenario = write_file("idle.yaml", R"(name: idle
reference_temperature: 20 degC
machine:
  generator: lumped
effects:
  - {type: node, node: body, capacity: 10 kJ/K}
  - {type: link, node: body, to: ambient, conductance: 5 W/K}
ambient: [[0 h, 20 degC]]
sensors:
  - {name: t_body, node: body}
displacements:
  - {name: tip_z, sensitivities: [{node: body, sensitivity: 2 um/K}]}
cyclograms:
  idle: [[240 min, 0 rpm]]
)");
    Random random(7);
    std::string text = "time_s,speed_rpm,ambient_degC,t_body_degC,tip_z_um\n";
    for (int i = 0; i < kRows; ++i) {
      const double noise_K = kNoise_K * random.normal(), noise_m = kNoise_m * random.normal();
      const double time_s = 60.0 * i;
      text += fmt::format("{},0,20,{:.6f},{:.6f}\n", time_s, 20.0 + noise_K,
                          1e6 * ((time_s >= kShiftAt_s ? kShift_m : 0.0) + noise_m));
    }
    m_.emplace(
        studies::open_measured_twin(scenarios::read_scenario(scenario), "diagnose", {write_file("idle.csv", text)}, {}));
    list_ = candidates(*m_->twin, m_->runs, {});
    fitter_ = std::make_unique<Fitter>(*m_->twin, m_->runs, scatter(*m_->twin), std::vector<Prediction>{});
    fitter_->set_noise({{"t_body", {kNoise_K, 0.0, 0.0}}, {"tip_z", {kNoise_m, 0.0, 0.0}}});
  }
  [[nodiscard]] Hypothesis claim(const std::string& effect, const std::string& where) const {
    for (std::size_t c = 0; c < list_.size(); ++c) {
      if (list_[c].effect == effect && list_[c].where == where) return {{c, 0, list_[c].variants[0].knobs, false}};
    }
    return {};
  }

  std::optional<studies::MeasuredTwin> m_;
  std::vector<Candidate> list_;
  std::unique_ptr<Fitter> fitter_;
};

TEST_F(ProfileInterval, OfABiasIsThatOfAMean) {
  Twin::Workspace workspace(*m_->twin);
  const Hypothesis h = claim("sensor_bias", "t_body");
  ASSERT_EQ(h.size(), 1u);
  const Fit fit = fitter_->fit(h, Eigen::VectorXd::Zero(1), workspace);
  const Interval x = profile_interval(*fitter_, h, fit, 0, 0);
  // Φ may be off by its tolerance of 0.15 in 1.92: 4 % of the width
  const double half_K = 1.96 * kNoise_K / std::sqrt(static_cast<double>(kRows));
  EXPECT_NEAR(x.high - fit.x[fitter_->n_nuisance()], half_K, 0.04 * half_K);
  EXPECT_NEAR(fit.x[fitter_->n_nuisance()] - x.low, half_K, 0.04 * half_K);
}

TEST_F(ProfileInterval, OfAStepInAReadingReachesFromRowToRow) {
  Twin::Workspace workspace(*m_->twin);
  const Hypothesis h = claim("mount_shift", "tip_z");
  ASSERT_EQ(h.size(), 1u);
  const Fit fit = fitter_->fit(h, Eigen::Vector2d(3.0, -1500.0), workspace);
  const Knob& time = h[0].knobs[1];
  const Interval x = profile_interval(*fitter_, h, fit, 0, 1);
  const double low_s = time.value(x.low), high_s = time.value(x.high);
  EXPECT_LE(low_s, kShiftAt_s - 60.0);  // between the row before it and its own, no reading can say
  EXPECT_GE(high_s, kShiftAt_s);
  EXPECT_LE(high_s - low_s, 4.0 * 60.0);  // a step of eight times the noise is not missed by a row
}

}  // namespace
}  // namespace driftwright::diagnosis::profile_interval_test
