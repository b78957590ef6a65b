#pragma once
// A linear system's run, kept: machines that differ from it a little are answered to first order without a decomposition of their own.

#include <optional>

#include "solver/decomposition.hpp"
#include "solver/kept_run.hpp"

namespace driftwright::solver {

/// The course of M z' = -K z + f0 + t f1 through its stretches, and what a little more of K, M, f or z(0) does to it:
///
///     M δz' = -K δz + δf - δK z - δM z',   z = V y,   G = -V'δK V + V'δM V Λ
///     δy_i = e_i (δy0 + C y0)_i + p_i (h0 + C f0)_i + q_i (h1 + C f1)_i - (C y)_i,   C_ij = G_ij / (λ_j - λ_i)
///     e = e^{-λt},  p = ∫ e,  q = ∫ p,   h = V'(δf - δM V (V'f))
///
/// with V of the decomposition and y0, f0, f1 in it. Pairs of equal λ have the limit of this: products of matrices, and no decomposition.
/// Source: derivative of the matrix exponential, Najfeld & Havel, Adv. Appl. Math. 16 (1995) 321-375.
class Course final : public KeptRun {
 public:
  /// As Propagator::course() asks for it. Nothing is borrowed.
  /// @param decompositions  of the system, which is linear
  /// @returns nothing for a run through more than kMostSets sets of coefficients, each of which is a decomposition to keep
  [[nodiscard]] static std::optional<Course> of(const ReducedSystem& system, Decompositions& decompositions,
                                                const Cyclogram& cyclogram, const TimeSeries& ambient,
                                                const std::vector<double>& output_s, const Eigen::VectorXd& start);
  static constexpr std::size_t kMostSets = 64;

  /// To first order in how the other differs.
  /// @returns nothing where the other is not linear or passes other stretches of time: such a one is to be run by itself
  [[nodiscard]] std::optional<Eigen::MatrixXd> states_of(const ReducedSystem& other, const Cyclogram& cyclogram,
                                                         const TimeSeries& ambient,
                                                         const Eigen::VectorXd& start) const override;

 private:
  Course() = default;

  /// e^{-λt} and its integrals at some times, n x n_times: p = ∫ e, q = ∫ p; those of e^{-λ(t-s)} over 1, p and q: te, r = ∫ p, s = ∫ q.
  struct Exponentials {
    Eigen::ArrayXXd e, p, q, te, r, s;
  };
  struct Stretch {
    double start_s = 0.0, end_s = 0.0;
    std::size_t decomposition = 0;
    Eigen::VectorXd y0, f0, f1;  ///< in the eigenvectors
    Eigen::Index first = 0;      ///< output
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
