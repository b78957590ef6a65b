#pragma once
// Derives a verdict from causes, kept-out rows and the rest, and expresses it in words.

#include "diagnosis/gain.hpp"

namespace driftwright::diagnosis {

/// Sets the standing and doubt of each claim, and whether it is written.
void give_standing(Diagnosis& d, const HeldOut& held);
/// Whether so many of the scenario's numbers moved too far that the fault is not a few causes: the model differs as a
/// whole, or its numbers are less certain than the scenario says.
[[nodiscard]] bool is_wrong_all_over(const Diagnosis& d);
/// Whether more is left than the causes explain, so that none of them is the fault.
[[nodiscard]] bool is_more_left(const Diagnosis& d);
/// The verdict from causes with known standing and what they leave.
[[nodiscard]] Verdict verdict_of(const Diagnosis& d);
[[nodiscard]] std::string reason_of(const Diagnosis& d);

}  // namespace driftwright::diagnosis
