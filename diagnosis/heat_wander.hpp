#pragma once
// Where a model errs: heat that comes and goes in its bodies of which nothing is known but how much and for how long, as noise of the process.
//
//     M z' = -K z + Σ b_i u_i(t),   u_i: an Ornstein-Uhlenbeck process (Matérn 1/2) of standard deviation q_i and one time constant
//
// q by maximum likelihood (expectation and maximisation of variance components), the time constant by trying several. A body whose q stays
// large is one of which the model misses something; readings that its heat bends say little of anything else.
// Source: Kristensen, Madsen & Jorgensen, Automatica 40 (2004) 225-237; Dempster, Laird & Rubin, J. R. Stat. Soc. B 39 (1977) 1-38.

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

/// A body's part of what is missing.
struct BodyWander {
  effects::Body body;
  double sd_W = 0.0;
  double share = 0.0;  ///< of what all of them do to the readings, in units of noise, squared
};

struct HeatWander {
  double time_s = 0.0;  ///< for which heat stays alike
  /// The likeliest of those tried lies at an end of them: heat stays alike for no longer than this, or for this at least.
  enum class Limit { kNone, kAtMost, kAtLeast } limit = Limit::kNone;
  std::vector<BodyWander> bodies;  ///< the largest share first; those that matter
  SharedNoise readings;            ///< what it does to them
  Prediction prediction;           ///< with the most probable heat
};

/// @param state       of the machine
/// @param prediction  of it, whose misses are looked at, weighed by the fitter's comparison, which shares no noise
/// @return nullopt where no heat is missing
/// @throws SolveError  where the state has no solution
[[nodiscard]] std::optional<HeatWander> heat_wander(const Fitter& fitter, const TwinState& state,
                                                    const Prediction& prediction, Twin::Workspace& workspace);

}  // namespace driftwright::diagnosis
