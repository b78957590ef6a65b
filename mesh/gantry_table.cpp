#include "mesh/gantry_table.hpp"

#include <gmsh.h>

#include <cmath>

#include "mesh/gmsh_parts.hpp"

namespace driftwright::mesh {
namespace {

namespace occ = gmsh::model::occ;

constexpr double kFaceTolerance_m = 1e-5;

int box(double x_m, double y_m, double bottom_m, const GantryTable::Box& size) {
  return occ::addBox(x_m - 0.5 * size.length_m, y_m - 0.5 * size.width_m, bottom_m, size.length_m, size.width_m,
                     size.height_m);
}

/// Plate and two guideways in one body.
int add_bed(const GantryTable& t) {
  const double top_m = -t.table.height_m, plate_m = top_m - t.guideway_height_m;
  const int plate = box(0.0, 0.0, plate_m - t.bed.height_m, t.bed);
  const GantryTable::Box way{t.bed.length_m, t.guideway_width_m, t.guideway_height_m};
  gmsh::vectorpair out;
  std::vector<gmsh::vectorpair> map;
  occ::fuse({{3, plate}},
            {{3, box(0.0, -0.5 * t.guideway_gauge_m, plate_m, way)}, {3, box(0.0, 0.5 * t.guideway_gauge_m, plate_m, way)}},
            out, map);
  return out.at(0).second;
}

std::string surface_name(const GantryTable& t, const OuterFace& face) {
  const auto flat_at = [&](int axis, double at_m) {
    return std::abs(face.low[axis] - at_m) < kFaceTolerance_m && std::abs(face.high[axis] - at_m) < kFaceTolerance_m;
  };
  if (face.region == "workpiece") return "workpiece_outer";
  if (face.region == "table") {
    if (flat_at(2, 0.0)) return "table_top";
    if (flat_at(2, -t.table.height_m)) return "table_underside";
    if (flat_at(0, -0.5 * t.table.length_m)) return "table_low_x";
    if (flat_at(0, 0.5 * t.table.length_m)) return "table_high_x";
    return flat_at(1, -0.5 * t.table.width_m) ? "table_low_y" : "table_high_y";
  }
  const double plate_m = -t.table.height_m - t.guideway_height_m;
  if (flat_at(2, plate_m - t.bed.height_m)) return "bed_underside";
  const bool level = face.high[2] - face.low[2] < kFaceTolerance_m;
  return level ? "bed_top" : "bed_sides";
}

}  // namespace

const schema::Map& gantry_table_schema() {
  using namespace schema;
  const auto length = [](const char* name, const char* meaning) {
    return compulsory(name, quantity("m", 1e-3, 100.0), meaning);
  };
  const auto box = [&](const char* of) {
    return schema::Map{.name = std::string("machine (gantry_table), ") + of,
                       .keys = {length("length", "along x"), length("width", "along y"), length("height", "along z")}};
  };
  schema::Map workpiece = box("workpiece"), table = box("table"), bed = box("bed");
  workpiece.keys.push_back(compulsory("at", schema::vector3("m"), "middle of its underside on the table, with z 0 mm"));
  const schema::Map guideways = {.name = "machine (gantry_table), guideways",
                                 .keys = {length("width", "of one"), length("height", "above the bed"),
                                          length("gauge", "between the middles of the two")}};
  static const schema::Map description = {
      .name = "machine (gantry_table)",
      .keys = {
          compulsory("generator", choice({"gantry_table"}), "the table of a gantry mill on its bed (docs/how-to/table.md)"),
          compulsory("table", schema::map(table), "a plate as thick as the iron in its ribs and walls would be"),
          compulsory("bed", schema::map(bed), "the same"),
          compulsory("guideways", schema::map(guideways), "two, on the bed; they carry the table"),
          schema::optional("workpiece", schema::map(workpiece), "a block on the table"),
          compulsory("mesh_size", quantity("m", 0.02, 10.0), "edges of the elements; half as long again in the bed"),
          schema::optional("element_order", integer(1, 2), 2, "2; 1 is far too stiff in bending")}};
  return description;
}

GantryTable read_gantry_table(const ConfigMap& in) {
  const auto length = [](const ConfigMap& map, const char* key) { return map.quantity(key); };
  const auto size = [&](const ConfigMap& map) {
    return GantryTable::Box{length(map, "length"), length(map, "width"), length(map, "height")};
  };
  GantryTable t{};
  const ConfigMap table = in.map("table"), bed = in.map("bed"), ways = in.map("guideways");
  t.table = size(table);
  t.bed = size(bed);
  t.guideway_width_m = length(ways, "width");
  t.guideway_height_m = length(ways, "height");
  t.guideway_gauge_m = length(ways, "gauge");
  for (const ConfigMap* map : {&table, &bed, &ways}) map->reject_unknown_keys();
  if (t.guideway_gauge_m + t.guideway_width_m > std::min(t.table.width_m, t.bed.width_m))
    in.fail("guideways", "the guideways reach beyond the bed or the table");
  if (t.guideway_gauge_m <= t.guideway_width_m) in.fail("guideways", "the guideways overlap; a wider gauge is required");
  if (const auto piece = in.optional_map("workpiece")) {
    t.workpiece = size(*piece);
    const Eigen::Vector3d at_m = piece->vector3("at");
    t.workpiece_x_m = at_m[0];
    t.workpiece_y_m = at_m[1];
    piece->reject_unknown_keys();
    if (std::abs(t.workpiece_x_m) + 0.5 * t.workpiece->length_m > 0.5 * t.table.length_m ||
        std::abs(t.workpiece_y_m) + 0.5 * t.workpiece->width_m > 0.5 * t.table.width_m || at_m[2] != 0.0) {
      in.fail("workpiece", "the workpiece does not lie on the table; `at` is the middle of its underside, with z 0 mm");
    }
  }
  t.mesh_size_m = in.quantity("mesh_size");
  t.element_order = in.integer("element_order");
  return t;
}

GantryTable with_mesh_size_times(GantryTable table, double factor) {
  table.mesh_size_m *= factor;
  return table;
}

Mesh build_gantry_table(const GantryTable& t) {
  const GmshSession session;
  return with_gmsh_errors([&] {
    std::vector<Part> parts = {{"table", {box(0.0, 0.0, -t.table.height_m, t.table)}, t.mesh_size_m},
                               {"bed", {add_bed(t)}, 1.5 * t.mesh_size_m}};
    if (t.workpiece)
      parts.push_back({"workpiece", {box(t.workpiece_x_m, t.workpiece_y_m, 0.0, *t.workpiece)}, t.mesh_size_m});
    gmsh::vectorpair all, out;
    std::vector<gmsh::vectorpair> map;
    for (const Part& part : parts) all.emplace_back(3, part.volumes.front());
    occ::fragment({all.front()}, {all.begin() + 1, all.end()}, out, map);
    occ::synchronize();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      parts[i].volumes.clear();
      for (const auto& [dim, tag] : map[i]) parts[i].volumes.push_back(tag);
    }
    return mesh_parts(parts, t.element_order, [&](const OuterFace& face) { return surface_name(t, face); });
  });
}

}  // namespace driftwright::mesh
