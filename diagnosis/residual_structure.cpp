#include "diagnosis/residual_structure.hpp"

#include <algorithm>
#include <cmath>

#include "base/normal.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kShortestConstant_s = 60.0, kLongestConstant_s = 36000.0;  // time constants of machines
constexpr int kPerDecade = 20;
constexpr double kWorthTelling = 0.3;

double nan() {
  return std::numeric_limits<double>::quiet_NaN();
}

/// Over the times at which both have a value.
double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double n = 0.0, mean_a = 0.0, mean_b = 0.0;
  const auto both = [&](Eigen::Index i) { return !std::isnan(a[i]) && !std::isnan(b[i]); };
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (!both(i)) continue;
    n += 1.0;
    mean_a += a[i];
    mean_b += b[i];
  }
  if (n < 3.0) return nan();
  mean_a /= n;
  mean_b /= n;
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (!both(i)) continue;
    const double da = a[i] - mean_a, db = b[i] - mean_b;
    aa += da * da;
    bb += db * db;
    ab += da * db;
  }
  // A record of constant rounded readings has only rounding errors of its mean.
  const double rounding = 1e-24 * n;
  if (!(aa > rounding * (1.0 + mean_a * mean_a)) || !(bb > rounding * (1.0 + mean_b * mean_b))) return nan();
  return ab / std::sqrt(aa * bb);
}

struct Quantity {
  std::string name;
  Eigen::VectorXd value;  ///< per time; NaN if unknown
};

std::vector<Quantity> recorded(const MeasuredRun& run, double earlier_s) {
  const auto n = static_cast<Eigen::Index>(run.time_s.size());
  Eigen::VectorXd speed(n), square(n), change(n), ambient(n), rate(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t_s = run.time_s[static_cast<std::size_t>(i)] - earlier_s;
    const double step_s =
        i > 0 ? run.time_s[static_cast<std::size_t>(i)] - run.time_s[static_cast<std::size_t>(i) - 1] : 0.0;
    const bool known = t_s >= 0.0, before_known = known && t_s - step_s >= 0.0 && step_s > 0.0;
    speed[i] = known ? run.cyclogram.drive(t_s).speed_rpm : nan();
    square[i] = speed[i] * speed[i];
    ambient[i] = known ? run.ambient.at(t_s) : nan();
    change[i] = before_known ? std::abs(speed[i] - run.cyclogram.drive(t_s - step_s).speed_rpm) : nan();
    rate[i] = before_known ? (ambient[i] - run.ambient.at(t_s - step_s)) / step_s : nan();
  }
  std::vector<Quantity> list = {
      {"speed", speed}, {"speed^2", square}, {"|change of speed|", change}, {"ambient", ambient}, {"ambient rate", rate}};
  for (auto& [name, value] : beside_drive(run, earlier_s)) list.push_back({name, std::move(value)});
  return list;
}

/// After a first-order lag that starts at the first value; each value holds until the next.
Eigen::VectorXd lagged(const std::vector<double>& time_s, const Eigen::VectorXd& q, double lag_s, bool from_zero) {
  Eigen::VectorXd y(q.size());
  y[0] = from_zero ? 0.0 : q[0];
  for (Eigen::Index i = 1; i < q.size(); ++i) {
    const double step_s = time_s[static_cast<std::size_t>(i)] - time_s[static_cast<std::size_t>(i) - 1];
    y[i] = q[i - 1] + (y[i - 1] - q[i - 1]) * std::exp(-step_s / lag_s);
  }
  return y;
}

}  // namespace

std::vector<std::pair<std::string, Eigen::VectorXd>> beside_drive(const MeasuredRun& run, double earlier_s) {
  std::vector<std::pair<std::string, Eigen::VectorXd>> list;
  const auto add = [&](const std::string& name, const auto& at) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(run.time_s.size()));
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const double t_s = run.time_s[static_cast<std::size_t>(i)] - earlier_s;
      values[i] = t_s >= 0.0 ? at(t_s) : nan();
    }
    list.emplace_back(name, std::move(values));
  };
  const auto& sections = run.cyclogram.sections;
  const bool cuts =
      std::any_of(sections.begin(), sections.end(), [](const auto& s) { return s.drive.cutting_power_W > 0.0; });
  if (cuts) add("cutting_power_W", [&](double t_s) { return run.cyclogram.drive(t_s).cutting_power_W; });
  for (const Cyclogram::Column& c : run.cyclogram.columns) add(c.header(), [&](double t_s) { return c.at(t_s); });
  return list;
}

ResidualStructure residual_structure(const MeasuredRun& run, const Eigen::VectorXd& residual) {
  ResidualStructure s;
  double n = 0.0, squares = 0.0;
  for (double r : residual) {
    if (std::isnan(r)) continue;
    n += 1.0;
    squares += r * r;
  }
  s.rms = std::sqrt(squares / std::max(1.0, n));
  s.white_up_to = kNormal95 / std::sqrt(std::max(1.0, n));
  const Eigen::Index rows = residual.size();
  s.lag_1 = correlation(residual.head(rows - 1), residual.tail(rows - 1));

  for (std::size_t l = 0; l < kLags_s.size(); ++l) {
    const std::vector<Quantity> quantities = recorded(run, kLags_s[l]);
    if (l == 0) {
      for (const Quantity& q : quantities) s.likenesses.push_back({q.name, {}});
    }
    for (std::size_t q = 0; q < quantities.size(); ++q)
      s.likenesses[q].correlation[l] = correlation(quantities[q].value, residual);
  }

  for (const Quantity& q : recorded(run, 0.0)) {
    if (q.value.hasNaN()) continue;  // changes and rates: a response to them is no step response
    // The machine has not turned before, but it was in its ambient and its sun.
    const bool from_zero = q.name == "speed" || q.name == "speed^2";
    for (int k = 0;; ++k) {
      const double lag_s = kShortestConstant_s * std::pow(10.0, static_cast<double>(k) / kPerDecade);
      if (lag_s > kLongestConstant_s) break;
      const double c = correlation(lagged(run.time_s, q.value, lag_s, from_zero), residual);
      const double share = std::isnan(c) ? 0.0 : c * c;
      if (share >= kWorthTelling && (!s.lag || share > s.lag->share)) s.lag = {q.name, lag_s, share};
    }
  }
  return s;
}

}  // namespace driftwright::diagnosis
