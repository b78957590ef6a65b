#include "effects/drive_change.hpp"

namespace driftwright::effects {

Cyclogram true_cyclogram(const DriveChange& change, Cyclogram recorded) {
  for (const auto& changed : change.drive) recorded = changed(recorded);
  return recorded;
}

TimeSeries true_ambient(const DriveChange& change, TimeSeries ambient, const Cyclogram& cyclogram) {
  for (const auto& changed : change.ambient) ambient = changed(ambient, cyclogram);
  return ambient;
}

}  // namespace driftwright::effects
