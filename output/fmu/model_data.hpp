#pragma once
// The tables of one model as C: model_data.c, which sources/model_data.h declares.

#include <string>

#include "output/fmu/fmu_model.hpp"

namespace driftwright::output {

/// Numbers are written in hexadecimal, to the last bit.
/// @param identifier  of the model, as C allows
/// @param guid        that modelDescription.xml names
[[nodiscard]] std::string model_data_c(const FmuModel& model, const std::string& identifier, const std::string& guid,
                                       const std::string& made_by);

}  // namespace driftwright::output
