#pragma once
// Writes the files of a diagnosis beside its report: the extended scenario, its difference to the user's scenario, and
// the regions where heat is missing.

#include "output/results_folder.hpp"
#include "studies/written_scenario.hpp"

namespace driftwright::app {

/// Writes <stem>.yaml and <stem>.diff; nothing for a text that cannot be read back as a scenario.
void write_scenario(const std::string& stem, const studies::WrittenScenario& written, output::ResultsFolder& folder);

/// Writes residual_source.vtu: missing_heat_probability and missing_heat_W of each region, from the statements.
/// @returns whether it was written; false for a machine without a mesh
bool write_missing_heat(const mesh::Mesh& mesh, const diagnosis::Posterior& statements, output::ResultsFolder& folder);

}  // namespace driftwright::app
