#include "compensation/predictors/residual_process.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace driftwright::compensation {
namespace {

constexpr std::size_t kLeastRows = 10;
constexpr int kTimeConstants = 25, kDeviations = 25;  // of the grid, in equal steps of the logarithm
constexpr double kLongest = 10.0;                     // longest time constant, over the longest series
constexpr double kLeastDeviation_um = 1e-3;

/// Logarithm of the likelihood of the series.
double log_likelihood(std::span<const ResidualSeries> series, const ResidualProcess& process, double reading_um) {
  const double most = process.deviation_um * process.deviation_um, noise = reading_um * reading_um;
  double log_likelihood = 0.0;
  for (const ResidualSeries& s : series) {
    double mean = 0.0, variance = most;
    for (std::size_t i = 0; i < s.time_s.size(); ++i) {
      if (i > 0) {
        const double kept = std::exp(-(s.time_s[i] - s.time_s[i - 1]) / process.time_constant_s);
        mean *= kept;
        variance = kept * kept * variance + (1.0 - kept * kept) * most;
      }
      const double total = variance + noise, off = s.off_um[i] - mean;
      log_likelihood -= 0.5 * (std::log(2.0 * std::numbers::pi * total) + off * off / total);
      mean += variance / total * off;
      variance *= noise / total;
    }
  }
  return log_likelihood;
}

double on_grid(double low, double high, int k, int n) {
  return low * std::pow(high / low, static_cast<double>(k) / (n - 1));
}

}  // namespace

std::optional<ResidualProcess> fit_residual_process(std::span<const ResidualSeries> series, double reading_um) {
  std::size_t n = 0, n_steps = 0;
  double square = 0.0, longest_s = 0.0, all_s = 0.0;
  for (const ResidualSeries& s : series) {
    n += s.time_s.size();
    for (double um : s.off_um) square += um * um;
    if (s.time_s.size() < 2) continue;
    n_steps += s.time_s.size() - 1;
    longest_s = std::max(longest_s, s.time_s.back() - s.time_s.front());
    all_s += s.time_s.back() - s.time_s.front();
  }
  if (n < kLeastRows || n_steps == 0) return std::nullopt;
  const double rms_um = std::max(std::sqrt(square / static_cast<double>(n)), 10.0 * kLeastDeviation_um);
  const double step_s = all_s / static_cast<double>(n_steps);
  ResidualProcess best;
  double most = -std::numeric_limits<double>::infinity();
  for (int t = 0; t < kTimeConstants; ++t) {
    for (int d = 0; d < kDeviations; ++d) {
      const ResidualProcess tried{on_grid(0.1 * rms_um, 3.0 * rms_um, d, kDeviations),
                                  on_grid(step_s, kLongest * longest_s, t, kTimeConstants)};
      const double log_l = log_likelihood(series, tried, std::max(reading_um, kLeastDeviation_um));
      if (log_l <= most) continue;
      most = log_l;
      best = tried;
    }
  }
  return best;
}

ProbeFeedback::ProbeFeedback(const ResidualProcess& process, bool is_known)
    : process_(process), variance_um2_(is_known ? 0.0 : process.deviation_um * process.deviation_um) {}

void ProbeFeedback::wait(double step_s) {
  const double kept = std::exp(-step_s / process_.time_constant_s);
  mean_um_ *= kept;
  variance_um2_ = kept * kept * variance_um2_ + (1.0 - kept * kept) * process_.deviation_um * process_.deviation_um;
}

bool ProbeFeedback::probe(double off_um, double noise_um) {
  const double noise = noise_um * noise_um;
  const bool is_expected = std::abs(off_um - mean_um_) <= kRefused * std::sqrt(variance_um2_ + noise);
  const bool is_confirmed =
      refused_um_ &&
      std::abs(off_um - *refused_um_) <= kRefused * std::sqrt(2.0 * noise + process_.deviation_um * process_.deviation_um);
  if (!is_expected && !is_confirmed) {
    refused_um_ = off_um;
    return false;
  }
  if (!is_expected) variance_um2_ = off_um * off_um;  // the process is wider than was known
  refused_um_.reset();
  const double gain = variance_um2_ / (variance_um2_ + noise);
  mean_um_ += gain * (off_um - mean_um_);
  variance_um2_ *= 1.0 - gain;
  return true;
}

double ProbeFeedback::deviation_um() const {
  return std::sqrt(variance_um2_);
}

}  // namespace driftwright::compensation
