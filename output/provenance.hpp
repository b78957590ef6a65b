#pragma once
// Who made an output.

#include <string>

namespace driftwright::output {

/// What made a folder of results. Stands in its manifest, in each document and in each field file.
struct Provenance {
  std::string version = {};   ///< of the program, "0.2.0"
  std::string scenario = {};  ///< path or name of the scenario, as the user gave it
};

}  // namespace driftwright::output
