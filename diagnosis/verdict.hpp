#pragma once
// From causes, kept-out rows and what is left to a verdict, and the verdict in words.

#include "diagnosis/gain.hpp"

namespace driftwright::diagnosis {

/// How surely each claim is a cause: sets their standing, doubt and whether they are written.
void give_standing(Diagnosis& d, const HeldOut& held);
/// Whether so many of the scenario's numbers had to go too far that no few causes are what is wrong: a model of another make, or numbers that are known less well than it says.
[[nodiscard]] bool is_wrong_all_over(const Diagnosis& d);
/// Whether what is left is more than what the causes explain, so that none of them is what is wrong.
[[nodiscard]] bool is_more_left(const Diagnosis& d);
/// Of causes whose standing is known and of what is left beside them.
[[nodiscard]] Verdict verdict_of(const Diagnosis& d);
[[nodiscard]] std::string reason_of(const Diagnosis& d);

}  // namespace driftwright::diagnosis
