#pragma once
// Changes of a measured twin written into the user's scenario, and read back as a program will read the file.

#include <filesystem>

#include "diagnosis/extended_scenario.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::studies {

struct WrittenScenario {
  /// The text. If it cannot be read back as a scenario, the text must not be used: `not_written` then gives the reason.
  diagnosis::ExtendedScenario extended;
  std::string difference;        ///< to the user's file, as `patch` reads it; empty if the text cannot be read back
  diagnosis::TwinState effects;  ///< as read back

  [[nodiscard]] bool is_readable() const { return extended.not_written.empty(); }
};

/// Makes the changes in order, as diagnosis::extended_scenario() does, and reads the text back.
/// @param head  comment lines for the top of the scenario
/// @param file  path that the text will be written to, which its paths become relative to, and its name in messages and in
///              the difference; without a folder paths become absolute, for a text that is not written
/// @param known_together  as in diagnosis::extended_scenario()
/// @throws InputError  if the user's file was removed or changed in the meantime
[[nodiscard]] WrittenScenario written_scenario(const MeasuredTwin& m, const std::vector<diagnosis::StatedChange>& changes,
                                               std::vector<std::string> head, const std::filesystem::path& file,
                                               const std::optional<scenarios::KnownTogether>& known_together = {});

/// A file in the comments of such a text, which may be sent to somebody: its name without folders.
[[nodiscard]] std::string name_in_comments(const std::string& path);

}  // namespace driftwright::studies
