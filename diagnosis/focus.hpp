#pragma once
// A smaller twin for given runs: the states that the machine reaches under their cyclograms, with any doubt, span a few
// dozen dimensions. Proper orthogonal decomposition of random doubts; Galerkin projection keeps laws, parts and
// stability.
//
// Source: Sirovich, Quarterly of Applied Mathematics 45 (1987) 561-571; random mixtures as in Halko, Martinsson & Tropp,
// SIAM Review 53 (2011) 217-288.

#include "diagnosis/candidates.hpp"

namespace driftwright::diagnosis {

struct Focus {
  scenarios::ReducedMachine machine;
  double error_K = 0.0, error_m = 0.0;  ///< root mean square difference to the larger twin, over doubts that were not used
};

/// @param doubts  knobs that are set at random: scatter, and the effects of candidates on the machine
[[nodiscard]] Focus focus(const Twin& twin, const std::vector<MeasuredRun>& runs, const std::vector<Knob>& scatter,
                          const std::vector<Candidate>& candidates);

}  // namespace driftwright::diagnosis
