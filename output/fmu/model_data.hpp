#pragma once
// The tables of one model, which sources/model_data.h declares: as C, and as the numbers at the end of a unit's binary.

#include <string>

#include "output/fmu/fmu_model.hpp"

namespace driftwright::output {

/// model_data.c. Numbers are written in hexadecimal and are exact.
/// @param guid  the one in modelDescription.xml
[[nodiscard]] std::string model_data_c(const FmuModel& model, const std::string& guid, const std::string& made_by);

/// The same numbers as bytes, which binary/model_numbers.c reads from the end of the file that it is in.
[[nodiscard]] std::string model_numbers(const FmuModel& model, const std::string& guid);

}  // namespace driftwright::output
