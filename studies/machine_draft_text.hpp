#pragma once
// A draft of a machine as the text of a scenario; its comments say what was read and what was guessed.

#include <string>

#include "studies/machine_draft.hpp"

namespace driftwright::studies {

/// @param name   of the scenario
/// @param file   of the geometry, relative to the scenario
[[nodiscard]] std::string scenario_text(const MachineDraft& draft, const mesh::UnnamedGeometry& geometry,
                                        const std::string& name, const std::string& file);

/// Its block `machine:` alone. @param file  as it is to be written
[[nodiscard]] std::string machine_text(const MachineDraft& draft, const mesh::UnnamedGeometry& geometry,
                                       const std::string& file);

/// The scenario of a machine of two lumped nodes; all numbers are guesses.
[[nodiscard]] std::string lumped_scenario_text(const std::string& name);

}  // namespace driftwright::studies
