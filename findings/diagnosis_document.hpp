#pragma once
// What `diagnose` and `calibrate` found, as documents: what was found, how sure it is, and the residuals that a person judges it by.

#include "diagnosis/extended_scenario.hpp"
#include "output/document.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::findings {

/// What a document shows.
struct DiagnosisFindings {
  const studies::MeasuredTwin& measured;
  const diagnosis::Diagnosis& diagnosis;
  const diagnosis::ExtendedScenario& extended;
  std::string difference = {};  ///< text of the .diff
  std::string file = {};        ///< name of the scenario written
};

/// The document whose JSON is diagnosis.json.
[[nodiscard]] output::Document diagnosis_document(const DiagnosisFindings& found, const output::Provenance& made_by);
/// The same for a calibration, calibration.json: numbers first, no causes.
[[nodiscard]] output::Document calibration_document(const DiagnosisFindings& found, const output::Provenance& made_by);

}  // namespace driftwright::findings
