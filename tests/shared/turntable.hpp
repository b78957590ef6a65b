#pragma once
// A square table that turns on a square base, and a head above it that holds the tool: boxes of bricks, as a user writes
// them.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <fstream>
#include <string>

#include "mesh/mesh.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::fixtures {

/// The base (0.1 m high) stands on sliding faces about its corner, so that it grows from there. The table (0.05 m) is on its
/// middle, which is the origin at z = 0. The head is a cube of 40 mm above the axis, held at its top, where the tool is.
struct Turntable {
  double base_m = 0.4;     ///< edge of the base; the table's is 0.2 m
  double drawn_deg = 0.0;  ///< turn of the table in the mesh, about z
  int n_table = 4;         ///< bricks along the table's edge
  std::string axes = "axes: {c: {turns: [table], about: z, through: [0 mm, 0 mm, 0 mm], range: [-180 deg, 180 deg]}}\n";
  std::string expansion = "12e-6 1/K";
  std::string joint = "";  ///< further keys
  std::string start = "reference";
  std::string rows = "[[60 min, 1000 rpm]]";
  std::string more = "";

  static constexpr double kExpansion_1_K = 12e-6, kTableTop_m = 0.15;

  [[nodiscard]] mesh::Mesh mesh() const {
    mesh::Mesh m;
    add_box(m, {{-0.1, -0.1, 0.1}, {0.2, 0.2, 0.05}, {n_table, n_table, 1}, mesh::CellShape::kHex20}, "table", "t.");
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(drawn_deg * EIGEN_PI / 180.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    map_nodes(m, [&](const Eigen::Vector3d& x) { return Eigen::Vector3d(turn * x); });
    add_box(m, {{-base_m / 2, -base_m / 2, 0.0}, {base_m, base_m, 0.1}, {4, 4, 1}, mesh::CellShape::kHex20}, "base", "b.");
    add_box(m, {{-0.02, -0.02, 0.26}, {0.04, 0.04, 0.04}, {2, 2, 1}, mesh::CellShape::kHex20}, "head", "h.");
    return m;
  }

  /// A point of the table as drawn, in the text of a scenario.
  [[nodiscard]] std::string on_table(double x_mm, double y_mm, double z_mm) const {
    const Eigen::Vector3d at_mm =
        Eigen::AngleAxisd(drawn_deg * EIGEN_PI / 180.0, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(x_mm, y_mm, z_mm);
    return fmt::format("[{:.12g} mm, {:.12g} mm, {:.12g} mm]", at_mm[0], at_mm[1], at_mm[2]);
  }

  /// Writes it into a new folder; returns the scenario's path.
  [[nodiscard]] std::string write() const {
    static int n_written = 0;  // a scenario reads its mesh later than its text
    const std::filesystem::path folder = fresh_folder(fmt::format("turntable_{}", n_written++));
    std::ofstream(folder / "machine.inp") << inp_text(mesh());
    const double low_mm = -500.0 * base_m;
    const auto plane = [](const char* name, const char* region, double x_mm, double y_mm, double z_mm, const char* normal) {
      return fmt::format("    - {{name: {}, region: {}, plane: {{through: [{} mm, {} mm, {} mm], normal: {}}}}}\n", name,
                         region, x_mm, y_mm, z_mm, normal);
    };
    const std::string material =
        "{density: 7800 kg/m^3, conductivity: 40 W/(m K), heat_capacity: 460 J/(kg K), youngs_modulus: 200 GPa, "
        "poisson_ratio: 0.3, expansion: " +
        expansion + ", source: test}\n";
    std::ofstream(folder / "turntable.yaml")
        << "name: turntable\nreference_temperature: 20 degC\nstart: " << start
        << "\nmachine:\n  mesh: machine.inp\n  units: mm\n  surfaces:\n"
        << plane("base_x", "base", low_mm, 0, 0, "[-1, 0, 0]") << plane("base_y", "base", 0, low_mm, 0, "[0, -1, 0]")
        << plane("base_z", "base", 0, 0, 0, "[0, 0, -1]") << plane("base_top", "base", 0, 0, 100, "[0, 0, 1]")
        << plane("table_under", "table", 0, 0, 100, "[0, 0, -1]") << plane("head_top", "head", 0, 0, 300, "[0, 0, 1]")
        << "  joints: [{name: base/table, a: base_top, b: table_under}]\nmaterials:\n  base: " << material
        << "  table: " << material << "  head: " << material << axes
        << "supports:\n  - {surface: base_x, sliding: true}\n  - {surface: base_y, sliding: true}\n"
           "  - {surface: base_z, sliding: true}\n  - {surface: head_top, fixed: [x, y, z]}\n"
        << joint
        << "effects:\n  - {type: contact, joint: base/table, conductance: 200 W/(m^2 K)}\n"
           "  - {type: heat_source, region: table, power: 40 W, at_speed: 1000 rpm, exponent: 1}\n"
           "  - {type: convection, surface: base_z, film: 20 W/(m^2 K)}\n"
           "  - {type: convection, surface: head_top, film: 5 W/(m^2 K)}\nambient: [[0 h, "
        << (start == "reference" ? "20 degC" : start)
        << "]]\nsensors:\n  - {name: t_table, region: table, at: " << on_table(70, 60, 150)
        << "}\ndisplacements:\n  - {name: x, along: x, tool: {region: head, at: [0 mm, 0 mm, 300 mm]}, "
        << "table: {region: table, at: " << on_table(70, 60, 150) << "}}\ncyclograms: {work: " << rows
        << "}\nsolver: {model: full, relative_tolerance: 1e-7, absolute_tolerance: 1e-6 K, output_interval: 10 min, "
           "fields_format: none}\n"
        << more;
    return (folder / "turntable.yaml").string();
  }
};

}  // namespace driftwright::fixtures
