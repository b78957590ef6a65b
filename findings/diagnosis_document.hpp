#pragma once
// The results of `diagnose` and `calibrate` as documents: what was found, how certain it is, and the residuals for a person
// to judge it.

#include "diagnosis/extended_scenario.hpp"
#include "output/document.hpp"
#include "studies/remainder.hpp"

namespace driftwright::findings {

/// The contents of such a document.
struct DiagnosisFindings {
  const studies::MeasuredTwin& measured;
  const diagnosis::Diagnosis& diagnosis;
  const diagnosis::ExtendedScenario& extended;
  std::string difference = {};                    ///< text of the .diff
  std::string file = {};                          ///< name of the scenario written
  const studies::Remainder* remainder = nullptr;  ///< what could be learned beside it; null: nobody tried
};

/// The document whose JSON is diagnosis.json.
[[nodiscard]] output::Document diagnosis_document(const DiagnosisFindings& found, const output::Provenance& made_by);
/// The document of a calibration, calibration.json: numbers first, no causes.
[[nodiscard]] output::Document calibration_document(const DiagnosisFindings& found, const output::Provenance& made_by);

}  // namespace driftwright::findings
