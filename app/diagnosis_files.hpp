#pragma once
// What a diagnosis writes beside its report: the extended scenario, its difference to the user's, and where heat would be missing.

#include "diagnosis/extended_scenario.hpp"
#include "findings/diagnosis_words.hpp"
#include "output/results_folder.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::app {

/// The causes of a diagnosis as changes of the scenario.
[[nodiscard]] std::vector<diagnosis::StatedChange> stated_causes(const diagnosis::Diagnosis& d);
/// The scenario's own numbers as fitted. @param causes_only  those alone that have gone so far that they are causes
[[nodiscard]] std::vector<diagnosis::StatedChange> stated_scatter(const diagnosis::Diagnosis& d, bool causes_only);

/// Writes <stem>.yaml and <stem>.diff. A text that cannot be read back as a scenario is not written; `not_written` then says so.
/// @param head  comment lines for the top of the scenario
/// @param difference  unless null, the text of the .diff; empty where nothing is written
[[nodiscard]] diagnosis::ExtendedScenario write_scenario(const std::string& stem, const studies::MeasuredTwin& m,
                                                         const std::vector<diagnosis::StatedChange>& changes,
                                                         const std::vector<std::string>& head, output::ResultsFolder& folder,
                                                         std::string* difference);

/// What the scenario that was written says of all rows, by the twin, with the effects as its text has them.
/// @throws InputError  as read_scenario()
[[nodiscard]] diagnosis::Prediction read_as_written(const studies::MeasuredTwin& m,
                                                    const diagnosis::ExtendedScenario& extended);

/// Runs the scenario that was written over the whole of each record, by the twin, with the effects as its text has them: Diagnosis::extended and
/// ChannelGain::rmse_all_before and rmse_written.
/// @throws InputError  as read_scenario()
void simulate_written(const studies::MeasuredTwin& m, const diagnosis::ExtendedScenario& extended, diagnosis::Diagnosis& d);

/// residual_source.vtu: missing_heat_probability and missing_heat_W of each region, as the statements say them. Nothing for a machine without mesh.
/// @returns whether it was written
bool write_missing_heat(const mesh::Mesh& mesh, const diagnosis::Posterior& statements, output::ResultsFolder& folder);

}  // namespace driftwright::app
