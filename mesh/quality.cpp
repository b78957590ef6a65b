#include "mesh/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/shape.hpp"
#include "mesh/topology.hpp"

namespace driftwright::mesh {
namespace {

/// Largest product of the three edge lengths at a corner of a tetrahedron.
double largest_corner_product(const Eigen::Ref<const Eigen::Matrix3Xd>& x) {
  double largest = 0.0;
  for (int i = 0; i < 4; ++i) {
    double product = 1.0;
    for (int j = 0; j < 4; ++j) {
      if (j != i) product *= (x.col(i) - x.col(j)).norm();
    }
    largest = std::max(largest, product);
  }
  return largest;
}

/// det / product of the edge lengths at a point of a hexahedron or wedge; 1 in the ideal cell. Of the three edges of a
/// wedge's triangle the two longest are used.
double scaled_at(const Jacobian& j, CellShape shape) {
  const double along_m = j.dx_dxi.col(2).norm();
  const double a_m = j.dx_dxi.col(0).norm(), b_m = j.dx_dxi.col(1).norm();
  if (n_corners_of(shape) == 8) {
    const double product = a_m * b_m * along_m;
    return product > 0.0 ? j.det / product : 0.0;
  }
  const double c_m = (j.dx_dxi.col(1) - j.dx_dxi.col(0)).norm();
  const double product = a_m * b_m * c_m / std::min({a_m, b_m, c_m}) * along_m;
  return product > 0.0 ? 2.0 / std::sqrt(3.0) * j.det / product : 0.0;
}

struct CellQuality {
  double min_det_m3 = std::numeric_limits<double>::infinity();
  double scaled = std::numeric_limits<double>::infinity();
};

CellQuality cell_quality(const Mesh& mesh, int cell) {
  const CellShape shape = mesh.cells.shape[cell];
  const auto x = cell_coords(mesh, mesh.cells.nodes(cell));
  CellQuality quality;
  const auto look_at = [&](const Eigen::Vector3d& xi) {
    const Jacobian j = jacobian(shape_values(shape, xi), x, shape);
    // Written so that NaN is accepted as the minimum, too.
    if (!(j.det >= quality.min_det_m3)) quality.min_det_m3 = j.det;
    if (n_corners_of(shape) == 4) return;
    if (const double scaled = scaled_at(j, shape); !(scaled >= quality.scaled)) quality.scaled = scaled;
  };
  for (const Eigen::Vector3d& xi : reference_nodes(shape)) look_at(xi);
  if (n_corners_of(shape) == 4) {
    quality.scaled = std::sqrt(2.0) * quality.min_det_m3 / largest_corner_product(x.leftCols(4));
  } else {
    for (const QuadraturePoint& q : mass_rule(shape)) look_at(q.xi);
  }
  return quality;
}

/// Volume of a cell, area of a facet.
double measure_of(const Mesh& mesh, CellShape shape, std::span<const int> nodes) {
  const auto x = cell_coords(mesh, nodes);
  double sum = 0.0;
  for (const QuadraturePoint& q : mass_rule(shape)) sum += q.weight * jacobian(shape_values(shape, q.xi), x, shape).det;
  return sum;
}

double sum_over(const Mesh& mesh, const Cells& cells, int group) {
  double sum = 0.0;
  for (int c = 0; c < cells.size(); ++c) {
    if (cells.group[c] == group) sum += measure_of(mesh, cells.shape[c], cells.nodes(c));
  }
  return sum;
}

}  // namespace

std::vector<double> scaled_jacobians(const Mesh& mesh) {
  std::vector<double> scaled(mesh.cells.size());
  for (int c = 0; c < mesh.cells.size(); ++c) scaled[c] = cell_quality(mesh, c).scaled;
  return scaled;
}

Quality worst_quality(const Mesh& mesh) {
  Quality worst{
      .min_det_m3 = std::numeric_limits<double>::infinity(), .min_scaled = 1.0, .mean_scaled = 0.0, .worst_cell = -1};
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const CellQuality quality = cell_quality(mesh, c);
    if (!(quality.min_det_m3 >= worst.min_det_m3)) worst.min_det_m3 = quality.min_det_m3;
    worst.mean_scaled += quality.scaled / mesh.cells.size();
    if (worst.worst_cell < 0 || !(quality.scaled >= worst.min_scaled)) {
      worst.min_scaled = quality.scaled;
      worst.worst_cell = c;
    }
  }
  return worst;
}

double volume_m3(const Mesh& mesh, int region) {
  return sum_over(mesh, mesh.cells, region);
}
double area_m2(const Mesh& mesh, int surface) {
  return sum_over(mesh, mesh.facets, surface);
}
double facet_area_m2(const Mesh& mesh, CellShape shape, std::span<const int> nodes) {
  return measure_of(mesh, shape, nodes);
}

}  // namespace driftwright::mesh
