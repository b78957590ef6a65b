#pragma once
// Writes a warm-up as an NC program.

#include <string>
#include <vector>

#include "driftwright/cyclogram.hpp"

namespace driftwright::studies {

/// An NC program for LinuxCNC that turns the spindle as in the sections and stops it: G21 G94, M3 S, G4 P in seconds.
/// @param remark  for the first comment; characters that are not allowed in comments become "_"
[[nodiscard]] std::string warm_up_program(const std::vector<Cyclogram::Section>& sections, const std::string& remark);

}  // namespace driftwright::studies
