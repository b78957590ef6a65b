#pragma once
// What a session knows, in a file that is whole at every moment.

#include <filesystem>

#include "follow/session.hpp"

namespace driftwright::follow {

/// Writes beside the file and puts that in its place, on the disk before it has the name. @throws InputError  when it cannot be written
void write_state(const std::filesystem::path& file, const Session& session);

/// Goes on from a file, where there is one. @return whether there was
/// @throws InputError  for a file that is damaged, of other models or of another stream
[[nodiscard]] bool resume_from(const std::filesystem::path& file, Session& session);

}  // namespace driftwright::follow
