#pragma once
// Writes the files of a diagnosis beside its report: the extended scenario, its difference to the user's scenario, and
// the regions where heat is missing.

#include "diagnosis/extended_scenario.hpp"
#include "findings/diagnosis_words.hpp"
#include "output/results_folder.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::app {

/// The causes of a diagnosis as changes of the scenario.
[[nodiscard]] std::vector<diagnosis::StatedChange> stated_causes(const diagnosis::Diagnosis& d);
/// The scenario's own numbers as fitted, as changes of the scenario.
/// @param causes_only  return only numbers that moved so far that the diagnosis reports them as causes
[[nodiscard]] std::vector<diagnosis::StatedChange> stated_scatter(const diagnosis::Diagnosis& d, bool causes_only);

/// Writes <stem>.yaml and <stem>.diff. A text that cannot be read back as a scenario is not written; the result's
/// `not_written` then says so.
/// @param head  comment lines for the top of the scenario
/// @param difference  unless null, receives the text of the .diff; empty if nothing is written
[[nodiscard]] diagnosis::ExtendedScenario write_scenario(const std::string& stem, const studies::MeasuredTwin& m,
                                                         const std::vector<diagnosis::StatedChange>& changes,
                                                         const std::vector<std::string>& head, output::ResultsFolder& folder,
                                                         std::string* difference);

/// Predicts all rows with the effects of the written scenario.
/// @throws InputError  as read_scenario()
[[nodiscard]] diagnosis::Prediction read_as_written(const studies::MeasuredTwin& m,
                                                    const diagnosis::ExtendedScenario& extended);

/// Predicts all rows with the effects of the written scenario and sets Diagnosis::extended and, for each channel,
/// ChannelGain::rmse_all_before and rmse_written.
/// @throws InputError  as read_scenario()
void simulate_written(const studies::MeasuredTwin& m, const diagnosis::ExtendedScenario& extended, diagnosis::Diagnosis& d);

/// Writes residual_source.vtu: missing_heat_probability and missing_heat_W of each region, from the statements.
/// @returns whether it was written; false for a machine without a mesh
bool write_missing_heat(const mesh::Mesh& mesh, const diagnosis::Posterior& statements, output::ResultsFolder& folder);

}  // namespace driftwright::app
