#pragma once
// A warm-up as an NC program.

#include <string>
#include <vector>

#include "driftwright/cyclogram.hpp"

namespace driftwright::studies {

/// An NC program for LinuxCNC that turns the spindle as the sections say, and stops it: G21 G94, M3 S, G4 P in seconds.
/// @param remark  in the first comment; what NC programs do not take in one becomes "_"
[[nodiscard]] std::string warm_up_program(const std::vector<Cyclogram::Section>& sections, const std::string& remark);

}  // namespace driftwright::studies
