#pragma once
// A twin for some runs alone: what states the machine comes to under their cyclograms, whatever is doubted, spans a few dozen
// dimensions. Proper orthogonal decomposition of random doubts; Galerkin projection keeps laws, parts and stability.
//
// Source: Sirovich, Quarterly of Applied Mathematics 45 (1987) 561-571; random mixtures as in Halko, Martinsson & Tropp,
// SIAM Review 53 (2011) 217-288.

#include "diagnosis/candidates.hpp"

namespace driftwright::diagnosis {

struct Focus {
  scenarios::ReducedMachine machine;
  double error_K = 0.0, error_m = 0.0;  ///< root mean square against the larger twin, over doubts that were not used
};

/// @param doubts  knobs that are turned at random: scatter and what candidates do to the machine
[[nodiscard]] Focus focus(const Twin& twin, const std::vector<MeasuredRun>& runs, const std::vector<Knob>& scatter,
                          const std::vector<Candidate>& candidates);

}  // namespace driftwright::diagnosis
