#pragma once
// The C files of sources/ as text, which a unit contains unchanged, and what they compile to.

#include <string>
#include <vector>

namespace driftwright::output {

struct SourceFile {
  std::string name;  ///< "machine.c"
  std::string text;
};
[[nodiscard]] const std::vector<SourceFile>& fmu_source_files();

/// Binaries for x86-64 Linux without the numbers of a model (model_numbers()): fmi2_machine.so, fmi2_observer.so and the
/// same for fmi3.
[[nodiscard]] const std::vector<SourceFile>& fmu_binaries();

}  // namespace driftwright::output
