#pragma once
// The C files of sources/ as text; a unit contains them unchanged.

#include <string>
#include <vector>

namespace driftwright::output {

struct SourceFile {
  std::string name;  ///< "machine.c"
  std::string text;
};
[[nodiscard]] const std::vector<SourceFile>& fmu_source_files();

}  // namespace driftwright::output
