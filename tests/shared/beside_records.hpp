#pragma once
// Records with one row per minute and little noise, and a scenario's twin with them, to test findings of structure.

#include "diagnosis/scatter.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis {

inline constexpr double kNoise_K = 0.03, kNoise_um = 0.2;

/// Records of a scenario as files FOLDER_CYCLOGRAM.csv.
inline std::vector<std::string> record(const std::string& path, const std::string& folder) {
  return noisy_records(path, folder + "_", 60.0, kNoise_K, kNoise_um, 3);
}

}  // namespace driftwright::diagnosis
