#include "mesh/quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/shape.hpp"

namespace driftwright::mesh {
namespace {

std::vector<Eigen::Vector3d> reference_nodes(CellShape shape) {
  std::vector<Eigen::Vector3d> xi = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (shape == CellShape::kTet10) {
    for (const auto& [a, b] : kTetrahedronEdges) {
      xi.emplace_back(0.5 * (xi[a] + xi[b]));
    }
  }
  return xi;
}

double min_det_m3(const Mesh& mesh, int cell) {
  const CellShape shape = mesh.cells.shape[cell];
  const auto x = cell_coords(mesh, mesh.cells.nodes(cell));
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& xi : reference_nodes(shape)) {
    least = std::min(least, jacobian(shape_values(shape, xi), x, shape).det);
  }
  return least;
}

double sum_over(const Mesh& mesh, const Cells& cells, int group) {
  double sum = 0.0;
  for (int c = 0; c < cells.size(); ++c) {
    if (cells.group[c] != group) continue;
    const auto x = cell_coords(mesh, cells.nodes(c));
    for (const QuadraturePoint& q : quadrature(cells.shape[c], 5)) {
      sum += q.weight * jacobian(shape_values(cells.shape[c], q.xi), x, cells.shape[c]).det;
    }
  }
  return sum;
}

}  // namespace

std::vector<double> scaled_jacobians(const Mesh& mesh) {
  std::vector<double> scaled(mesh.cells.size());
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells.nodes(c);
    double largest = 0.0;  // product of the three edge lengths at a corner
    for (int i = 0; i < 4; ++i) {
      double product = 1.0;
      for (int j = 0; j < 4; ++j) {
        if (j != i) product *= (mesh.coords.col(nodes[i]) - mesh.coords.col(nodes[j])).norm();
      }
      largest = std::max(largest, product);
    }
    scaled[c] = std::sqrt(2.0) * min_det_m3(mesh, c) / largest;
  }
  return scaled;
}

Quality worst_quality(const Mesh& mesh) {
  const std::vector<double> scaled = scaled_jacobians(mesh);
  Quality quality{
      .min_det_m3 = std::numeric_limits<double>::infinity(), .min_scaled = 1.0, .mean_scaled = 0.0, .worst_cell = -1};
  for (int c = 0; c < mesh.cells.size(); ++c) {
    quality.min_det_m3 = std::min(quality.min_det_m3, min_det_m3(mesh, c));
    quality.mean_scaled += scaled[c] / mesh.cells.size();
    if (quality.worst_cell < 0 || scaled[c] < quality.min_scaled) {
      quality.min_scaled = scaled[c];
      quality.worst_cell = c;
    }
  }
  return quality;
}

double volume_m3(const Mesh& mesh, int region) {
  return sum_over(mesh, mesh.cells, region);
}
double area_m2(const Mesh& mesh, int surface) {
  return sum_over(mesh, mesh.facets, surface);
}

}  // namespace driftwright::mesh
