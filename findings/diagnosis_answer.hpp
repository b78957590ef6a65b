#pragma once
// The first lines of a diagnosis and of a calibration: the answer in two sentences, and what to do next.

#include "findings/diagnosis_words.hpp"
#include "output/document.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::findings {

/// The answer of `diagnose`. If half of the channels or fewer were compared, it says so first and is not shown as good.
[[nodiscard]] output::Verdict answer_of(const diagnosis::Diagnosis& d, const Compared& compared);
/// What to look at on the machine and which test or command comes next, up to three sentences.
[[nodiscard]] std::vector<std::string> next_steps(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                                  const Compared& compared);

/// The answer of `calibrate`. @param warning  as calibration_warning() says it
[[nodiscard]] output::Verdict calibration_answer(const diagnosis::Diagnosis& d, const std::string& warning);
[[nodiscard]] std::vector<std::string> steps_after_calibration(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                                               const std::string& warning);

}  // namespace driftwright::findings
