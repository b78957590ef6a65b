#include "scenarios/reader/read_outputs.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace driftwright::scenarios {
namespace {

using namespace schema;

int read_axis(const ConfigMap& in, const std::string& key) {
  return in.choice(key)[0] - 'x';
}

Value axis() {
  return choice({"x", "y", "z"});
}

BySensitivity read_sensitivities(const ConfigMap& in) {
  BySensitivity by{.terms = {}, .where = in.where("sensitivities")};
  for (const ConfigMap& term : in.maps("sensitivities")) {
    const bool is_node = term.has("node");
    const effects::Body body = is_node ? effects::node(term.text("node")) : effects::region(term.text("region"));
    by.terms.push_back({body, 1e-6 * term.quantity("sensitivity")});
    term.reject_unknown_keys();
  }
  if (by.terms.empty()) {
    in.fail("sensitivities",
            "this must be a list of {node or region, sensitivity}, such as [{node: spindle, sensitivity: 8 um/K}]");
  }
  return by;
}

/// The name of an output at a position. @throws InputError  if another output has it
std::string name_at(const ConfigMap& in, const std::string& name, double position_m,
                    const std::vector<DisplacementOutput>& others) {
  std::string full = fmt::format("{}{:.0f}", name, 1e3 * position_m);
  for (const DisplacementOutput& other : others) {
    if (other.name == full) in.fail("at", fmt::format("two positions make the name '{}'; they must differ by 1 mm", full));
  }
  return full;
}

/// `positions: {axis: x, at: [-200 mm, 0 mm, 200 mm]}`: the positions that the table travels to.
std::vector<DisplacementOutput> at_positions(const ConfigMap& in, const DisplacementOutput& base) {
  const int axis = read_axis(in, "axis");
  std::vector<DisplacementOutput> outputs;
  for (double travel_m : in.quantities("at")) {
    DisplacementOutput output = base;
    output.points->travel_m = travel_m * Eigen::Vector3d::Unit(axis);
    output.name = name_at(in, fmt::format("{}_{}", base.name, "xyz"[axis]), travel_m, outputs);
    outputs.push_back(std::move(output));
  }
  in.reject_unknown_keys();
  return outputs;
}

/// `screw: x_screw, at: [0 mm, 400 mm, 800 mm]`: places of the axis; without `at` the place of the nut.
std::vector<DisplacementOutput> on_screw(const ConfigMap& in, DisplacementOutput base) {
  base.on_screw = OnScrew{.screw = in.text("screw"), .at_m = {}, .where = in.where("screw"), .entry = base.name};
  if (!base.by_sensitivity) base.by_sensitivity = BySensitivity{.terms = {}, .where = in.where("screw")};
  if (!in.has("at")) return {base};
  std::vector<DisplacementOutput> outputs;
  for (const double position_m : in.quantities("at")) {
    DisplacementOutput output = base;
    output.name = name_at(in, base.name + "_", position_m, outputs);
    output.on_screw->at_m = position_m;
    output.on_screw->where = in.where("at");
    outputs.push_back(std::move(output));
  }
  return outputs;
}

}  // namespace

schema::Value point_schema() {
  return schema::map({.name = "points",
                      .keys = {compulsory("region", text(), "that the point moves with"),
                               compulsory("at", schema::vector3("m"), "moved onto the region by at most 5 mm")},
                      .about = "A point on or in a region of the mesh."});
}

PointOnRegion read_point(const ConfigMap& in) {
  PointOnRegion point{in.text("region"), in.vector3("at"), in.where("at")};
  in.reject_unknown_keys();
  return point;
}

schema::Map sensor_schema() {
  return {.name = "sensors",
          .keys = {compulsory("name", schema::name(), "of its channel"),
                   schema::optional("region", text(), "of the mesh that it sits on"),
                   schema::optional("at", schema::vector3("m"), "where on it; moved onto the region by at most 5 mm"),
                   schema::optional("node", text(), "or: a lumped node, or `ambient`")},
          .groups = {{Group::Rule::kExactlyOne, {"node", "region"}, "where does it sit? Write `region` and `at`, or `node`"},
                     {Group::Rule::kAllOrNone, {"region", "at"}, "both are required"}},
          .about = "Thermometers."};
}

