#pragma once
// How far two explanations are apart in readings that are still to come.
//
//     H says y ~ N(m, Σ), Σ = 1 + A A'    whitened readings; A = J L, L L' = C: what is not known of H's numbers
//     d'² / 8 = 1/8 δ' Σ̄⁻¹ δ + 1/2 log( det Σ̄ / sqrt(det Σ_1 det Σ_2) ),   δ = m_1 - m_2,   Σ̄ = (Σ_1 + Σ_2) / 2
//
// The Bhattacharyya distance, written as a d': where both covariances are alike it is the distance of the means in standard deviations. An
// explanation that says little also counts: readings where the other one said they would be speak for that. The evidence picks
// the wrong one in less than 1/2 exp(-d'² / 8) of the records.
// Source: Kailath, IEEE Trans. Commun. Technol. 15 (1967) 52-60.

#include <set>

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

/// A hypothesis as the data so far leave it.
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

/// @param ahead  of runs that are still to come, without linear columns, its scatter's slopes settled near the explanation
/// @throws SolveError  where the machine has no solution there
[[nodiscard]] Outlook outlook(const Fitter& ahead, const Explanation& of, Twin::Workspace& workspace);

/// The part of an outlook that some channels see.
[[nodiscard]] Outlook only(const Outlook& of, const Comparison& comparison, const std::set<std::string>& channels);

/// d' >= 0, the same both ways, by the formula above. Both are of the same readings.
[[nodiscard]] double discrimination(const Outlook& a, const Outlook& b);

}  // namespace driftwright::diagnosis
