#pragma once
// Sums of exponentials at many times: y(t) = c0 + c1 t + c2 t² + Σ_i w_i e^{-λ_i t}.
//
// At times one interval h apart all sums with the same λ share one table of 1, j, j² and e^{-λ_i j h}, and their values are
// one product of matrices. Modes that have decayed below rounding do not take part.

#include <Eigen/Core>
#include <span>
#include <vector>

namespace driftwright::solver {

/// One sum a row.
struct SumsOfDecays {
  Eigen::MatrixXd factors;  ///< of t², 1, t and of each e^{-λ_i t}: n_sums x (kPowers + n_modes)
  static constexpr Eigen::Index kPowers = 3;

  [[nodiscard]] auto curve() { return factors.col(0); }
  [[nodiscard]] auto constant() { return factors.col(1); }
  [[nodiscard]] auto slope() { return factors.col(2); }
  /// The sums at t. @param decay  e^{-λ t}
  [[nodiscard]] Eigen::VectorXd at(double t_s, const Eigen::VectorXd& decay) const;
  /// The same sums of t - by_s. @param decay  e^{-λ by_s}
  [[nodiscard]] SumsOfDecays from(double by_s, const Eigen::VectorXd& decay) const;
};

/// The tables for one set of λ, none of them changed later: one an interval, of the latest intervals. Not thread-safe.
class Decays {
 public:
  /// The sums at all times, one column each.
  /// @param lambda_1_s  increasing, the same at each call
  /// @param times_s     increasing; those one interval apart are cheap
  /// @param start_s     the time of t = 0
  /// @param out         n_sums x n_times
  void values(const SumsOfDecays& sums, const Eigen::VectorXd& lambda_1_s, std::span<const double> times_s, double start_s,
              Eigen::Ref<Eigen::MatrixXd> out);

  /// Columns of the longest table; kMostTimes + 1 at most, however long the run is.
  [[nodiscard]] Eigen::Index n_columns() const;
  /// One table serves so many times; later ones begin it again, which costs one more exponential per mode. Each of 64 stored
  /// decompositions of 50 states then takes 0.2 MB a table.
  static constexpr Eigen::Index kMostTimes = 512;
  /// Rows of a run lie one interval apart, or a part of it after a change (diagnosis/measured_run.cpp).
  static constexpr std::size_t kMostTables = 2;

 private:
  struct Table {
    double step_s = -1.0;
    Eigen::MatrixXd values;            ///< column j: j², 1, j, e^{-λ_i j h}
    std::vector<Eigen::Index> n_used;  ///< rows of each column that are not negligible
  };
  const Table& require(const Eigen::VectorXd& lambda_1_s, double step_s, Eigen::Index n_columns);

  std::vector<Table> tables_;  ///< the one used last is the last
};

}  // namespace driftwright::solver
