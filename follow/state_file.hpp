#pragma once
// Saves the state of a session in a file that is complete at every moment.

#include <filesystem>

#include "follow/session.hpp"

namespace driftwright::follow {

/// Writes a file beside it, syncs that to disk and renames it into place. @throws InputError  if it cannot be written
void write_state(const std::filesystem::path& file, const Session& session);

/// Restores a session from a file, if there is one. @return whether there was
/// @throws InputError  for a file that is damaged, of other models or of another stream
[[nodiscard]] bool resume_from(const std::filesystem::path& file, Session& session);

}  // namespace driftwright::follow
