#pragma once
// What a few readings of a table's error and the ambient temperature can carry: a straight line, one lag, table less scale with two.

#include <span>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::compensation {

/// A body that follows the ambient with a lag: lag dT/dt = T_ambient - T, settled at the first value before the first time.
/// Exact for an ambient that is linear between its rows. @param lag_s  0: the ambient itself
[[nodiscard]] std::vector<double> lagged(const TimeSeries& ambient, double lag_s, std::span<const double> time_s);

struct AmbientModel {
  std::string name = {};
  int n_parameters = 0;
  double rms = 0.0;           ///< fitted to all readings, in their unit
  double rms_left_out = 0.0;  ///< each reading by a fit to the others
  double r_squared = 0.0;
  std::string parameters = {};  ///< in words, each with what 95 % of certainty leaves of it
};

/// Readings y(t) = a + b T_ambient; a + b T_lag; a + table T_lag1 - scale T_lag2.
/// Lags are searched between 0.1 h and 200 h. Intervals are where the sum of squares stays below its F quantile.
/// @param values        e.g. in um; at least six
/// @param table, scale  what both grow per K, from their expansions and length; free, they would run off with two lags that are
///                      nearly alike
/// @throws InputError  for fewer than six readings
[[nodiscard]] std::vector<AmbientModel> compare_ambient_models(const TimeSeries& ambient, std::span<const double> time_s,
                                                               std::span<const double> values, double table, double scale);

}  // namespace driftwright::compensation
