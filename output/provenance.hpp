#pragma once
// The program version and scenario that an output came from.

#include <string>

namespace driftwright::output {

/// The origin of a folder of results. Version and scenario are written into its manifest, each document and each field
/// file; the folder's path appears only in commands that a report recommends.
struct Provenance {
  std::string version = {};   ///< of the program, "0.2.0"
  std::string scenario = {};  ///< path or name of the scenario, as the user gave it
  std::string results = {};   ///< path of the folder of results, as the user would type it; "" if there is none
};

/// The path of a file of the results, as the user would type it: "results/fp3_spindle/models/blend.json".
inline std::string path_in_results(const Provenance& made_by, const std::string& file) {
  return made_by.results.empty() ? file : made_by.results + "/" + file;
}

}  // namespace driftwright::output
