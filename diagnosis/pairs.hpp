#pragma once
// Two causes at once, by linear theory: where a third one does best by itself in the place of both, a search that takes one after the other does not come to them.

#include "diagnosis/signatures.hpp"

namespace driftwright::diagnosis {

/// Laws of two candidates.
struct ScoredPair {
  Score first, second;   ///< `start` as it is beside the other; their own gains and falls are not said
  double gain = -1e300;  ///< of both together, their prices and those of their candidates' laws paid [nats]
};

/// The best pairs, best first, each of other candidates. The first is one of those that bring most by themselves.
/// @param signatures, projection  as scores() has them, of a fit without either
[[nodiscard]] std::vector<ScoredPair> best_pairs(const std::vector<Candidate>& candidates,
                                                 const std::vector<Signature>& signatures, const Projection& projection,
                                                 std::size_t n);

}  // namespace driftwright::diagnosis
