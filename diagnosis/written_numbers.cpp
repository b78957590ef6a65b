#include "diagnosis/written_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/quantity.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kRoundedBy = 0.25;  // of the standard deviation: the ends of a 95 % interval move by an eighth of its half
constexpr int kFewestDigits = 3, kMostDigits = 6;

/// x of a value, within the knob's bounds; NaN beyond them.
double x_within(const Knob& knob, double value) {
  if (!(value >= knob.low && value <= knob.high)) return std::numeric_limits<double>::quiet_NaN();
  if (knob.scale == Knob::Scale::kLog && !(value / knob.nominal > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return knob.x(value);
}

double rounded_x(const Knob& knob, double x, int digits) {
  return x_within(knob, with_digits(knob, knob.value(x), digits));
}

/// Whether the scenario's number is as good as the fitted one.
bool may_stay(const WrittenNumber& number, double x, double sd) {
  return number.is_own && std::abs(x) <= kRoundedBy * sd;
}

/// The x that is written in place of one that is known to `sd`.
double short_x(const WrittenNumber& number, double x, double sd) {
  if (may_stay(number, x, sd)) return 0.0;
  for (int digits = kFewestDigits; digits < kMostDigits; ++digits) {
    const double other = rounded_x(*number.knob, x, digits);
    if (std::abs(other - x) <= kRoundedBy * sd) return other;  // never for NaN
  }
  const double other = rounded_x(*number.knob, x, kMostDigits);
  return std::isnan(other) ? x : other;
}

/// Numbers with the largest value are rounded first: those that stay, then those whose third digit is known worst.
std::pair<bool, double> order_key(const WrittenNumber& number, double x, double sd) {
  if (may_stay(number, x, sd)) return {true, sd};
  const Knob& knob = *number.knob;
  const double value = with_digits(knob, knob.value(x), kFewestDigits);
  const double unit = value == 0.0 ? 0.0 : std::pow(10.0, std::floor(std::log10(std::abs(value))) - (kFewestDigits - 1));
  const double next = x_within(knob, value + unit) - x_within(knob, value);
  return {false, next > 0.0 ? sd / next : 0.0};
}

}  // namespace

double with_digits(const Knob& knob, double value, int digits) {
  const double scale = knob.is_time ? 60.0 : 1.0, zero = knob.unit == "degC" ? kZeroCelsius_K : 0.0;
  const double shown = (value - zero) / scale;
  if (shown == 0.0 || !std::isfinite(shown)) return value;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(shown))) - (digits - 1));
  return scale * (unit < 1.0 ? std::round(shown / unit) / std::round(1.0 / unit) : std::round(shown / unit) * unit) + zero;
}

Eigen::VectorXd with_few_digits(const std::vector<WrittenNumber>& numbers, const Eigen::VectorXd& x,
                                const Eigen::MatrixXd& covariance) {
  const auto n = static_cast<Eigen::Index>(numbers.size());
  Eigen::VectorXd short_form = x, at(n);
  Eigen::MatrixXd c(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    at[i] = x[numbers[static_cast<std::size_t>(i)].at];
    for (Eigen::Index j = 0; j < n; ++j)
      c(i, j) = covariance(numbers[static_cast<std::size_t>(i)].at, numbers[static_cast<std::size_t>(j)].at);
  }
  std::vector<char> is_done(numbers.size(), 0);
  for (std::size_t step = 0; step < numbers.size(); ++step) {
    std::size_t next = numbers.size();
    std::pair<bool, double> first = {false, -1.0};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto at_i = static_cast<Eigen::Index>(i);
      if (is_done[i]) continue;
      const auto mine = order_key(numbers[i], at[at_i], std::sqrt(std::max(0.0, c(at_i, at_i))));
      if (!(mine > first)) continue;
      first = mine;
      next = i;
    }
    const auto i = static_cast<Eigen::Index>(next);
    const double variance = std::max(0.0, c(i, i));
    const double now = short_x(numbers[next], at[i], std::sqrt(variance));
    if (variance > 0.0) {
      const Eigen::VectorXd follow = c.col(i) / variance;
      const double by = now - at[i];
      for (Eigen::Index j = 0; j < n; ++j) {
        if (!is_done[static_cast<std::size_t>(j)]) at[j] += by * follow[j];
      }
      c -= variance * follow * follow.transpose();
    }
    at[i] = now;
    is_done[next] = 1;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) short_form[numbers[i].at] = at[static_cast<Eigen::Index>(i)];
  return short_form;
}

Eigen::VectorXd written_x(const Diagnosis& d, bool causes_only) {
  const Fit& fit = d.written.fit;
  if (fit.covariance.rows() != fit.x.size()) return fit.x;  // nothing was fitted
  const std::vector<const Knob*> knobs = knobs_of(d.written.hypothesis);
  const std::vector<char> smooth = smooth_knobs(d.written.hypothesis);
  Eigen::Index first = fit.x.size() - static_cast<Eigen::Index>(knobs.size());
  std::vector<WrittenNumber> numbers;
  for (std::size_t i = 0; i < d.scatter.size() && !d.written.causes_alone; ++i) {
    const bool is_cause = std::find(d.moved.begin(), d.moved.end(), i) != d.moved.end();
    if (!causes_only || is_cause) numbers.push_back({&d.scatter[i], static_cast<Eigen::Index>(i), true});
  }
  Eigen::VectorXd x = fit.x;
  std::size_t k = 0;
  for (const Claim& claim : d.written.hypothesis) {
    for (std::size_t of_claim = 0; of_claim < claim.knobs.size(); ++of_claim, ++k, ++first) {
      if (claim.all_or_nothing) continue;
      if (smooth[k])
        numbers.push_back({knobs[k], first, false});
      else
        x[first] = short_x({knobs[k], first, false}, x[first], 0.0);
    }
  }
  return with_few_digits(numbers, x, fit.covariance);
}

}  // namespace driftwright::diagnosis
