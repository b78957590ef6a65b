#pragma once
// The first lines of a diagnosis and of a calibration: the answer in two sentences, and what to do next.

#include "findings/diagnosis_words.hpp"
#include "output/document.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::findings {

/// What a reader must know before the answer, sentences; "" if there is nothing: blunders of the records, columns whose name
/// is probably another one, displacements and tilts of the scenario that were not compared because their data is wrong.
[[nodiscard]] std::string said_first_text(const studies::MeasuredTwin& m, const Compared& compared);

/// The answer of `diagnose`. If half of the channels or fewer were compared, or something has to be said first, it says
/// so and is not shown as good. @param left_out  as said_first_text() says it
[[nodiscard]] output::Verdict answer_of(const diagnosis::Diagnosis& d, const Compared& compared,
                                        const std::string& left_out = "");
/// What to look at on the machine and which test or command comes next, up to three sentences.
/// @param made_by  names the folder of results in the commands
[[nodiscard]] std::vector<std::string> next_steps(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                                  const Compared& compared, const output::Provenance& made_by);

/// The answer of `calibrate`. @param warning  as calibration_warning() says it
[[nodiscard]] output::Verdict calibration_answer(const diagnosis::Diagnosis& d, const std::string& warning,
                                                 const std::string& left_out = "");
[[nodiscard]] std::vector<std::string> steps_after_calibration(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                                               const std::string& warning,
                                                               const output::Provenance& made_by);

}  // namespace driftwright::findings
