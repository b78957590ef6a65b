#pragma once
// The tables of one model as C: model_data.c, which sources/model_data.h declares.

#include <string>

#include "output/fmu/fmu_model.hpp"

namespace driftwright::output {

/// Numbers are written in hexadecimal and are exact.
/// @param identifier  of the model, a valid C name
/// @param guid        the one in modelDescription.xml
[[nodiscard]] std::string model_data_c(const FmuModel& model, const std::string& identifier, const std::string& guid,
                                       const std::string& made_by);

}  // namespace driftwright::output
