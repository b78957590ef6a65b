#pragma once
// The program version and scenario that an output came from.

#include <string>

namespace driftwright::output {

/// The origin of a folder of results. It is written into its manifest, each document and each field file.
struct Provenance {
  std::string version = {};   ///< of the program, "0.2.0"
  std::string scenario = {};  ///< path or name of the scenario, as the user gave it
};

}  // namespace driftwright::output
