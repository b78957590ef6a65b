#include "compensation/frames/ambient_models.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>

#include "base/dense.hpp"
#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

constexpr int kLags = 67;  // 0.1 h to 200 h, ratio 1.12

double lag_s(int i) {
  return 360.0 * std::pow(2000.0, static_cast<double>(i) / (kLags - 1));
}

/// 95 % quantile of F(1, dof).
double f_quantile(int dof) {
  constexpr double kQuantile[] = {161.4, 18.51, 10.13, 7.71, 6.61, 5.99, 5.59, 5.32, 5.12, 4.96};
  return dof <= 10 ? kQuantile[dof - 1] : 4.0 + 9.6 / dof;
}

struct Fit {
  double square = std::numeric_limits<double>::infinity();  ///< sum of squared misfits
  Eigen::VectorXd coefficients;
  int lag_1 = 0, lag_2 = 0;
};

using Columns = std::vector<Eigen::VectorXd>;  // of temperatures, one per lag, at all readings

Fit fit_linear(const std::vector<const Eigen::VectorXd*>& columns, const Eigen::VectorXd& y, int left_out) {
  const Eigen::Index n = y.size() - (left_out >= 0 ? 1 : 0);
  Eigen::MatrixXd a(n, static_cast<Eigen::Index>(columns.size()) + 1);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0, row = 0; i < y.size(); ++i) {
    if (i == left_out) continue;
    a(row, 0) = 1.0;
    for (std::size_t c = 0; c < columns.size(); ++c) a(row, static_cast<Eigen::Index>(c) + 1) = (*columns[c])[i];
    b[row++] = y[i];
  }
  Fit fit;
  fit.coefficients = dense::least_squares(a, b);
  fit.square = (a * fit.coefficients - b).squaredNorm();
  return fit;
}

/// A fit procedure: tries all lags in turn.
using Search = std::function<void(int left_out, const std::function<void(const Fit&, double predicted)>&)>;

Fit best_of(const Search& search, int left_out, double* predicted = nullptr) {
  Fit best;
  search(left_out, [&](const Fit& fit, double at_left_out) {
    if (!(fit.square < best.square)) return;
    best = fit;
    if (predicted) *predicted = at_left_out;
  });
  return best;
}

double predicted_at(const Fit& fit, const std::vector<const Eigen::VectorXd*>& columns, int i) {
  if (i < 0) return 0.0;
  double value = fit.coefficients[0];
  for (std::size_t c = 0; c < columns.size(); ++c)
    value += fit.coefficients[static_cast<Eigen::Index>(c) + 1] * (*columns[c])[i];
  return value;
}

AmbientModel judged(const std::string& name, int n_parameters, const Search& search, const Eigen::VectorXd& y,
                    const std::function<std::string(const Fit&, double limit)>& words) {
  AmbientModel model{.name = name, .n_parameters = n_parameters};
  const auto n = static_cast<double>(y.size());
  const Fit fit = best_of(search, -1);
  model.rms = std::sqrt(fit.square / n);
  model.r_squared = 1.0 - fit.square / (y.array() - y.mean()).square().sum();
  double square = 0.0;
  for (int i = 0; i < y.size(); ++i) {
    double predicted = 0.0;
    (void)best_of(search, i, &predicted);
    square += (y[i] - predicted) * (y[i] - predicted);
  }
  model.rms_left_out = std::sqrt(square / n);
  const int dof = static_cast<int>(y.size()) - n_parameters;
  model.parameters = words(fit, fit.square * (1.0 + f_quantile(dof) / dof));
  return model;
}

/// Range of a lag, or of a coefficient, over all fits whose sum of squares is below the limit.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void take(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

std::string hours(int lag, const Range& range) {
  const auto edge = [](double s) { return fmt::format("{:.1f}", s / 3600.0); };
  return fmt::format("{} h ({} to {} h{})", edge(lag_s(lag)), edge(range.low), edge(range.high),
                     range.low <= lag_s(0) && range.high >= lag_s(kLags - 1) ? ", all that was tried" : "");
}

}  // namespace

