#pragma once
// The C files of this folder as text. The exported files are byte by byte those that the program itself is compiled from.

#include <string>
#include <vector>

namespace driftwright::compensation {

struct ControlFile {
  std::string name;  ///< "drift_correction.h"
  std::string text;
};
/// drift_correction.h and .c, axis_offset.h and .c, axis_travel.h and .c, probe_feedback.h and .c, probe_members.h and .c.
[[nodiscard]] const std::vector<ControlFile>& control_files();

}  // namespace driftwright::compensation
