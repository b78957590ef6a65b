#include "output/json_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace driftwright::output {
namespace {

nlohmann::ordered_json rounded(nlohmann::ordered_json value) {
  if (value.is_number_float()) {
    const double number = value.get<double>();
    if (!std::isfinite(number)) return nullptr;
    // dump() then writes the shortest text that reads back as this number. strtod, since stod refuses denormal numbers.
    return std::strtod(fmt::format("{:.5e}", number).c_str(), nullptr);
  }
  if (value.is_structured()) {
    for (auto& element : value) element = rounded(std::move(element));
  }
  return value;
}

}  // namespace

std::string json_text(const nlohmann::ordered_json& value) {
  return rounded(value).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace driftwright::output
