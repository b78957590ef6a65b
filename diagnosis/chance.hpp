#pragma once
// How much evidence candidates have where nothing is wrong, the best of them and each: by simulated readings of the machine at hand.

#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

/// What chance has to offer, all candidates together and one by one.
struct Chances {
  Chance best;  ///< evidence of the best candidate, the price of their number paid
  /// Evidence that each candidate has at one faultless machine in five, its laws paid and the price of the number of candidates not; infinite where nothing tells of it. Laws
  /// whose times were read off the readings have no part in it.
  std::vector<double> usual;
  Chance rarest;  ///< rarity() of the rarest candidate
};

/// How rare it is that a candidate has as much evidence where nothing is wrong: -log of the share of faultless machines. Beyond what is usual the share falls by e a nat, as that of a
/// likelihood ratio does. Evidence pays for every size that a fault might have had; chance does not ask what it might have been.
[[nodiscard]] double rarity(double gain, double usual);

/// Readings are drawn as the scenario has them: its uncertain numbers from their priors, noise as the channels have it. To each draw all candidates are held, by
/// the linear theory, and the best of them is kept. Their distribution is taken for Gumbel's, by its mean and spread; 200 draws say its 99 % point to a third of a nat.
/// @param columns  signatures of all candidates on top of a fit without claims
/// Source: Davies, Biometrika 74 (1987) 33-43, why the best of many is not chi-squared; Gumbel (1958); Westfall & Young, Resampling-Based Multiple Testing (1993), the
/// rarest of many by simulation.
[[nodiscard]] Chances chances_of(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                 const std::vector<Signature>& columns, const Fit& at);

}  // namespace driftwright::diagnosis
