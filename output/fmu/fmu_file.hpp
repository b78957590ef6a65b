#pragma once
// A functional mock-up unit as one file: a zip of description, C sources, linux64 binary and reference result.

#include <filesystem>
#include <string>
#include <vector>

#include "output/fmu/model_description.hpp"
#include "output/results_folder.hpp"

namespace driftwright::output {

/// A file within a unit.
struct FmuEntry {
  std::string path;
  std::string bytes;
};

struct FmuOrder {
  FmuModel model = {};
  FmiVersion version = FmiVersion::k2;
  FmiInterfaces interfaces = {};
  std::string reference_in = {}, reference_out = {};  ///< CSV of a run, in the names of the variables; "": none
  std::string reference_words = {};                   ///< what run that is
  double step_s = 60.0;                               ///< of the default experiment
};

/// All files of the unit; compiles the binary with `cc`, or what CC names, as C99 with all warnings as errors.
/// @throws InputError  without a compiler, or with what it says where it fails
[[nodiscard]] std::vector<FmuEntry> fmu_entries(const FmuOrder& order, const Provenance& made_by);

/// A zip of entries, whose bytes do not depend on the time. @throws std::runtime_error  naming the file
void write_zip(const std::filesystem::path& file, const std::vector<FmuEntry>& entries);

/// Name of a model as C and the standard allow it.
[[nodiscard]] std::string model_identifier(const std::string& name);

}  // namespace driftwright::output
