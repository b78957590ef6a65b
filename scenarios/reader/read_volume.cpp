#include "scenarios/reader/read_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/lists.hpp"

namespace driftwright::scenarios {
namespace {

bool is_rising(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return !(a < b); }) == values.end();
}

double unit_of_keys_SI(const MovingAxis& axis) {
  return axis.way.turns ? axis.unit_SI() : 1.0;  // read in deg or m
}

/// Positions of an axis under its name or another key. @throws InputError  if one is outside the range
std::vector<double> read_positions_SI(const ConfigMap& in, const std::string& key, const MovingAxis& axis) {
  std::vector<double> positions_SI = in.quantities(key);
  for (double& at_SI : positions_SI) {
    at_SI *= unit_of_keys_SI(axis);
    if (!axis.allows(at_SI))
      in.fail(key, fmt::format("{} is outside the `range` of the axis, {} to {}", axis.words(at_SI), axis.words(axis.low_SI),
                               axis.words(axis.high_SI)));
  }
  return positions_SI;
}

RTestSettings read_r_test(const ConfigMap& in, const std::vector<MovingAxis>& axes, const std::string& work) {
  RTestSettings test{.axis = static_cast<std::size_t>(index_of(names_of(axes), in.choice("axis", names_of(axes)))),
                     .ball_m = in.vector3("ball"),
                     .angles_rad = {},
                     .where = in.where("ball")};
  const MovingAxis& axis = axes[test.axis];
  if (!axis.way.turns || !is_in(axis.moves, work))
    in.fail("axis",
            fmt::format("axis '{}' does not turn the work, '{}'; an axis that `turns` it is required", axis.name, work));
  test.angles_rad = read_positions_SI(in, "angles", axis);
  in.reject_unknown_keys();
  return test;
}

BallBarSettings read_ball_bar(const ConfigMap& in, const std::vector<MovingAxis>& axes) {
  const std::vector<std::string> named = in.texts("axes"), known = names_of(axes);
  if (named.size() != 2) in.fail("axes", "two linear axes are required, such as [x, y]");
  BallBarSettings bar{.radius_m = in.quantity("radius"), .n_points = in.integer("points"), .where = in.where("radius")};
  std::vector<double> centre_m;
  if (in.has("centre")) centre_m = in.quantities("centre");
  if (in.has("centre") && centre_m.size() != 2) in.fail("centre", "two positions are required, one of each axis");
  for (std::size_t i = 0; i < 2; ++i) {
    const int found = index_of(known, named[i]);
    if (found < 0) in.fail("axes", fmt::format("there is no axis '{}'; there are {}", named[i], fmt::join(known, ", ")));
    bar.axes[i] = static_cast<std::size_t>(found);
    const MovingAxis& axis = axes[bar.axes[i]];
    if (axis.way.turns) in.fail("axes", fmt::format("axis '{}' turns; two linear axes are required", axis.name));
    bar.centre_m[i] = centre_m.empty() ? axis.at_SI : centre_m[i];
    if (!axis.allows(bar.centre_m[i] - bar.radius_m) || !axis.allows(bar.centre_m[i] + bar.radius_m))
      in.fail("radius", fmt::format("the circle leaves the `range` of axis '{}', {} to {}; its centre is at {}", axis.name,
                                    axis.words(axis.low_SI), axis.words(axis.high_SI), axis.words(bar.centre_m[i])));
  }
  constexpr double kPerpendicular = 1e-9;  // rounding
  if (std::abs(axes[bar.axes[0]].way.direction.dot(axes[bar.axes[1]].way.direction)) > kPerpendicular)
    in.fail("axes", "the two axes must be perpendicular");
  in.reject_unknown_keys();
  return bar;
}

}  // namespace

std::size_t VolumeSettings::n_poses() const {
  std::size_t n = 1;
  for (const std::vector<double>& of_axis : positions_SI) n *= of_axis.size();
  return n;
}

Pose VolumeSettings::pose(std::size_t i) const {
  Pose pose;
  for (const std::vector<double>& of_axis : positions_SI) {
    pose.push_back(of_axis[i % of_axis.size()]);
    i /= of_axis.size();
  }
  return pose;
}

