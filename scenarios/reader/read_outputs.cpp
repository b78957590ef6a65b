#include "scenarios/reader/read_outputs.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace driftwright::scenarios {
namespace {

int read_axis(const ConfigMap& in, const std::string& key) {
  return in.choice(key, {"x", "y", "z"})[0] - 'x';
}

PointOnRegion read_point(const ConfigMap& in) {
  PointOnRegion point{in.text("region"), in.vector3("at", "m"), in.where("at")};
  in.reject_unknown_keys();
  return point;
}

BySensitivity read_sensitivities(const ConfigMap& in) {
  BySensitivity by{.terms = {}, .where = in.where("sensitivities")};
  for (const ConfigMap& term : in.maps("sensitivities")) {
    const bool is_node = !term.has("region");
    const effects::Body body = is_node ? effects::node(term.text("node")) : effects::region(term.text("region"));
    by.terms.push_back({body, 1e-6 * term.quantity("sensitivity", "um/K", -1e6, 1e6)});
    term.reject_unknown_keys();
  }
  if (by.terms.empty()) {
    in.fail("sensitivities",
            "a list of {node or region, sensitivity} is wanted, such as [{node: spindle, sensitivity: 8 um/K}]");
  }
  return by;
}

/// `positions: {axis: x, at: [-200 mm, 0 mm, 200 mm]}`: where the table has travelled to.
std::vector<DisplacementOutput> at_positions(const ConfigMap& in, const DisplacementOutput& base) {
  const int axis = read_axis(in, "axis");
  std::vector<DisplacementOutput> outputs;
  for (double travel_m : in.quantities("at", "m")) {
    DisplacementOutput output = base;
    output.points->travel_m = travel_m * Eigen::Vector3d::Unit(axis);
    output.name = fmt::format("{}_{}{:.0f}", base.name, "xyz"[axis], 1e3 * travel_m);
    for (const DisplacementOutput& other : outputs) {
      if (other.name == output.name)
        in.fail("at", fmt::format("two positions make the name '{}'; they must differ by 1 mm", output.name));
    }
    outputs.push_back(std::move(output));
  }
  in.reject_unknown_keys();
  return outputs;
}

}  // namespace

Sensor read_sensor(const ConfigMap& in) {
  Sensor sensor{.name = in.name("name"), .place = {}, .where = in.where()};
  if (in.has("node")) {
    sensor.place = in.text("node");
    sensor.where = in.where("node");
  } else {
    sensor.place = PointOnRegion{in.text("region"), in.vector3("at", "m"), in.where("at")};
  }
  in.reject_unknown_keys();
  return sensor;
}

std::vector<DisplacementOutput> read_displacements(const ConfigMap& in) {
  DisplacementOutput base{.name = in.name("name")};
  if (in.has("sensitivities")) base.by_sensitivity = read_sensitivities(in);
  const bool has_points = in.has("along") || in.has("tool") || in.has("table") || in.has("positions");
  if (base.by_sensitivity && !has_points) {
    in.reject_unknown_keys();
    return {base};
  }
  base.points = ToolAgainstTable{.axis = read_axis(in, "along"), .tool = read_point(in.map("tool")), .table = {}};
  if (const auto table = in.optional_map("table")) base.points->table = read_point(*table);
  const auto positions = in.optional_map("positions");
  if (positions && !base.points->table)
    in.fail("positions", "these are positions of the table; `table` says where it is in the mesh");
  in.reject_unknown_keys();
  if (positions) return at_positions(*positions, base);
  return {base};
}

TiltOutput read_tilt(const ConfigMap& in) {
  TiltOutput t{in.name("name"), read_axis(in, "about"), read_point(in.map("from")), read_point(in.map("to")),
               read_point(in.map("table"))};
  const Eigen::Vector3d line_m = t.to.at_m - t.from.at_m;
  if (line_m.cross(Eigen::Vector3d::Unit(t.axis)).norm() < 1e-3) {
    in.fail("about", "the line from -> to must reach at least 1 mm across this axis; a line does not tilt about itself");
  }
  in.reject_unknown_keys();
  return t;
}

}  // namespace driftwright::scenarios
