#include "effects/drive_change.hpp"

namespace driftwright::effects {

Cyclogram true_cyclogram(const DriveChange& change, Cyclogram recorded) {
  for (const auto& changed : change.drive) recorded = changed(recorded);
  return recorded;
}

TimeSeries true_hall(const DriveChange& change, TimeSeries hall, const Cyclogram& cyclogram) {
  for (const auto& changed : change.hall) hall = changed(hall, cyclogram.duration_s());
  return hall;
}

}  // namespace driftwright::effects