schema::Map volume_schema() {
  using namespace schema;
  const schema::Map positions = {
      .name = "volume, positions",
      .others = {
          compulsory("axis", list(quantity(""), 1),
                     "positions of this axis, rising, as lengths or angles; an axis that is left out stays at `at`")}};
  const schema::Map r_test = {
      .name = "volume, r_test",
      .keys = {compulsory("axis", text(), "rotary axis that turns the work"),
               compulsory("ball", vector3("m"), "centre of the ball that the work carries, as drawn, off the axis"),
               compulsory("angles", list(quantity("deg"), 4), "positions of the axis")}};
  const schema::Map ball_bar = {
      .name = "volume, ball_bar",
      .keys = {compulsory("axes", list(text(), 2), "two linear axes; the angle counts from the first to the second"),
               compulsory("radius", quantity("m", 1e-3, 10.0), "of the circle"),
               schema::optional("centre", list(quantity("m"), 2), Said{"`at`"}, "positions of the two axes"),
               schema::optional("points", integer(8, 360), 16.0, "even over the circle; each is a pose")}};
  return {
      .name = "volume",
      .keys = {compulsory("cyclogram", text(), "that warms the machine"),
               compulsory("tool", point_schema(), "point of the tool, as drawn"),
               compulsory("work", text(), "region that carries the work"),
               compulsory("positions", schema::map(positions), "of the axes: the grid of poses"),
               schema::optional("times", list(quantity("s", 0.0), 1), Said{"its end"}, "of the cyclogram, rising"),
               schema::optional("r_test", schema::map(r_test), "a ball on the turning work, read by sensors on the tool"),
               schema::optional("ball_bar", schema::map(ball_bar), "a circle of two linear axes about a ball on the work")},
      .about = "The error of the tool against the work over the poses of a grid (docs/how-to/poses.md)."};
}

VolumeSettings read_volume(const ConfigMap& in, const std::vector<MovingAxis>& axes,
                           const std::vector<Cyclogram>& cyclograms) {
  VolumeSettings volume{.cyclogram = in.choice("cyclogram", names_of(cyclograms)),
                        .tool = read_point(in.map("tool")),
                        .work = in.text("work"),
                        .positions_SI = {},
                        .times_s = {},
                        .where = in.where("work")};
  schema::Map of_axes{.name = "volume, positions"};
  for (const MovingAxis& axis : axes)
    of_axes.keys.push_back(
        schema::optional(axis.name, schema::list(schema::quantity(axis.way.turns ? "deg" : "m"), 1), "positions"));
  const ConfigMap positions = in.map("positions").described_by(of_axes);
  const std::vector<std::string> known = names_of(axes);
  for (const std::string& name : positions.keys()) {
    if (known.empty()) positions.fail(name, "the scenario has no `axes`, so the machine has one pose only");
    if (!is_in(known, name))
      positions.fail(name, fmt::format("there is no axis '{}'; there are {}", name, fmt::join(known, ", ")));
  }
  for (const MovingAxis& axis : axes) {
    volume.positions_SI.push_back(positions.has(axis.name) ? read_positions_SI(positions, axis.name, axis)
                                                           : std::vector{axis.at_SI});
    if (!is_rising(volume.positions_SI.back())) positions.fail(axis.name, "the positions must rise");
  }
  positions.reject_unknown_keys();
  const auto run =
      std::find_if(cyclograms.begin(), cyclograms.end(), [&](const Cyclogram& c) { return c.name == volume.cyclogram; });
  volume.times_s = in.has("times") ? in.quantities("times") : std::vector{run->duration_s()};
  if (!is_rising(volume.times_s)) in.fail("times", "the times must rise");
  if (volume.times_s.back() > run->duration_s())
    in.fail("times", fmt::format("cyclogram '{}' ends at {:g} min", run->name, run->duration_s() / 60.0));
  if (const auto r_test = in.optional_map("r_test")) volume.r_test = read_r_test(*r_test, axes, volume.work);
  if (const auto ball_bar = in.optional_map("ball_bar")) volume.ball_bar = read_ball_bar(*ball_bar, axes);
  in.reject_unknown_keys();
  return volume;
}

}  // namespace driftwright::scenarios
