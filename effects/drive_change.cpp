#include "effects/drive_change.hpp"

#include "effects/run_on.hpp"

namespace driftwright::effects {

Cyclogram true_cyclogram(const DriveChange& change, Cyclogram recorded) {
  for (const auto& changed : change.drive) recorded = changed(recorded);
  return recorded;
}

TimeSeries true_ambient(const DriveChange& change, TimeSeries ambient, const Cyclogram& felt) {
  for (const auto& changed : change.ambient) ambient = changed(ambient, felt);
  return ambient;
}

Cyclogram driven_before(const DriveChange& change, const Cyclogram& felt) {
  Cyclogram before;
  for (const auto& driven : change.before) {
    const Cyclogram more = driven(felt);
    before.sections.insert(before.sections.end(), more.sections.begin(), more.sections.end());
  }
  for (double time_s : change.run_on_s) before = with_run_on(std::move(before), time_s);
  before.clock_s = -before.duration_s();
  return before;
}

}  // namespace driftwright::effects
