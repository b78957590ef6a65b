#pragma once
// A formula for the drift that a control can evaluate: the result of every kind of regression.

#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Drift as a sum of readings and their first-order lags,
///
///     d(t) = intercept + sum_j c_j L_j[x_j^p_j](t),     lag_j dL/dt = x_j^p_j - L,   L = x_j^p_j where lag_j = 0
///
/// exact if x is constant (speeds keep their value until the next row) or, for temperatures, linear to second order: over a
/// step h the lag moves by (1 - exp(-h / lag)) towards the speed at its start, or towards the mean of the readings at both
/// ends. Lags of speeds start at zero (standstill), those of temperatures at the first reading. A term with `is_running`
/// uses 1 while x_j is not 0 instead of x_j^p_j, and power 1: it describes on and off. control/drift_correction.c evaluates
/// the formula, here as on a control.
struct DriftModel {
  struct Term {
    std::string input;  ///< channel
    std::string unit;
    double coefficient = 0.0;  ///< target_unit per unit^power
    int power = 1;             ///< >= 1
    double lag_s = 0.0;        ///< >= 0
    bool is_running = false;   ///< uses 1 while the input is not 0, instead of its value
  };
  std::string kind;  ///< "ridge regression", in words
  std::string target, target_unit;
  double intercept = 0.0;
  std::vector<Term> terms;
  /// Temperatures and the drift count from the first reading of the run.
  bool from_start = false;

  /// The channels that it reads, each once, in the order of the terms.
  [[nodiscard]] std::vector<std::string> inputs() const;
  /// The drift per row of the record; NaN where an input is missing: its lag is then kept. A value that is not finite is
  /// missing.
  /// @throws InputError  when the record lacks an input or has it in another unit
  [[nodiscard]] std::vector<double> predict(const Record& record) const;
};

/// True for channels that keep their value until the next row and start from 0: speeds.
[[nodiscard]] bool is_drive(const std::string& unit);

/// L[x^power] of one channel, per row. @param lag_s  >= 0
[[nodiscard]] std::vector<double> lagged(std::span<const double> time_s, std::span<const double> x, int power, double lag_s,
                                         bool is_drive);

/// The signal whose powers and lags a term uses: x, or with `is_running` 1 where x is not 0; NaN stays NaN.
[[nodiscard]] std::vector<double> taken_by(const DriftModel::Term& term, std::vector<double> x);

/// The record with its temperatures and `target` minus their first valid values.
[[nodiscard]] Record counted_from_start(Record record, const std::string& target);

}  // namespace driftwright::compensation
