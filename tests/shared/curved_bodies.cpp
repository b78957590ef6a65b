#include "tests/shared/curved_bodies.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "tests/shared/fixtures.hpp"

namespace driftwright::fixtures {
namespace {

using Eigen::Vector3d;
using mesh::Mesh;
using std::numbers::pi;
using Map = std::function<Vector3d(const Vector3d&)>;

/// A unit cube of cells, moved, as a part of its own; it shares nodes only after merge_nodes().
Mesh block(const std::array<int, 3>& n, mesh::CellShape shape, const std::string& region, const Map& map) {
  Mesh mesh;
  add_box(mesh, {.n = n, .shape = shape}, region, "");
  map_nodes(mesh, map);
  return mesh;
}

/// Takes over the cells of a part, and the facets on `faces` as those of surfaces of another name.
void append(Mesh& mesh, const Mesh& part, const std::map<std::string, std::string>& faces) {
  const int first = mesh.n_nodes(), region = static_cast<int>(mesh.regions.size());
  mesh.coords.conservativeResize(3, first + part.n_nodes());
  mesh.coords.rightCols(part.n_nodes()) = part.coords;
  mesh.regions.insert(mesh.regions.end(), part.regions.begin(), part.regions.end());
  const auto moved = [&](std::span<const int> nodes) {
    std::vector<int> now(nodes.begin(), nodes.end());
    for (int& n : now) n += first;
    return now;
  };
  for (int c = 0; c < part.cells.size(); ++c) {
    mesh.cells.add(part.cells.shape[c], moved(part.cells.nodes(c)), region + part.cells.group[c]);
  }
  for (const auto& [face, surface] : faces) {
    if (mesh.surface(surface) < 0) mesh.surfaces.push_back(surface);
    for (int f : part.facets_on(part.surface(face))) {
      mesh.facets.add(part.facets.shape[f], moved(part.facets.nodes(f)), mesh.surface(surface));
    }
  }
}

/// Point of the core's face at 1, seen from the axis: (1, v, w), and of the skin in the same directions.
Vector3d toward(double v, double w) {
  return Vector3d(1.0, std::tan(pi / 4 * v), std::tan(pi / 4 * w)).normalized();
}

}  // namespace

void add_quarter_cylinder(Mesh& mesh, double radius_m, double height_m, int n, int n_z, mesh::CellShape shape,
                          const std::string& region, const std::string& prefix) {
  const double core_m = 0.5 * radius_m;
  // At u = 0 on the core, at u = 1 on the arc; v = 0 ... 1 is 0 ... 45 degrees.
  const auto across = [=](double u, double v) {
    return std::array{(1 - u) * core_m + u * radius_m * std::cos(pi / 4 * v),
                      (1 - u) * core_m * v + u * radius_m * std::sin(pi / 4 * v)};
  };
  Mesh body;
  append(body,
         block({n, n, n_z}, shape, region + "0",
               [=](const Vector3d& x) { return Vector3d(core_m * x[0], core_m * x[1], height_m * x[2]); }),
         {});
  append(body,
         block({n, n, n_z}, shape, region + "1",
               [=](const Vector3d& x) {
                 const auto p = across(x[0], x[1]);
                 return Vector3d(p[0], p[1], height_m * x[2]);
               }),
         {{"x1", "skin"}});
  append(body,
         block({n, n, n_z}, shape, region + "2",
               [=](const Vector3d& x) {
                 const auto p = across(x[1], x[0]);
                 return Vector3d(p[1], p[0], height_m * x[2]);
               }),
         {{"y1", "skin"}});
  merge_nodes(body);
  append(mesh, body, {{"skin", prefix + "skin"}});
}

void add_quarter_ring(Mesh& mesh, double inner_m, double outer_m, double height_m, int n_r, int n_arc, int n_z,
                      mesh::CellShape shape, const std::string& region, const std::string& prefix) {
  const Mesh ring = block({n_r, n_arc, n_z}, shape, region, [=](const Vector3d& x) {
    const double r_m = inner_m + (outer_m - inner_m) * x[0], angle = pi / 2 * x[1];
    return Vector3d(r_m * std::cos(angle), r_m * std::sin(angle), height_m * x[2]);
  });
  append(mesh, ring, {{"x0", prefix + "inner"}, {"x1", prefix + "outer"}});
}

void add_eighth_of_ball(Mesh& mesh, double radius_m, int n, mesh::CellShape shape, const std::string& region,
                        const std::string& prefix) {
  const double core_m = 0.4 * radius_m;
  // At u = 0 on the core's face x = core, at u = 1 on the skin; v, w across.
  const auto across = [=](double u, double v, double w) -> Vector3d {
    return (1 - u) * core_m * Vector3d(1.0, v, w) + u * radius_m * toward(v, w);
  };
  Mesh body;
  append(body, block({n, n, n}, shape, region + "0", [=](const Vector3d& x) -> Vector3d { return core_m * x; }), {});
  append(body, block({n, n, n}, shape, region + "1", [=](const Vector3d& x) { return across(x[0], x[1], x[2]); }),
         {{"x1", "skin"}});
  append(body,
         block({n, n, n}, shape, region + "2",
               [=](const Vector3d& x) {
                 const Vector3d p = across(x[1], x[0], x[2]);
                 return Vector3d(p[1], p[0], p[2]);
               }),
         {{"y1", "skin"}});
  append(body,
         block({n, n, n}, shape, region + "3",
               [=](const Vector3d& x) {
                 const Vector3d p = across(x[2], x[0], x[1]);
                 return Vector3d(p[1], p[2], p[0]);
               }),
         {{"z1", "skin"}});
  merge_nodes(body);
  append(mesh, body, {{"skin", prefix + "skin"}});
}

}  // namespace driftwright::fixtures
