#pragma once
// Writes a functional mock-up unit: a zip of description, C sources, linux64 binary and reference result.

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
  std::string reference_in = {}, reference_out = {};  ///< CSV of a run, with the names of the variables; "": none
  std::string reference_words = {};                   ///< describes that run
  double step_s = 60.0;                               ///< of the default experiment
};

/// All files of the unit.
[[nodiscard]] std::vector<FmuEntry> fmu_entries(const FmuOrder& order, const Provenance& made_by);

/// Writes entries as a zip whose bytes do not depend on the time. @throws std::runtime_error  naming the file
void write_zip(const std::filesystem::path& file, const std::vector<FmuEntry>& entries);

/// Whether an observer, or else a machine, needs this file of sources/, apart from the files of an interface (FMI, plain C).
[[nodiscard]] bool is_of_model(const std::string& name, bool is_observer);

/// A model's name in a form that C and the standard allow.
[[nodiscard]] std::string model_identifier(const std::string& name);

}  // namespace driftwright::output