std::vector<double> lagged(const TimeSeries& ambient, double lag, std::span<const double> time_s) {
  std::vector<double> result;
  for (double t_s : time_s) {
    double body = ambient.value.front(), now_s = ambient.time_s.front();
    const auto follow = [&](double from, double to, double dt_s) {
      if (!(dt_s > 0.0)) return;
      if (lag == 0.0) {
        body = to;
        return;
      }
      const double slope = (to - from) / dt_s, decay = std::exp(-dt_s / lag);
      body = to - slope * lag + (body - from + slope * lag) * decay;
    };
    for (std::size_t i = 1; i < ambient.time_s.size() && now_s < t_s; ++i) {
      const double end_s = std::min(t_s, ambient.time_s[i]), span_s = ambient.time_s[i] - ambient.time_s[i - 1];
      const double to =
          ambient.value[i - 1] + (ambient.value[i] - ambient.value[i - 1]) * (end_s - ambient.time_s[i - 1]) / span_s;
      follow(ambient.value[i - 1], to, end_s - now_s);
      now_s = end_s;
    }
    follow(ambient.value.back(), ambient.value.back(), t_s - now_s);
    result.push_back(body);
  }
  return result;
}

std::vector<AmbientModel> compare_ambient_models(const TimeSeries& ambient, std::span<const double> time_s,
                                                 std::span<const double> values, double table, double scale) {
  if (values.size() < 6)
    throw InputError(
        fmt::format("{} readings are too few to compare models of the ambient; six are required", values.size()));
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  const auto column = [&](double lag) {
    const std::vector<double> t = lagged(ambient, lag, time_s);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(t.data(), y.size()));
  };
  const Eigen::VectorXd at_once = column(0.0);
  Columns late;
  for (int i = 0; i < kLags; ++i) late.push_back(column(lag_s(i)));

  const Search line = [&](int out, const auto& take) {
    const Fit fit = fit_linear({&at_once}, y, out);
    take(fit, predicted_at(fit, {&at_once}, out));
  };
  const Search one_lag = [&](int out, const auto& take) {
    for (int i = 0; i < kLags; ++i) {
      const auto& of = late[static_cast<std::size_t>(i)];
      Fit fit = fit_linear({&of}, y, out);
      fit.lag_1 = i;
      take(fit, predicted_at(fit, {&of}, out));
    }
  };
  const Search two_lags = [&](int out, const auto& take) {
    for (int i = 0; i < kLags; ++i) {
      for (int k = 0; k < kLags; ++k) {
        const Eigen::VectorXd of = table * late[static_cast<std::size_t>(i)] - scale * late[static_cast<std::size_t>(k)];
        Fit fit = fit_linear({}, y - of, out);
        fit.lag_1 = i;
        fit.lag_2 = k;
        take(fit, predicted_at(fit, {}, out) + (out >= 0 ? of[out] : 0.0));
      }
    }
  };
  const auto words_of_line = [&](const Fit& fit, double limit) {
    const double xx = (at_once.array() - at_once.mean()).square().sum();
    const double half = std::sqrt((limit - fit.square) / xx);
    return fmt::format("slope {:.1f} per K ({:.1f} to {:.1f})", fit.coefficients[1], fit.coefficients[1] - half,
                       fit.coefficients[1] + half);
  };
  const auto words_of_lag = [&](const Fit& fit, double limit) {
    Range lag;
    one_lag(-1, [&](const Fit& f, double) {
      if (f.square <= limit) lag.take(lag_s(f.lag_1));
    });
    return fmt::format("slope {:.1f} per K, lag {}", fit.coefficients[1], hours(fit.lag_1, lag));
  };
  const auto words_of_two = [&](const Fit& fit, double limit) {
    Range of_table, of_scale;
    two_lags(-1, [&](const Fit& f, double) {
      if (f.square > limit) return;
      of_table.take(lag_s(f.lag_1));
      of_scale.take(lag_s(f.lag_2));
    });
    return fmt::format("lag of the table {}, of the scale {}", hours(fit.lag_1, of_table), hours(fit.lag_2, of_scale));
  };
  return {judged("straight line", 2, line, y, words_of_line), judged("one lag", 3, one_lag, y, words_of_lag),
          judged("table less scale, two lags", 3, two_lags, y, words_of_two)};
}

}  // namespace driftwright::compensation
