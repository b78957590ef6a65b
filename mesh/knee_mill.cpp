#include "mesh/knee_mill.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include "mesh/gmsh_parts.hpp"

namespace driftwright::mesh {
namespace {

namespace occ = gmsh::model::occ;

constexpr double kPartTolerance_m = 1e-6;

int cylinder(double y_start_m, double y_end_m, double z_m, double diameter_m) {
  return occ::addCylinder(0, y_start_m, z_m, 0, y_end_m - y_start_m, 0, 0.5 * diameter_m);
}

int cut(int body, const std::vector<int>& tools) {
  gmsh::vectorpair out, tool_tags;
  std::vector<gmsh::vectorpair> map;
  for (int t : tools) tool_tags.emplace_back(3, t);
  occ::cut({{3, body}}, tool_tags, out, map);
  return out.at(0).second;
}

int fuse(int body, const std::vector<int>& others) {
  gmsh::vectorpair out, tool_tags;
  std::vector<gmsh::vectorpair> map;
  for (int t : others) tool_tags.emplace_back(3, t);
  occ::fuse({{3, body}}, tool_tags, out, map);
  return out.at(0).second;
}

/// Positions along Y and Z that several parts need.
struct Layout {
  explicit Layout(const KneeMill& m)
      : head_front_m(m.headstock_overhang_m),
        head_back_m(m.headstock_overhang_m - m.headstock.depth_m),
        head_bottom_m(m.column.height_m),
        axis_z_m(m.column.height_m + m.axis_height_m),
        quill_front_m(head_front_m + m.quill_stick_out_m),
        quill_back_m(quill_front_m - m.quill_length_m) {}
  double head_front_m, head_back_m, head_bottom_m, axis_z_m, quill_front_m, quill_back_m;
};

int add_column(const KneeMill& m) {
  const auto& [w, d, h, t] = m.column;
  const int outer = occ::addBox(-0.5 * w, -d, 0, w, d, h);
  return cut(outer, {occ::addBox(-0.5 * w + t, -d + t, t, w - 2 * t, d - 2 * t, h - 2 * t)});
}

int add_headstock(const KneeMill& m, const Layout& at) {
  const auto& [w, d, h, t] = m.headstock;
  const int outer = occ::addBox(-0.5 * w, at.head_back_m, at.head_bottom_m, w, d, h);
  const int cavity = occ::addBox(-0.5 * w + t, at.head_back_m + t, at.head_bottom_m + t, w - 2 * t, d - 2 * t, h - 2 * t);
  const int shell = cut(outer, {cavity});
  const int barrel = cylinder(at.quill_back_m, at.head_front_m - 0.5 * t, at.axis_z_m, m.barrel_diameter_m);
  // A web carries the barrel along its length; otherwise only the front wall would hold it.
  const int web = occ::addBox(-0.5 * t, at.quill_back_m, at.head_bottom_m + 0.5 * t, t,
                              at.head_front_m - 0.5 * t - at.quill_back_m, at.axis_z_m - at.head_bottom_m - 0.5 * t);
  const int body = fuse(shell, {barrel, web});
  return cut(body, {cylinder(at.quill_back_m, at.head_front_m, at.axis_z_m, m.quill_diameter_m)});
}

int add_ring(double y_start_m, double y_end_m, double z_m, double outer_m, double inner_m) {
  return cut(cylinder(y_start_m, y_end_m, z_m, outer_m), {cylinder(y_start_m, y_end_m, z_m, inner_m)});
}

struct Named {
  std::string region;
  int volume;
  double mesh_size_m;
};

std::vector<Named> add_parts(const KneeMill& m, const Layout& at) {
  const double front_end = at.quill_front_m - m.bearing_front.setback_m;
  const double rear_start = at.quill_back_m + m.bearing_rear.setback_m;
  const double knee_top = m.knee_bottom_m + m.knee_height_m;
  return {
      {"column", add_column(m), m.coarse_m},
      {"headstock", add_headstock(m, at), 0.8 * m.coarse_m},
      {"quill", add_ring(at.quill_back_m, at.quill_front_m, at.axis_z_m, m.quill_diameter_m, m.quill_bore_m),
       1.5 * m.fine_m},
      {"spindle", cylinder(at.quill_back_m, at.quill_front_m + m.spindle_stick_out_m, at.axis_z_m, m.spindle_diameter_m),
       1.5 * m.fine_m},
      {"bearing_front",
       add_ring(front_end - m.bearing_front.width_m, front_end, at.axis_z_m, m.quill_bore_m, m.spindle_diameter_m),
       m.fine_m},
      {"bearing_rear",
       add_ring(rear_start, rear_start + m.bearing_rear.width_m, at.axis_z_m, m.quill_bore_m, m.spindle_diameter_m),
       m.fine_m},
      {"motor", cylinder(at.head_back_m - m.motor_length_m, at.head_back_m, at.axis_z_m, m.motor_diameter_m), m.coarse_m},
      {"knee", occ::addBox(-0.5 * m.knee_width_m, 0, m.knee_bottom_m, m.knee_width_m, m.knee_depth_m, m.knee_height_m),
       1.5 * m.coarse_m},
      {"table",
       occ::addBox(-0.5 * m.table_width_m, m.table_gap_m, knee_top, m.table_width_m, m.table_depth_m, m.table_thickness_m),
       1.5 * m.coarse_m},
  };
}

bool strictly_inside(const OuterFace& face, const std::array<double, 3>& low, const std::array<double, 3>& high) {
  for (int i = 0; i < 3; ++i) {
    if (face.low[i] < low[i] + kPartTolerance_m || face.high[i] > high[i] - kPartTolerance_m) return false;
  }
  return true;
}

std::string surface_name(const KneeMill& m, const Layout& at, const OuterFace& face) {
  const double tol = 10 * kPartTolerance_m;
  if (face.region == "column") {
    if (face.high[2] < tol) return "foot";
    const bool inner = strictly_inside(face, {-0.5 * m.column.width_m, -m.column.depth_m, 0},
                                       {0.5 * m.column.width_m, 0, m.column.height_m});
    return inner ? "column_inner" : "column_outer";
  }
  if (face.region == "headstock") {
    const bool inner =
        strictly_inside(face, {-0.5 * m.headstock.width_m, at.head_back_m, at.head_bottom_m},
                        {0.5 * m.headstock.width_m, at.head_front_m, at.head_bottom_m + m.headstock.height_m});
    return inner ? "headstock_inner" : "headstock_outer";
  }
  if (face.region == "quill") return face.low[1] > at.head_front_m - tol ? "quill_outer" : "quill_inner";
  if (face.region == "spindle") return face.high[1] > at.quill_front_m + tol ? "spindle_nose" : "spindle_inner";
  if (face.region.starts_with("bearing")) return face.region + "_sides";
  return face.region + "_outer";
}

void check_fits(const ConfigMap& in, const KneeMill& m) {
  const auto require = [&](bool ok, const char* key, const std::string& message) {
    if (!ok) in.fail(key, message);
  };
  const double half_m = 0.5 * m.barrel_diameter_m + m.headstock.wall_m;
  require(2 * m.column.wall_m < std::min({m.column.width_m, m.column.depth_m, m.column.height_m}), "column",
          "the walls are thicker than the column");
  require(m.headstock_overhang_m < m.headstock.depth_m, "headstock", "the headstock hangs wholly in front of the column");
  require(m.axis_height_m > half_m && m.headstock.height_m - m.axis_height_m > half_m, "headstock",
          "the barrel does not fit between floor and roof of the headstock; change axis_height, height or "
          "barrel_diameter");
  require(m.barrel_diameter_m > m.quill_diameter_m && m.quill_diameter_m > m.quill_bore_m &&
              m.quill_bore_m > m.spindle_diameter_m,
          "quill", "diameters must fall from barrel to quill, quill bore and spindle");
  require(m.quill_length_m > m.quill_stick_out_m + m.headstock.wall_m &&
              m.quill_length_m - m.quill_stick_out_m < m.headstock.depth_m - m.headstock.wall_m,
          "quill", "the quill must end inside the headstock, behind its front wall and before its back wall");
  require(m.bearing_front.setback_m + m.bearing_front.width_m + m.bearing_rear.setback_m + m.bearing_rear.width_m <
              m.quill_length_m,
          "bearings", "the bearings overlap inside the quill");
  require(m.knee_bottom_m + m.knee_height_m < m.column.height_m, "knee", "the knee reaches over the column");
  require(m.table_gap_m < m.knee_depth_m, "table", "the table does not lie on the knee");
}

}  // namespace

const schema::Map& knee_mill_schema() {
  using namespace schema;
  struct Length {
    const char *name, *meaning;
  };
  const auto part = [](const char* name, const char* of, const std::vector<Length>& lengths) {
    schema::Map map{.name = std::string("machine (knee_mill), ") + name};
    for (const Length& l : lengths) map.keys.push_back(compulsory(l.name, quantity("m", 1e-3, 50.0), l.meaning));
    return compulsory(name, schema::map(map), of);
  };
  const auto bearings = [&] {
    schema::Map map{.name = "machine (knee_mill), bearings"};
    for (const char* which : {"front", "rear"})
      map.keys.push_back(
          part(which, "one of the two", {{"width", "along the axis"}, {"setback", "from the end of the quill"}}));
    return compulsory("bearings", schema::map(map), "rings between spindle and quill");
  };
  static const schema::Map description = {
      .name = "machine (knee_mill)",
      .keys = {
          compulsory("generator", choice({"knee_mill"}), "a knee-type milling machine, drawn by its dimensions"),
          part("column", "a box of walls",
               {{"width", "along x"}, {"depth", "along y"}, {"height", "along z"}, {"wall", "thickness of the walls"}}),
          part("headstock", "a box of walls on the column, with the barrel of the quill",
               {{"width", "along x"},
                {"depth", "along y"},
                {"height", "along z"},
                {"wall", "thickness of the walls"},
                {"overhang", "in front of the column"},
                {"barrel_diameter", "of the hole that the quill is in"},
                {"axis_height", "of the spindle's axis above the headstock's floor"}}),
          part("quill", "the sleeve that carries the spindle",
               {{"diameter", "outside"},
                {"bore", "inside"},
                {"length", "along the axis"},
                {"stick_out", "in front of the headstock"}}),
          part("spindle", "a solid shaft", {{"diameter", "of the shaft"}, {"stick_out", "in front of the quill"}}),
          bearings(),
          part("motor", "a cylinder behind the headstock", {{"diameter", "outside"}, {"length", "along the axis"}}),
          part("knee", "a block in front of the column",
               {{"width", "along x"}, {"depth", "along y"}, {"height", "along z"}, {"bottom", "height of its underside"}}),
          part("table", "a plate on the knee",
               {{"width", "along x"}, {"depth", "along y"}, {"thickness", "along z"}, {"gap", "to the column"}}),
          part("mesh_size", "edges of the elements",
               {{"frame", "of the castings"}, {"spindle", "of quill, spindle and bearings"}}),
          schema::optional("element_order", integer(1, 2), 2, "2; 1 is far too stiff in bending")}};
  return description;
}

KneeMill read_knee_mill(const ConfigMap& in) {
  const auto length = [](const ConfigMap& map, const char* key) { return map.quantity(key); };
  KneeMill m{};
  const ConfigMap column = in.map("column");
  m.column = {length(column, "width"), length(column, "depth"), length(column, "height"), length(column, "wall")};
  const ConfigMap head = in.map("headstock");
  m.headstock = {length(head, "width"), length(head, "depth"), length(head, "height"), length(head, "wall")};
  m.headstock_overhang_m = length(head, "overhang");
  m.barrel_diameter_m = length(head, "barrel_diameter");
  m.axis_height_m = length(head, "axis_height");
  const ConfigMap quill = in.map("quill");
  m.quill_diameter_m = length(quill, "diameter");
  m.quill_bore_m = length(quill, "bore");
  m.quill_length_m = length(quill, "length");
  m.quill_stick_out_m = length(quill, "stick_out");
  const ConfigMap spindle = in.map("spindle");
  m.spindle_diameter_m = length(spindle, "diameter");
  m.spindle_stick_out_m = length(spindle, "stick_out");
  const ConfigMap bearings = in.map("bearings"), front = bearings.map("front"), rear = bearings.map("rear");
  m.bearing_front = {length(front, "width"), length(front, "setback")};
  m.bearing_rear = {length(rear, "width"), length(rear, "setback")};
  const ConfigMap motor = in.map("motor");
  m.motor_diameter_m = length(motor, "diameter");
  m.motor_length_m = length(motor, "length");
  const ConfigMap knee = in.map("knee");
  m.knee_width_m = length(knee, "width");
  m.knee_depth_m = length(knee, "depth");
  m.knee_height_m = length(knee, "height");
  m.knee_bottom_m = length(knee, "bottom");
  const ConfigMap table = in.map("table");
  m.table_width_m = length(table, "width");
  m.table_depth_m = length(table, "depth");
  m.table_thickness_m = length(table, "thickness");
  m.table_gap_m = length(table, "gap");
  const ConfigMap size = in.map("mesh_size");
  m.coarse_m = length(size, "frame");
  m.fine_m = length(size, "spindle");
  m.element_order = in.integer("element_order");
  for (const ConfigMap* map : {&column, &head, &quill, &spindle, &bearings, &front, &rear, &motor, &knee, &table, &size}) {
    map->reject_unknown_keys();
  }
  check_fits(in, m);
  return m;
}

KneeMill with_mesh_size_times(KneeMill mill, double factor) {
  mill.coarse_m *= factor;
  mill.fine_m *= factor;
  return mill;
}

Mesh build_knee_mill(const KneeMill& mill) {
  const GmshSession session;
  return with_gmsh_errors([&] {
    const Layout at(mill);
    const std::vector<Named> named = add_parts(mill, at);
    gmsh::vectorpair all, out;
    std::vector<gmsh::vectorpair> map;
    for (const Named& n : named) all.emplace_back(3, n.volume);
    occ::fragment({all.front()}, {all.begin() + 1, all.end()}, out, map);
    occ::synchronize();
    std::vector<Part> parts;
    for (std::size_t i = 0; i < named.size(); ++i) {
      Part part{named[i].region, {}, named[i].mesh_size_m};
      for (const auto& [dim, tag] : map[i]) part.volumes.push_back(tag);
      parts.push_back(std::move(part));
    }
    return mesh_parts(parts, mill.element_order, [&](const OuterFace& face) { return surface_name(mill, at, face); });
  });
}

}  // namespace driftwright::mesh
