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

#include <set>

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

/// A hypothesis with the numbers that the data so far give.
struct Explanation {
  Hypothesis hypothesis;
  Eigen::VectorXd x;           ///< scatter, then the knobs of each claim
  Eigen::MatrixXd covariance;  ///< of x
  [[nodiscard]] Eigen::VectorXd claim_x(Eigen::Index n_scatter) const { return x.tail(x.size() - n_scatter); }
};

struct Outlook {
  Eigen::VectorXd mean;  ///< whitened readings
  Eigen::MatrixXd root;  ///< A, n_readings x n_numbers
};

/// @param ahead  for future runs, without linear columns, with the slopes of its scatter computed near the explanation
/// @throws SolveError  if the machine has no solution there
[[nodiscard]] Outlook outlook(const Fitter& ahead, const Explanation& of, Twin::Workspace& workspace);

/// The part of an outlook in some channels.
[[nodiscard]] Outlook only(const Outlook& of, const Comparison& comparison, const std::set<std::string>& channels);

/// d' >= 0, symmetric, by the formula above. Both arguments must be for the same readings.
[[nodiscard]] double discrimination(const Outlook& a, const Outlook& b);

}  // namespace driftwright::diagnosis
