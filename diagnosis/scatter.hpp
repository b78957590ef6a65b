#pragma once
// The numbers that a user knows only roughly: every uncertain number of the scenario as a knob with its prior.

#include "diagnosis/candidates.hpp"

namespace driftwright::diagnosis {

/// What a number counts as where the scenario has no `known_to` for it: known as usual (10 %, exponents 3 %), or exact.
enum class Unsaid { kUsual, kExact };

/// Their names in reports and in `known_together`: effect, place, number; of two alike the second one ends in " 2".
[[nodiscard]] std::vector<std::string> number_names(const Twin& twin, const std::vector<Knob>& knobs);

/// Numbers of effects, and conductivity, heat capacity and expansion of each region and node. The prior is that of the
/// scenario (`known_to`), otherwise as `unsaid` says. Numbers that are fixed or exact have no knob.
[[nodiscard]] std::vector<Knob> scatter(const Twin& twin, Unsaid unsaid = Unsaid::kUsual);
/// The offset of each run's ambient from its record [K], with a standard deviation of 0.3 K.
[[nodiscard]] std::vector<Knob> ambient_scatter(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
