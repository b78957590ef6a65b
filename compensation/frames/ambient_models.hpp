#pragma once
// Models of a table's error that a few readings and the ambient temperature can support: a straight line, one lag, table
// less scale with two lags.

#include <span>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::compensation {

/// A body that follows the ambient with a lag: lag dT/dt = T_ambient - T, settled at the first value before the first time.
/// Exact for an ambient that is linear between its rows. @param lag_s  0: the ambient itself
[[nodiscard]] std::vector<double> lagged(const TimeSeries& ambient, double lag_s, std::span<const double> time_s);

/// A fitted model and its error.
struct AmbientModel {
  std::string name = {};
  int n_parameters = 0;
  double rms = 0.0;           ///< fitted to all readings, in their unit
  double rms_left_out = 0.0;  ///< each reading predicted by a fit to the others
  double r_squared = 0.0;
  std::string parameters = {};  ///< in words, each with its 95 % interval
};

/// Fits three models: y(t) = a + b T_ambient; a + b T_lag; a + table T_lag1 - scale T_lag2.
/// Lags are searched between 0.1 h and 200 h. An interval contains the values whose sum of squares is below its F quantile.
/// @param values        e.g. in um; at least six
/// @param table, scale  growth of each per K, from expansion and length. They are not fitted, because with two lags that are
///                      nearly equal they would diverge
/// @throws InputError  for fewer than six readings
[[nodiscard]] std::vector<AmbientModel> compare_ambient_models(const TimeSeries& ambient, std::span<const double> time_s,
                                                               std::span<const double> values, double table, double scale);

}  // namespace driftwright::compensation
