#pragma once
// Reads programs in RS-274 (ISO 6983) as LinuxCNC knows it, which other controls have as a mode. nc/program.hpp lists the
// words.

#include <string>
#include <vector>

#include "nc/execution.hpp"

namespace driftwright {

/// In what controls differ.
struct IsoVariant {
  bool has_g291 = false;            ///< G291 begins ISO code, and is allowed
  bool work_offset_resets = false;  ///< a work offset (G54 ...) removes corrections
};

/// Runs the program. @throws InputError  as read_nc_program()
void run_iso_program(const std::string& path, const std::vector<std::string>& lines, NcExecution& run,
                     const IsoVariant& variant);

}  // namespace driftwright
