#pragma once
// The numbers of a diagnosis or calibration: what is left, the gain, the data themselves, the scenario's own numbers.

#include "diagnosis/diagnosis.hpp"
#include "output/document.hpp"
#include "studies/remainder.hpp"

namespace driftwright::findings {

/// @pre something is unexplained
[[nodiscard]] output::Section unexplained_section(const diagnosis::Diagnosis& d);
[[nodiscard]] output::Section wander_section(const diagnosis::HeatWander& wander);
/// @param file  that was written  @param remainder  what could be learned beside it, or null
[[nodiscard]] output::Section gain_section(const diagnosis::Diagnosis& d, const std::string& file,
                                           const studies::Remainder* remainder);
[[nodiscard]] output::Section data_section(const diagnosis::Diagnosis& d);
/// The numbers that the fit moved most, for people.
[[nodiscard]] output::Table moved_most(const diagnosis::Diagnosis& d);
/// All of them, folded.
[[nodiscard]] output::Section numbers_section(const diagnosis::Diagnosis& d);

}  // namespace driftwright::findings
