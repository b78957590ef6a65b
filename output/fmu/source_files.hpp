#pragma once
// The C files of sources/ as text: what is inside a unit is, to the byte, what stands there.

#include <string>
#include <vector>

namespace driftwright::output {

struct SourceFile {
  std::string name;  ///< "machine.c"
  std::string text;
};
[[nodiscard]] const std::vector<SourceFile>& fmu_source_files();

}  // namespace driftwright::output
