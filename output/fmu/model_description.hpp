#pragma once
// modelDescription.xml: the variables of a unit, in either version of the standard.

#include <string>
#include <vector>

#include "output/fmu/fmu_model.hpp"

namespace driftwright::output {

enum class FmiVersion { k2, k3 };

/// The interfaces that a unit has.
struct FmiInterfaces {
  bool model_exchange = true, co_simulation = true;
};

/// A variable as an importer sees it. Value references are those of sources/instance.h.
struct FmuVariable {
  std::string name = {};
  unsigned reference = 0;
  std::string description = {};
  std::string causality = {}, variability = {}, initial = {};  ///< as the standard spells them; initial may be ""
  std::string unit = {};                                       ///< "" for none
  bool is_boolean = false;
  std::optional<double> start = {}, min = {}, max = {}, nominal = {};
  std::optional<unsigned> derivative_of = {};  ///< reference of the state
};

/// Time, inputs, parameters, outputs, states and their derivatives.
/// @throws InputError  for two variables with the same name, such as a sensor named like an input
[[nodiscard]] std::vector<FmuVariable> variables_of(const FmuModel& model);

/// @param source_files  C files; @param step_s  of the default experiment
[[nodiscard]] std::string model_description(const FmuModel& model, const std::vector<FmuVariable>& variables,
                                            FmiVersion version, FmiInterfaces interfaces, const std::string& identifier,
                                            const std::string& guid, const std::string& tool,
                                            const std::vector<std::string>& source_files, double step_s);
/// sources/buildDescription.xml of FMI 3.0.
[[nodiscard]] std::string build_description(const std::string& identifier, const std::vector<std::string>& source_files);

}  // namespace driftwright::output
