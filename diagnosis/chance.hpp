#pragma once
// How much evidence the best of all candidates has where nothing is wrong: by simulated readings of the machine at hand.

#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

/// Readings are drawn as the scenario has them: its uncertain numbers from their priors, noise as the channels have it. To each draw all candidates are held, by
/// the linear theory, and the best of them is kept. Their distribution is taken for Gumbel's, by its mean and spread; 200 draws say its 99 % point to a third of a nat.
/// @param columns  signatures of all candidates on top of a fit without claims
/// Source: Davies, Biometrika 74 (1987) 33-43, why the best of many is not chi-squared; Gumbel (1958).
[[nodiscard]] Chance chance_of(const Fitter& fitter, const std::vector<Candidate>& candidates,
                               const std::vector<Signature>& columns, const Fit& at);

}  // namespace driftwright::diagnosis
