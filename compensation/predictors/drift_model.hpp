#pragma once
// A formula for the drift that a control can evaluate: what every kind of regression ends in.

#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Drift as a sum of readings and their first-order lags,
///
///     d(t) = intercept + sum_j c_j L_j[x_j^p_j](t),     lag_j dL/dt = x_j^p_j - L,   L = x_j^p_j where lag_j = 0
///
/// exact where x is constant (speeds hold until their next row) or, of temperatures, linear to second order: over a step h the lag
/// moves by (1 - exp(-h / lag)) towards the speed at its start, or towards the mean of the readings at both ends. Lags of speeds
/// start from standstill (0), those of temperatures settled at the first reading. A term with `is_running` has 1 while x_j is not 0
/// in place of x_j^p_j, and power 1: the memory of on and off. Evaluated by control/drift_correction.c, as on a control.
struct DriftModel {
  struct Term {
    std::string input;  ///< channel
    std::string unit;
    double coefficient = 0.0;  ///< target_unit per unit^power
    int power = 1;             ///< >= 1
    double lag_s = 0.0;        ///< >= 0
    bool is_running = false;   ///< 1 while the input is not 0, in place of its value
  };
  std::string kind;  ///< "ridge regression", in words
  std::string target, target_unit;
  double intercept = 0.0;
  std::vector<Term> terms;
  /// Temperatures count from the first reading of the run, and so does the drift.
  bool from_start = false;

  /// Channels that it reads, each once, in the order of the terms.
  [[nodiscard]] std::vector<std::string> inputs() const;
  /// Per row of the record; NaN where an input is missing: its lag then waits. A value that is not finite is missing.
  /// @throws InputError  when the record lacks an input or has it in another unit
  [[nodiscard]] std::vector<double> predict(const Record& record) const;
};

/// True for channels that hold their value until their next row and start from 0: speeds.
[[nodiscard]] bool is_drive(const std::string& unit);

/// L[x^power] of one channel, per row. @param lag_s  >= 0
[[nodiscard]] std::vector<double> lagged(std::span<const double> time_s, std::span<const double> x, int power, double lag_s,
                                         bool is_drive);

/// What a term takes powers and lags of: x, or, where it is of running and rest, 1 where x is not 0; NaN stays.
[[nodiscard]] std::vector<double> taken_by(const DriftModel::Term& term, std::vector<double> x);

/// The record with its temperatures, and `target`, minus their first values that are not missing.
[[nodiscard]] Record counted_from_start(Record record, const std::string& target);

}  // namespace driftwright::compensation
