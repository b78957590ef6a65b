#pragma once
// How well future readings would distinguish two explanations.
//
// H says y ~ N(m, Σ), Σ = 1 + A A'    whitened readings; A = J L, L L' = C: uncertainty of H's numbers
//     d'² / 8 = 1/8 δ' Σ̄⁻¹ δ + 1/2 log( det Σ̄ / sqrt(det Σ_1 det Σ_2) ),   δ = m_1 - m_2,   Σ̄ = (Σ_1 + Σ_2) / 2
//
// The Bhattacharyya distance, expressed as a d': for equal covariances it is the distance of the means in standard
// deviations. A vague explanation also counts: readings where the other one predicted them speak for the other. The
// evidence picks the wrong explanation in less than 1/2 exp(-d'² / 8) of the records.
// Source: Kailath, IEEE Trans. Commun. Technol. 15 (1967) 52-60.
//
// What readings are expected to tell of which of several statements holds, each one or more explanations i with the
// weights w_i (their sum W_s over a statement s), is at least
//
//     I = -Σ_s W_s log Σ_t W_t c_st,   c_ss = 1,   c_st = min(1, Σ_{i in s, j in t} sqrt(w_i w_j / (W_s W_t)) c_ij)
//
// with the affinities c_ij = exp(-d'_ij² / 8). Source: Kolchinsky and Tracey, Entropy 19 (2017) 361, with the
// Bhattacharyya distance; the root of a sum is at most the sum of the roots.

#include <set>

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

/// A hypothesis with the numbers that the data so far give.
struct Explanation {
  Hypothesis hypothesis;
  Eigen::VectorXd x;           ///< scatter, then the knobs of each claim
  Eigen::MatrixXd covariance;  ///< of x
  double log_evidence = 0.0;   ///< of the data so far
  [[nodiscard]] Eigen::VectorXd claim_x(Eigen::Index n_scatter) const { return x.tail(x.size() - n_scatter); }
};

struct Outlook {
  Eigen::VectorXd mean;  ///< whitened readings
  Eigen::MatrixXd root;  ///< A, n_readings x n_numbers
};

/// @param ahead  for future runs, without linear columns, with the slopes of its scatter computed near the explanation
/// @throws SolveError  if the machine has no solution there
[[nodiscard]] Outlook outlook(const Fitter& ahead, const Explanation& of, Twin::Workspace& workspace);

/// d' >= 0, symmetric, by the formula above. Both arguments must be for the same readings.
[[nodiscard]] double discrimination(const Outlook& a, const Outlook& b);

/// Several outlooks of the same readings as products of their columns, channel by channel: pairs seen by any channels cost
/// no further pass over the readings.
class OutlookProducts {
 public:
  OutlookProducts(const std::vector<Outlook>& outlooks, const Comparison& comparison);
  /// exp(-power d'² / 8) of each pair, as these channels see them.
  [[nodiscard]] Eigen::MatrixXd affinities(const std::set<std::string>& channels, double power) const;

 private:
  std::vector<Eigen::Index> first_;  ///< of each outlook's columns, and their number
  std::map<std::string, Eigen::MatrixXd> of_channel_;
};

/// I [nats] of the formula above; without affinities, W's entropy.
/// @param weight    of each explanation; their sum is 1
/// @param statement of each explanation, a number
[[nodiscard]] double expected_information(const std::vector<double>& weight, const std::vector<std::size_t>& statement,
                                          const Eigen::MatrixXd& affinity);

}  // namespace driftwright::diagnosis
