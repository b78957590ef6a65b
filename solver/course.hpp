#pragma once
// Stores the run of a linear system, so that systems that differ slightly from it can be solved to first order without a new
// decomposition.

#include <optional>

#include "solver/decomposition.hpp"
#include "solver/kept_states.hpp"

namespace driftwright::solver {

/// The course of M z' = -K z + f0 + t f1 through its stretches, and its change for small changes of K, M, f or z(0):
///
///     M δz' = -K δz + δf - δK z - δM z',   z = V y,   G = -V'δK V + V'δM V Λ
///     δy_i = e_i (δy0 + C y0)_i + p_i (h0 + C f0)_i + q_i (h1 + C f1)_i - (C y)_i,   C_ij = G_ij / (λ_j - λ_i)
///     e = e^{-λt},  p = ∫ e,  q = ∫ p,   h = V'(δf - δM V (V'f))
///
/// with V of the decomposition, and y0, f0, f1 in its coordinates. Pairs of equal λ use the limit. This needs matrix
/// products only, no decomposition.
/// Source: derivative of the matrix exponential, Najfeld & Havel, Adv. Appl. Math. 16 (1995) 321-375.
class Course final : public KeptStates {
 public:
  /// Arguments as of Propagator::course(). Nothing is borrowed.
  /// @param decompositions  of the system, which must be linear
  /// @returns none for a run through more than kMostSets sets of coefficients, each of which needs a stored decomposition
  [[nodiscard]] static std::optional<Course> of(const ReducedSystem& system, Decompositions& decompositions,
                                                const Cyclogram& cyclogram, const TimeSeries& ambient,
                                                const std::vector<double>& output_s, const Eigen::VectorXd& start);
  static constexpr std::size_t kMostSets = 64;

  /// States of the other system, to first order in its difference.
  /// @returns none if the other system is not linear or has other stretches of time; it then needs its own run
  [[nodiscard]] std::optional<Eigen::MatrixXd> states_of(const ReducedSystem& other, const Cyclogram& cyclogram,
                                                         const TimeSeries& ambient,
                                                         const Eigen::VectorXd& start) const override;

 private:
  Course() = default;

  /// e^{-λt} and its integrals at some times, n x n_times: p = ∫ e, q = ∫ p; te, r, s = ∫ e^{-λ(t-s)} ds times e, p and q at
  /// s.
  struct Exponentials {
    Eigen::ArrayXXd e, p, q, te, r, s;
  };
  struct Stretch {
    double start_s = 0.0, end_s = 0.0;
    std::size_t decomposition = 0;
    Eigen::VectorXd y0, f0, f1;  ///< in the eigenvectors
    Eigen::Index first = 0;      ///< index of the first output
    Exponentials at;             ///< at the outputs, then at the stretch's end
    Eigen::MatrixXd y;           ///< at the same times
  };
  [[nodiscard]] static Exponentials exponentials(const Eigen::VectorXd& lambda_1_s, const std::vector<double>& times_s);

  Eigen::MatrixXd conduction_, mass_;
  Eigen::VectorXd start_;
  std::vector<Decomposition> decompositions_;
  std::vector<Stretch> stretches_;
};

}  // namespace driftwright::solver