schema::Map displacement_schema() {
  const schema::Map term = {
      .name = "displacements, sensitivities",
      .keys = {schema::optional("node", text(), "lumped node whose temperature it follows"),
               schema::optional("region", text(), "or: region of the mesh, by its mean temperature"),
               compulsory("sensitivity", quantity("um/K", -1e6, 1e6), "positive moves the tool along the axis")},
      .groups = {{Group::Rule::kExactlyOne, {"node", "region"}, "exactly one of `node` and `region` is required"}}};
  const schema::Map positions = {.name = "displacements, positions",
                                 .keys = {compulsory("axis", axis(), "that the table travels along"),
                                          compulsory("at", list(quantity("m"), 1), "where it has travelled to")}};
  return {
      .name = "displacements",
      .keys =
          {compulsory("name", schema::name(), "of its channel"),
           schema::optional("along", axis(), "the axis that it is measured along"),
           schema::optional("tool", point_schema(), "point of the tool"),
           schema::optional("table", point_schema(), Said{"the ground"},
                            "point that the indicator's stand moves and turns with"),
           schema::optional(
               "positions", schema::map(positions),
               "one output for each place that the table has travelled to: the indicator then rests on another spot of it"),
           schema::optional("sensitivities", schema::maps(term),
                            "summed over T - T_reference, alone or beside what the points do (below)"),
           schema::optional("screw", text(),
                            "name that an effect `feed_axis` gives: the error of its axis, alone or beside the others"),
           schema::optional("at", list(quantity("m"), 1), Said{"where the nut is"},
                            "beside `screw`: positions of the axis, one output each")},
      .groups = {{Group::Rule::kAllOrNone, {"along", "tool"}, "both are required"},
                 {Group::Rule::kAtLeastOne,
                  {"along", "sensitivities", "screw"},
                  "points (`along`, `tool`), `sensitivities` or a `screw` are required"}},
      .about = "Displacements of the tool against the table: actual - commanded."};
}

schema::Map tilt_schema() {
  return {.name = "tilts",
          .keys = {compulsory("name", schema::name(), "of its channel"),
                   compulsory("about", axis(), "the axis that the line tilts about"),
                   compulsory("from", point_schema(), "where the line begins"),
                   compulsory("to", point_schema(), "where it ends"),
                   compulsory("table", point_schema(), "what it tilts against")},
          .about = "Changes of the angle of a line against the table (ISO 230-3)."};
}

Sensor read_sensor(const ConfigMap& in) {
  Sensor sensor{.name = in.name("name"), .place = {}, .where = in.where()};
  if (in.has("node")) {
    sensor.place = in.text("node");
    sensor.where = in.where("node");
  } else {
    sensor.place = PointOnRegion{in.text("region"), in.vector3("at"), in.where("at")};
  }
  in.reject_unknown_keys();
  return sensor;
}

std::vector<DisplacementOutput> read_displacements(const ConfigMap& in) {
  DisplacementOutput base{.name = in.name("name")};
  if (in.has("sensitivities")) base.by_sensitivity = read_sensitivities(in);
  const auto table = in.optional_map("table"), positions = in.optional_map("positions");
  const bool has_points = in.has("along") || in.has("tool") || table || positions, has_screw = in.has("screw");
  if (in.has("at") && !has_screw) in.fail("at", "these are positions of the axis of a `screw`, which is missing");
  if (has_screw && positions)
    in.fail("positions", "a displacement may have positions of the table, or a `screw`; write two displacements");
  if ((base.by_sensitivity || has_screw) && !has_points) {
    in.reject_unknown_keys();
    return has_screw ? on_screw(in, base) : std::vector{base};
  }
  base.points = ToolAgainstTable{.axis = read_axis(in, "along"), .tool = read_point(in.map("tool")), .table = {}};
  if (table) base.points->table = read_point(*table);
  if (positions && !base.points->table)
    in.fail("positions", "these are positions of the table; `table` says where it is in the mesh");
  in.reject_unknown_keys();
  if (positions) return at_positions(*positions, base);
  if (has_screw) return on_screw(in, base);
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
