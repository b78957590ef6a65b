#pragma once
// Linear reduced systems in time, exactly: in each stretch of constant drive and linear hall temperature the solution is a
// sum of exponentials, so nothing is stepped and nothing but rounding is lost.

#include <optional>

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Runs cyclograms on one linear reduced system with M = 1. In each stretch z' = -K z + f0 + t f1, and with K = V Λ V'
///
///     z(t) = V [a + b t + e^{-Λt} (V'z0 - a)],   b = Λ⁻¹ V'f1,   a = Λ⁻¹ (V'f0 - b)
///
/// Decompositions of K are kept for the coefficients met last: where films do not change with speed there is one for all
/// sections of all cyclograms. One thread at a time.
class Propagator {
 public:
  /// @param system  borrowed
  /// @throws std::logic_error  for a system that is not linear or whose mass is not the unit matrix
  explicit Propagator(const ReducedSystem& system);

  /// Runs a cyclogram from `start` (reduced state at t = 0).
  ///
  /// @param hall       hall temperature minus the reference temperature [K]
  /// @param output_s   times of the outputs, increasing, within the cyclogram
  /// @param with_heat  also heat_J and stored_J of the result, which otherwise stay empty
  /// @param states     unless null, the reduced states at the outputs, size x n_times
  [[nodiscard]] Trajectory run(const Cyclogram& cyclogram, const TimeSeries& hall, const std::vector<double>& output_s,
                               const Eigen::VectorXd& start, bool with_heat = false, Eigen::MatrixXd* states = nullptr);

  [[nodiscard]] int n_decompositions() const { return n_decompositions_; }

 private:
  /// The system in the eigenvectors of K at one set of coefficients.
  struct Decomposition {
    Eigen::VectorXd coefficient;  ///< of each exchange: the key
    Eigen::VectorXd lambda_1_s;
    Eigen::MatrixXd vectors;             ///< V
    Eigen::MatrixXd outputs;             ///< n_outputs x size
    Eigen::MatrixXd loads;               ///< size x n_sources
    Eigen::VectorXd to_hall, offset;     ///< Σ c_e g_e, Σ c_e o_e
    Eigen::MatrixXd flows;               ///< c_e flow_e', n_exchanges x size
    Eigen::VectorXd hall_W_K, offset_W;  ///< c_e hall_sum_e, c_e offset_sum_e
    Eigen::RowVectorXd stored_J_K;       ///< 1'M V
  };
  /// z over one stretch, in the eigenvectors.
  struct Solution;
  const Decomposition& decompose(const Eigen::VectorXd& coefficient);

  const ReducedSystem& system_;
  std::vector<Decomposition> kept_;  ///< the last met; the oldest is replaced
  std::size_t oldest_ = 0;
  int n_decompositions_ = 0;
};

}  // namespace driftwright::solver
