#pragma once
// The C files of this folder as text: what is exported beside a model is, to the byte, what was compiled in.

#include <string>
#include <vector>

namespace driftwright::compensation {

struct ControlFile {
  std::string name;  ///< "drift_correction.h"
  std::string text;
};
/// drift_correction.h and .c, axis_offset.h and .c.
[[nodiscard]] const std::vector<ControlFile>& control_files();

}  // namespace driftwright::compensation
