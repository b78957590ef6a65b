#include "diagnosis/blunder_match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/foreign_temperature.hpp"
#include "base/rows_as_one.hpp"
#include "effects/doubt.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kOffset_K = kFarBeside_K / 3.0;  // standard deviation of an offset
constexpr double kLeastNoise = 1e-3;              // of a course: no scenario is more accurate
constexpr double kMostLogGain = 14.0, kStepOfLogGain = 0.05;
constexpr int kStepsOfOffset = 20;

double variance_of(const Eigen::ArrayXd& x) {
  return (x - x.mean()).square().mean();
}

}  // namespace

double reading_noise(const Eigen::ArrayXd& read) {
  const Eigen::Index n = read.size();
  double white = 0.0;
  if (n >= 3) {
    const Eigen::ArrayXd bend = read.tail(n - 2) - 2.0 * read.segment(1, n - 2) + read.head(n - 2);
    white = std::sqrt(bend.square().mean() / 6.0);
  }
  return std::max(white, kLeastNoise * std::sqrt(variance_of(read)));
}

double independent_readings(const ReadBeside& r) {
  const Eigen::ArrayXd model = r.model - r.model.mean(), read = r.read - r.read.mean();
  const double square = model.square().sum();
  const double gain = square > 0.0 ? (model * read).sum() / square : 0.0;
  const std::array<Eigen::VectorXd, 1> left = {(read - gain * model).matrix()};
  if (!(left[0].squaredNorm() > 0.0)) return static_cast<double>(read.size());
  return std::max(1.0, static_cast<double>(read.size()) / rows_as_one(left));
}

Match match(const ReadBeside& r, const Showing& shown, double n_independent, bool priced_gain) {
  const double floor2 = std::pow(reading_noise(r.read), 2), course2 = variance_of(r.read), model2 = variance_of(r.model);
  const double both = ((r.read - r.read.mean()) * (r.model - r.model.mean())).mean();
  const double gain_weight = priced_gain ? 0.5 / std::pow(effects::kFactorSd, 2) : 0.0;
  Match best{.nats = -std::numeric_limits<double>::infinity()};
  const int n_gains = static_cast<int>(std::lround(kMostLogGain / kStepOfLogGain));
  for (int i = -n_gains; i <= n_gains; ++i) {
    const double log_gain = i * kStepOfLogGain, slope = shown.scale * std::exp(log_gain);
    const double rest2 = std::max(0.0, course2 - 2.0 * slope * both + slope * slope * model2);
    const double off = r.read.mean() - shown.shift - slope * r.model.mean();
    for (int k = r.is_temperature ? 0 : kStepsOfOffset; k <= kStepsOfOffset; ++k) {
      const double share = static_cast<double>(k) / kStepsOfOffset, offset = share * off / shown.scale;
      const double left2 = rest2 + std::pow((1.0 - share) * off, 2);
      const double gain_nats = gain_weight * log_gain * log_gain;
      const double offset_nats = r.is_temperature ? 0.5 * std::pow(offset / kOffset_K, 2) : 0.0;
      const double nats = -0.5 * n_independent * std::log(left2 + floor2) - gain_nats - offset_nats;
      if (!(nats > best.nats)) continue;
      best = {.nats = nats,
              .gain_nats = gain_nats,
              .gain = std::exp(log_gain),
              .offset = r.is_temperature ? offset : 0.0,
              .rest = std::sqrt(left2)};
    }
  }
  best.beyond_scatter = beyond_scatter(best, r.read);
  return best;
}

double course_of(const Eigen::ArrayXd& read) {
  return std::sqrt(variance_of(read));
}

double beyond_scatter(const Match& m, const Eigen::ArrayXd& read, double least_course) {
  const double noise = reading_noise(read), course = std::max(least_course, course_of(read));
  const double beyond_noise = std::sqrt(std::max(0.0, m.rest * m.rest - noise * noise));
  return std::max({std::abs(std::log(m.gain)) / (2.0 * kOwnScatter), std::abs(m.offset) / (2.0 * kOffset_K),
                   course > 0.0 ? beyond_noise / (kOwnScatter * course) : 0.0});
}

double nats_of_unrelated(const ReadBeside& r, double n_independent) {
  const double noise = reading_noise(r.read), off_K = r.is_temperature ? r.read.mean() - r.model.mean() : 0.0;
  return -0.5 * n_independent * std::log(variance_of(r.read) + noise * noise) - 0.5 * std::pow(off_K / kOffset_K, 2);
}

}  // namespace driftwright::diagnosis
