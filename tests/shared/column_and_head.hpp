#pragma once
// A small machine from a mesh file: a column and a head on it, in 28 cells, as a user writes it.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::fixtures {

/// Abaqus text of a mesh in mm: element 100 + c, node 10 + n, one ELSET a region.
inline std::string inp_text(const mesh::Mesh& m) {
  std::string text = "*NODE\n";
  for (int n = 0; n < m.n_nodes(); ++n) {
    text += fmt::format("{}, {:.12g}, {:.12g}, {:.12g}\n", 10 + n, 1e3 * m.coords(0, n), 1e3 * m.coords(1, n),
                        1e3 * m.coords(2, n));
  }
  for (std::size_t r = 0; r < m.regions.size(); ++r) {
    text += fmt::format("*ELEMENT, TYPE=C3D20, ELSET={}\n", m.regions[r]);
    for (int c : m.cells_in(static_cast<int>(r))) {
      text += fmt::format("{}", 100 + c);
      int i = 0;
      for (int n : m.cells.nodes(c)) text += fmt::format(",{}{}", ++i == 16 ? "\n" : " ", 10 + n);
      text += "\n";
    }
  }
  return text;
}

/// A column of 100 x 100 x 300 mm with a head of 100 x 200 x 100 mm on it, that share no nodes.
inline mesh::Mesh column_and_head() {
  mesh::Mesh m;
  add_box(m, {{0, 0, 0}, {0.1, 0.1, 0.3}, {2, 2, 4}, mesh::CellShape::kHex20}, "column", "c.");
  add_box(m, {{0, 0, 0.3}, {0.1, 0.2, 0.1}, {2, 3, 2}, mesh::CellShape::kHex20}, "head", "h.");
  return m;
}

/// Blocks of its scenario; each may be replaced.
struct ColumnAndHead {
  std::string materials = "{column: cast_iron_gjl250, head: cast_iron_gjl250}";
  std::vector<std::string> effects = {kHeat, kFilm, kContact};
  std::string ambient = "[[0 min, 20 degC], [60 min, 21.5 degC]]";
  std::string start = "reference";
  std::string sensor_y = "150 mm";
  std::string cyclograms = "{cycle: [[40 min, 1000 rpm], [20 min, 0 rpm], [30 min, 600 rpm]]}";
  std::string solver = "{output_interval: 5 min, fields_format: none, model: reduced}";
  std::string more = {};  ///< further keys

  static constexpr const char* kHeat = "{type: heat_source, region: head, power: 60 W, at_speed: 1000 rpm, exponent: 1}";
  static constexpr const char* kFilm = "{type: convection, surface: outside, film: 10 W/(m^2 K)}";
  static constexpr const char* kFan =
      "{type: forced_convection, surface: outside, growth: 12 W/(m^2 K), at_speed: 1000 rpm, exponent: 0.7}";
  static constexpr const char* kContact = "{type: contact, joint: column/head, conductance: 2000 W/(m^2 K)}";

  [[nodiscard]] std::string text() const {
    std::string list;
    for (const std::string& e : effects) list += "  - " + e + "\n";
    return fmt::format(R"(name: column_and_head
reference_temperature: 20 degC
start: {}
machine:
  mesh: machine.inp
  units: mm
  surfaces:
    - {{name: foot, region: column, plane: {{through: [0 mm, 0 mm, 0 mm], normal: [0, 0, -1]}}}}
    - {{name: column_top, region: column, plane: {{through: [0 mm, 0 mm, 300 mm], normal: [0, 0, 1]}}}}
    - {{name: head_bottom, region: head, plane: {{through: [0 mm, 0 mm, 300 mm], normal: [0, 0, -1]}}}}
    - {{name: front, region: head, plane: {{through: [0 mm, 200 mm, 0 mm], normal: [0, 1, 0]}}}}
    - {{name: outside, remaining: true}}
  joints:
    - {{name: column/head, a: column_top, b: head_bottom}}
materials: {}
supports:
  - {{surface: foot, fixed: [x, y, z]}}
effects:
{}ambient: {}
sensors:
  - {{name: t_head, region: head, at: [50 mm, {}, 400 mm]}}
  - {{name: t_column, region: column, at: [100 mm, 50 mm, 150 mm]}}
  - {{name: t_ambient, node: ambient}}
displacements:
  - {{name: z, along: z, tool: {{region: head, at: [50 mm, 200 mm, 350 mm]}}, table: {{region: column, at: [50 mm, 100 mm, 0 mm]}}}}
cyclograms: {}
solver: {}
{})",
                       start, materials, list, ambient, sensor_y, cyclograms, solver, more);
  }
};

/// Writes it beside its mesh into a folder; returns the scenario's path.
inline std::string write_column_and_head(const std::filesystem::path& folder, const ColumnAndHead& machine = {},
                                         const std::string& name = "scenario") {
  if (!std::filesystem::exists(folder / "machine.inp")) {
    std::ofstream(folder / "machine.inp") << inp_text(column_and_head());
  }
  const std::filesystem::path file = folder / (name + ".yaml");
  std::ofstream(file) << machine.text();
  return file.string();
}

}  // namespace driftwright::fixtures
