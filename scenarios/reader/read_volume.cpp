#include "scenarios/reader/read_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/lists.hpp"

namespace driftwright::scenarios {
namespace {

bool is_rising(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return !(a < b); }) == values.end();
}

std::vector<double> read_positions_m(const ConfigMap& in, const MovingAxis& axis) {
  const std::vector<double> positions_m = in.quantities(axis.name);
  if (!is_rising(positions_m)) in.fail(axis.name, "the positions must rise");
  for (const double at_m : positions_m) {
    if (at_m < axis.low_m || at_m > axis.high_m)
      in.fail(axis.name, fmt::format("{:g} mm is outside the `range` of the axis, {:g} mm to {:g} mm", 1e3 * at_m,
                                     1e3 * axis.low_m, 1e3 * axis.high_m));
  }
  return positions_m;
}

}  // namespace

std::size_t VolumeSettings::n_poses() const {
  std::size_t n = 1;
  for (const std::vector<double>& of_axis : positions_m) n *= of_axis.size();
  return n;
}

Pose VolumeSettings::pose(std::size_t i) const {
  Pose pose;
  for (const std::vector<double>& of_axis : positions_m) {
    pose.push_back(of_axis[i % of_axis.size()]);
    i /= of_axis.size();
  }
  return pose;
}

schema::Map volume_schema() {
  using namespace schema;
  const schema::Map positions = {
      .name = "volume, positions",
      .others = {compulsory("axis", list(quantity("m"), 1),
                            "positions of this axis, rising; an axis that is left out stays at `at`")}};
  return {.name = "volume",
          .keys = {compulsory("cyclogram", text(), "that warms the machine"),
                   compulsory("tool", point_schema(), "point of the tool, as drawn"),
                   compulsory("work", text(), "region that carries the work"),
                   compulsory("positions", schema::map(positions), "of the axes: the grid of poses"),
                   schema::optional("times", list(quantity("s", 0.0), 1), Said{"its end"}, "of the cyclogram, rising")},
          .about = "The error of the tool against the work over the poses of a grid (docs/how-to/poses.md)."};
}

VolumeSettings read_volume(const ConfigMap& in, const std::vector<MovingAxis>& axes,
                           const std::vector<Cyclogram>& cyclograms) {
  VolumeSettings volume{.cyclogram = in.choice("cyclogram", names_of(cyclograms)),
                        .tool = read_point(in.map("tool")),
                        .work = in.text("work"),
                        .positions_m = {},
                        .times_s = {},
                        .where = in.where("work")};
  const ConfigMap positions = in.map("positions");
  const std::vector<std::string> known = names_of(axes);
  for (const std::string& name : positions.keys()) {
    if (known.empty()) positions.fail(name, "the scenario has no `axes`, so the machine has one pose only");
    if (!is_in(known, name))
      positions.fail(name, fmt::format("there is no axis '{}'; there are {}", name, fmt::join(known, ", ")));
  }
  for (const MovingAxis& axis : axes)
    volume.positions_m.push_back(positions.has(axis.name) ? read_positions_m(positions, axis) : std::vector{axis.at_m});
  positions.reject_unknown_keys();
  const auto run =
      std::find_if(cyclograms.begin(), cyclograms.end(), [&](const Cyclogram& c) { return c.name == volume.cyclogram; });
  volume.times_s = in.has("times") ? in.quantities("times") : std::vector{run->duration_s()};
  if (!is_rising(volume.times_s)) in.fail("times", "the times must rise");
  if (volume.times_s.back() > run->duration_s())
    in.fail("times", fmt::format("cyclogram '{}' ends at {:g} min", run->name, run->duration_s() / 60.0));
  in.reject_unknown_keys();
  return volume;
}

}  // namespace driftwright::scenarios
