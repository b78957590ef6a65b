#pragma once
// Exact solution of linear reduced systems in time: in each stretch of constant drive and linear ambient temperature the
// solution is a sum of exponentials, so there are no steps and no error except rounding.

#include "base/cyclogram.hpp"
#include "solver/course.hpp"

namespace driftwright::solver {

/// Runs cyclograms on one linear reduced system. In each stretch M z' = -K z + f0 + t f1, and with K V = M V Λ, V'M V = 1
///
///     z(t) = V [a + b t + e^{-Λt} (V'M z0 - a)],   b = Λ⁻¹ V'f1,   a = Λ⁻¹ (V'f0 - b)
///
/// Decompositions of K are stored for the latest coefficients: if films do not change with speed there is one for all
/// sections of all cyclograms. Not thread-safe.
class Propagator {
 public:
  /// @param system  borrowed
  /// @throws std::logic_error  for a system that is not linear
  explicit Propagator(const ReducedSystem& system);

  /// Runs a cyclogram from `start` (reduced state at t = 0).
  ///
  /// @param ambient       ambient temperature minus the reference temperature [K]
  /// @param output_s   times of the outputs, increasing, within the cyclogram
  /// @param with_heat  true: also computes heat_J and stored_J, which are otherwise empty
  /// @param states     unless null, receives the reduced states at the outputs, size x n_times
  /// @param from_s     as TransientOptions::from_s
  [[nodiscard]] Trajectory run(const Cyclogram& cyclogram, const TimeSeries& ambient, const std::vector<double>& output_s,
                               const Eigen::VectorXd& start, bool with_heat = false, Eigen::MatrixXd* states = nullptr,
                               double from_s = 0.0);

  /// The same over stretches of a cyclogram (stretches_of()), from the start of the first one on.
  [[nodiscard]] Trajectory run(const std::vector<LinearStretch>& stretches, const TimeSeries& ambient,
                               const std::vector<double>& output_s, const Eigen::VectorXd& start, bool with_heat = false,
                               Eigen::MatrixXd* states = nullptr);

  /// The same run, stored for computing similar systems; none if it is too large to store.
  [[nodiscard]] std::optional<Course> course(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                             const std::vector<double>& output_s, const Eigen::VectorXd& start) {
    return Course::of(system_, decompositions_, cyclogram, ambient, output_s, start);
  }

  [[nodiscard]] int n_decompositions() const { return decompositions_.n_made(); }

 private:
  struct Solution;  // z over one stretch, in the eigenvectors

  const ReducedSystem& system_;
  Decompositions decompositions_;
};

}  // namespace driftwright::solver
