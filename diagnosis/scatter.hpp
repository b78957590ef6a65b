#pragma once
// The numbers that a user knows only roughly: every uncertain number of the scenario as a knob with its prior.

#include "diagnosis/candidates.hpp"

namespace driftwright::diagnosis {

/// Their names in reports and in `known_together`: effect, place, number; of two alike the second one ends in " 2". So a
/// name belongs to the whole list that scatter() gives.
[[nodiscard]] std::vector<std::string> number_names(const Twin& twin, const std::vector<Knob>& knobs);

/// Numbers of effects, and conductivity, heat capacity and expansion of each region and node. The prior is that of the
/// scenario (`known_to`), otherwise the usual one (10 %, exponents 3 %; `is_said` is false). Numbers that are fixed have no
/// knob.
[[nodiscard]] std::vector<Knob> scatter(const Twin& twin);

/// What the scenario says of a number of scatter(), in SI units: of an effect its value; of a node its capacity; of a body
/// else the product of the factors that effects have on its conductivity, heat capacity or expansion. Numbers of materials
/// are not in it.
[[nodiscard]] double written_value(const Twin& twin, const Knob& knob);
/// The offset of each run's ambient from its record [K], with a standard deviation of 0.3 K.
[[nodiscard]] std::vector<Knob> ambient_scatter(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
