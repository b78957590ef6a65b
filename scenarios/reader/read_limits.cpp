#include "scenarios/reader/read_limits.hpp"

#include <array>

namespace driftwright::scenarios {
namespace {

const std::array<const char*, 3> kLimitedAxes = {"x", "y", "z"};

}  // namespace

schema::Map machine_limits_schema() {
  using namespace schema;
  schema::Map travel = {.name = "limits, travel"};
  for (const char* axis : kLimitedAxes)
    travel.keys.push_back(
        schema::optional(axis, list(quantity("m"), 2), Said{"not limited"}, "the lowest and the highest position"));
  return {
      .name = "limits",
      .keys = {schema::optional("speed", quantity("rpm", 1.0, 1e6), Said{"the highest that the scenario states"},
                                "highest speed of the spindle"),
               schema::optional("feed", quantity("m/s", 1e-6, 100.0), Said{"`rapid` of `schedule`"},
                                "highest programmed feed, along the path"),
               schema::optional("travel", schema::map(travel), Said{"not limited"},
                                "of a program's axes, in the coordinates of the program"),
               schema::optional("correction", quantity("um", 1e-3, 1e6), Said{"not limited"}, "largest correction by size"),
               schema::optional("step", quantity("um", 1e-3, 1e6), Said{"not limited"},
                                "largest single change of a correction")},
      .about = "Limits of the machine and of its corrections (docs/how-to/schedule.md, \"Limits of the machine\")."};
}

MachineLimits read_machine_limits(const ConfigMap& in) {
  MachineLimits limits;
  if (in.has("speed")) limits.speed_rpm = in.quantity("speed");
  if (in.has("feed")) limits.feed_m_s = in.quantity("feed");
  if (const auto travel = in.optional_map("travel")) {
    for (std::size_t axis = 0; axis < kLimitedAxes.size(); ++axis) {
      const char* key = kLimitedAxes[axis];
      if (!travel->has(key)) continue;
      const std::vector<double> range_m = travel->quantities(key);
      if (range_m.size() != 2 || !(range_m[0] < range_m[1]))
        travel->fail(key, "the travel must be the lowest and the highest position, such as [-10 mm, 320 mm]");
      limits.low_m[axis] = range_m[0];
      limits.high_m[axis] = range_m[1];
    }
    travel->reject_unknown_keys();
  }
  if (in.has("correction")) limits.correction.most_um = in.quantity("correction");
  if (in.has("step")) limits.correction.most_step_um = in.quantity("step");
  in.reject_unknown_keys();
  return limits;
}

}  // namespace driftwright::scenarios
