#include "studies/known_speed.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace driftwright::studies {

double known_speed_rpm(const scenarios::Scenario& scenario) {
  double top_rpm = 0.0;
  for (const Cyclogram& c : scenario.cyclograms) {
    for (const auto& section : c.sections) top_rpm = std::max(top_rpm, section.drive.speed_rpm);
  }
  for (const effects::Effect& e : scenario.machine->effects) {
    for (std::size_t k = 0; k < e.values.size(); ++k) {
      if (e.kind->parameters[k].name == std::string_view("at_speed") && std::isfinite(e.values[k]))
        top_rpm = std::max(top_rpm, e.values[k]);
    }
  }
  return top_rpm;
}

}  // namespace driftwright::studies
