#pragma once
// Where the model errs: random heat in the machine's bodies, of which only size and duration are known, as process noise.
//
//     M z' = -K z + Σ b_i u_i(t),   u_i: an Ornstein-Uhlenbeck process (Matérn 1/2) of standard deviation q_i and
//                                   one time constant
//
// q by maximum likelihood (expectation and maximisation of variance components), the time constant by trial of several. A
// body with a large q is one where the model misses something; readings that its heat affects say little about anything
// else.
// Source: Kristensen, Madsen & Jorgensen, Automatica 40 (2004) 225-237; Dempster, Laird & Rubin, J. R. Stat. Soc. B 39
// (1977) 1-38.

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

/// The part of one body in the missing heat.
struct BodyWander {
  effects::Body body;
  double sd_W = 0.0;
  double share = 0.0;  ///< of the effect of all bodies on the readings, in squared units of noise
};

struct HeatWander {
  double time_s = 0.0;  ///< correlation time of the heat
  /// If the likeliest trial value is at an end of the range: the true time is at most, or at least, this value.
  enum class Limit { kNone, kAtMost, kAtLeast } limit = Limit::kNone;
  std::vector<BodyWander> bodies;  ///< those that matter, with the largest share first
  SharedNoise readings;            ///< effect on the readings
  Prediction prediction;           ///< with the most probable heat
};

/// @param state       of the machine
/// @param prediction  of that state; its errors are weighed by the fitter's comparison, which has no shared noise
/// @return nullopt if no heat is missing
/// @throws SolveError  if the state has no solution
[[nodiscard]] std::optional<HeatWander> heat_wander(const Fitter& fitter, const TwinState& state,
                                                    const Prediction& prediction, Twin::Workspace& workspace);

}  // namespace driftwright::diagnosis
