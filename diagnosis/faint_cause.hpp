#pragma once
// A cause that is rarer than chance has to offer, and yet worth less than its prior costs.
//
// Evidence charges a cause for every size and time that it might have had: a shift of 0.3 µm where 15 µm were to be feared pays 6 nats, and as much again for its
// time. Whether something is wrong at all is another question, and each candidate answers it by itself: how many faultless machines offer it as much (chance.hpp). What is
// rare for one of them, and rare for the rarest of all of them, is suspected; named it is not, nor written.

#include "diagnosis/chance.hpp"

namespace driftwright::diagnosis {

/// What a search has that found nothing by evidence.
struct NothingFound {
  const Fitter& fitter;  ///< settled at `without`
  const std::vector<Candidate>& candidates;
  const std::vector<Score>& scores;  ///< of all candidates on top of `without`
  const Chances& chances;
  const Fit& without;
};

/// A cause and the fit with it.
struct FaintCause {
  Finding finding;  ///< its evidence may be below nothing
  Fit fit;
};

/// The rarest candidate, fitted in full; others share the odds by how rare they are. None where chance offers as much too often. Laws whose times were
/// read off the readings have no part in it.
/// @param wrongly_suspected  share of faultless machines at which that may happen
[[nodiscard]] std::optional<FaintCause> faint_cause(const NothingFound& search, double wrongly_suspected);

}  // namespace driftwright::diagnosis
