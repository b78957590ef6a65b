#pragma once
// A diagnosis as a page: what was found, how sure it is, and the residuals that a person judges it by.

#include "app/diagnosis_files.hpp"
#include "output/html_report.hpp"

namespace driftwright::app {

/// What the page shows beside the diagnosis itself.
struct DiagnosisPage {
  const studies::MeasuredTwin& measured;
  const diagnosis::Diagnosis& diagnosis;
  const std::vector<diagnosis::Candidate>& candidates;  ///< those that the scores number
  const diagnosis::ExtendedScenario& extended;
  std::string difference = {};  ///< text of the .diff
  std::string file = {};        ///< name of the scenario written
};

[[nodiscard]] output::Report diagnosis_report(const DiagnosisPage& page, const output::Provenance& made_by);
/// The same for a calibration: numbers first, no causes.
[[nodiscard]] output::Report calibration_report(const DiagnosisPage& page, const output::Provenance& made_by);

}  // namespace driftwright::app
