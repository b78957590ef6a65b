#pragma once
// A linear reduced system in the eigenvectors of its K, with one decomposition per set of coefficients.

#include "solver/decays.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// The system in the eigenvectors V of K = K0 + Σ c_e G_e: K V = M V Λ, V'M V = 1.
struct Decomposition {
  Eigen::VectorXd coefficient;  ///< of each exchange; used as the key
  Eigen::VectorXd lambda_1_s;
  Eigen::MatrixXd vectors;                ///< V
  Eigen::MatrixXd to_modes;               ///< V'M
  Eigen::MatrixXd outputs;                ///< n_outputs x size
  Eigen::MatrixXd loads;                  ///< size x n_sources
  Eigen::VectorXd to_ambient, offset;     ///< Σ c_e g_e, Σ c_e o_e
  Eigen::MatrixXd flows;                  ///< c_e flow_e', n_exchanges x size
  Eigen::VectorXd ambient_W_K, offset_W;  ///< c_e ambient_sum_e, c_e offset_sum_e
  Eigen::RowVectorXd stored_J_K;          ///< 1'M V
  Decays decays;                          ///< e^{-Λt}
};

/// Stores the latest decompositions. Not thread-safe.
class Decompositions {
 public:
  /// @param system  borrowed
  explicit Decompositions(const ReducedSystem& system);

  /// The decomposition of these coefficients; valid until the next call. @param with_flows false: `flows`, `ambient_W_K` and
  /// `offset_W` may be empty
  Decomposition& at(const Eigen::VectorXd& coefficient, bool with_flows = true);
  [[nodiscard]] int n_made() const { return n_made_; }

 private:
  void add_flows(Decomposition& d) const;

  const ReducedSystem& system_;
  bool unit_mass_;
  Eigen::MatrixXd loads_;            ///< of all sources, size x n_sources
  std::vector<Decomposition> kept_;  ///< the oldest is replaced
  std::size_t oldest_ = 0;
  int n_made_ = 0;
};

/// The heat flows of a system: sources, then exchanges.
[[nodiscard]] std::vector<HeatFlow> flows_of(const ReducedSystem& system);

}  // namespace driftwright::solver
