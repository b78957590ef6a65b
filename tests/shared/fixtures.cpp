#include "tests/shared/fixtures.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <span>

#include "mesh/shape.hpp"
#include "mesh/topology.hpp"

namespace driftwright::fixtures {
namespace {

using mesh::CellShape, mesh::Mesh;
using Index3 = std::array<int, 3>;  // on the doubled grid, so that mid-side nodes have indices too

int sign_of(const Index3& p) {
  int sign = 1;
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 3; ++j) {
      if (p[i] > p[j]) sign = -sign;
    }
  }
  return sign;
}

Index3 middle(const Index3& a, const Index3& b) {
  return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

int surface_index(Mesh& mesh, const std::string& name) {
  if (mesh.surface(name) < 0) mesh.surfaces.push_back(name);
  return mesh.surface(name);
}

/// The finest rule there is. Not one of three points in a line on quadratic cells: the error of those is zero there.
std::span<const mesh::QuadraturePoint> fine_rule(CellShape shape) {
  switch (mesh::n_corners_of(shape)) {
    case 8:
      return mesh::quadrature(shape, 7);
    case 6:
      return mesh::mass_rule(CellShape::kWedge15);
    default:
      return mesh::quadrature(shape, mesh::edges_of(shape).size() == 4 ? 7 : 5);
  }
}

/// Runs over the quadrature points of all cells.
template <class Visit>
void each_point(const Mesh& mesh, const mesh::Cells& cells, Visit visit) {
  for (int c = 0; c < cells.size(); ++c) {
    const auto x = mesh::cell_coords(mesh, cells.nodes(c));
    for (const auto& q : fine_rule(cells.shape[c])) {
      const mesh::ShapeValues s = mesh::shape_values(cells.shape[c], q.xi);
      const Eigen::Vector3d position = x * s.N.head(s.n).transpose();
      visit(c, s, position, q.weight * mesh::jacobian(s, x, cells.shape[c]).det);
    }
  }
}

}  // namespace

void add_box(Mesh& mesh, const Box& box, const std::string& region, const std::string& prefix) {
  const Index3 last = {2 * box.n[0], 2 * box.n[1], 2 * box.n[2]};
  std::vector<int> id((last[0] + 1) * (last[1] + 1) * (last[2] + 1), -1);
  std::vector<Eigen::Vector3d> added;
  const int first = mesh.n_nodes();
  const auto node = [&](const Index3& g) {
    int& i = id[(g[0] * (last[1] + 1) + g[1]) * (last[2] + 1) + g[2]];
    if (i < 0) {
      i = first + static_cast<int>(added.size());
      Eigen::Vector3d x;
      for (int d = 0; d < 3; ++d) x[d] = box.low[d] + box.size_m[d] * g[d] / last[d];
      added.push_back(x);
    }
    return i;
  };
  const int region_index = static_cast<int>(mesh.regions.size());
  mesh.regions.push_back(region);
  for (const char* face : {"x0", "x1", "y0", "y1", "z0", "z1"}) surface_index(mesh, prefix + face);

  const auto add_cell = [&](const std::vector<Index3>& corner) {
    std::vector<Index3> at = corner;
    if (mesh::is_quadratic(box.shape)) {
      for (const auto& [p, q] : mesh::edges_of(box.shape)) at.push_back(middle(corner[p], corner[q]));
    }
    std::vector<int> nodes;
    for (const Index3& g : at) nodes.push_back(node(g));
    mesh.cells.add(box.shape, nodes, region_index);
    for (const mesh::Face& face : mesh::faces_of(box.shape)) {
      for (int d = 0; d < 3; ++d) {
        const int level = at[face.node[0]][d];
        bool on_face = level == 0 || level == last[d];
        std::vector<int> facet;
        for (int i = 0; i < mesh::n_nodes_of(face.shape); ++i) {
          on_face = on_face && at[face.node[i]][d] == level;
          facet.push_back(nodes[face.node[i]]);
        }
        if (!on_face) continue;
        mesh.facets.add(face.shape, facet, surface_index(mesh, prefix + "xyz"[d] + (level == 0 ? "0" : "1")));
      }
    }
  };
  const auto add_brick = [&](const Index3& low) {
    const auto at = [&](int i, int j, int k) -> Index3 { return {low[0] + 2 * i, low[1] + 2 * j, low[2] + 2 * k}; };
    switch (mesh::n_corners_of(box.shape)) {
      case 8:
        add_cell({at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
        return;
      case 6:
        add_cell({at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 0, 1), at(1, 0, 1), at(1, 1, 1)});
        add_cell({at(0, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 1, 1), at(0, 1, 1)});
        return;
    }
    Index3 axes = {0, 1, 2};
    do {  // each path along the edges from corner 000 to corner 111 is a tetrahedron
      std::vector<Index3> corner(4, low);
      for (int step = 0; step < 3; ++step) {
        corner[step + 1] = corner[step];
        corner[step + 1][axes[step]] += 2;
      }
      if (sign_of(axes) < 0) std::swap(corner[1], corner[2]);
      add_cell(corner);
    } while (std::next_permutation(axes.begin(), axes.end()));
  };
  for (int i = 0; i < box.n[0]; ++i) {
    for (int j = 0; j < box.n[1]; ++j) {
      for (int k = 0; k < box.n[2]; ++k) add_brick({2 * i, 2 * j, 2 * k});
    }
  }
  mesh.coords.conservativeResize(3, first + static_cast<Eigen::Index>(added.size()));
  for (std::size_t i = 0; i < added.size(); ++i) {
    mesh.coords.col(first + static_cast<Eigen::Index>(i)) = added[i];
  }
}

Mesh box_mesh(const Box& box) {
  Mesh mesh;
  add_box(mesh, box, "body", "");
  return mesh;
}

Mesh two_boxes(const Box& a, const Box& b, const std::string& side_a, const std::string& side_b) {
  Mesh mesh;
  add_box(mesh, a, "a", "a.");
  add_box(mesh, b, "b", "b.");
  mesh.joints.push_back({"a/b", side_a, side_b});
  return mesh;
}

void map_nodes(Mesh& mesh, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
  for (auto x : mesh.coords.colwise()) x = map(x);
}

void straighten_edges(Mesh& mesh) {
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const CellShape shape = mesh.cells.shape[c];
    if (!mesh::is_quadratic(shape)) continue;
    const auto nodes = mesh.cells.nodes(c);
    int middle_node = mesh::n_corners_of(shape);
    for (const auto& [a, b] : mesh::edges_of(shape)) {
      mesh.coords.col(nodes[middle_node++]) = 0.5 * (mesh.coords.col(nodes[a]) + mesh.coords.col(nodes[b]));
    }
  }
}

void merge_nodes(Mesh& mesh) {
  std::map<std::array<long, 3>, int> number_at;
  std::vector<int> number(mesh.n_nodes());
  Eigen::Matrix3Xd coords(3, mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    std::array<long, 3> key{};
    for (int d = 0; d < 3; ++d) key[d] = std::lround(mesh.coords(d, i) * 1e9);
    number[i] = number_at.try_emplace(key, static_cast<int>(number_at.size())).first->second;
    coords.col(number[i]) = mesh.coords.col(i);
  }
  mesh.coords = coords.leftCols(static_cast<Eigen::Index>(number_at.size()));
  for (int& n : mesh.cells.node) n = number[n];
  for (int& n : mesh.facets.node) n = number[n];
}

void add_point_surface(Mesh& mesh, const std::string& name, int node) {
  mesh.facets.add(CellShape::kTri3, std::vector<int>{node, node, node}, surface_index(mesh, name));
}

int node_at(const Mesh& mesh, const Eigen::Vector3d& point_m) {
  Eigen::Index nearest = 0;
  (mesh.coords.colwise() - point_m).colwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

Eigen::VectorXd at_nodes(const Mesh& mesh, const Field& field) {
  Eigen::VectorXd values(mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i) values[i] = field(mesh.coords.col(i));
  return values;
}

Eigen::VectorXd volume_load(const Mesh& mesh, const Field& field) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(mesh.n_nodes());
  each_point(mesh, mesh.cells, [&](int c, const mesh::ShapeValues& s, const Eigen::Vector3d& x, double dV) {
    for (int i = 0; i < s.n; ++i) load[mesh.cells.nodes(c)[i]] += dV * field(x) * s.N[i];
  });
  return load;
}

Eigen::VectorXd surface_load(const Mesh& mesh, const std::string& surface) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(mesh.n_nodes());
  const int group = mesh.surface(surface);
  each_point(mesh, mesh.facets, [&](int f, const mesh::ShapeValues& s, const Eigen::Vector3d&, double dA) {
    if (mesh.facets.group[f] != group) return;
    for (int i = 0; i < s.n; ++i) load[mesh.facets.nodes(f)[i]] += dA * s.N[i];
  });
  return load;
}

double l2_error(const Mesh& mesh, const Eigen::VectorXd& nodal, const Field& exact) {
  double sum = 0.0;
  each_point(mesh, mesh.cells, [&](int c, const mesh::ShapeValues& s, const Eigen::Vector3d& x, double dV) {
    double value = 0.0;
    for (int i = 0; i < s.n; ++i) value += s.N[i] * nodal[mesh.cells.nodes(c)[i]];
    sum += dV * std::pow(value - exact(x), 2);
  });
  return std::sqrt(sum);
}

double observed_order(const std::vector<double>& h, const std::vector<double>& error) {
  const std::size_t n = h.size();
  return std::log(error[n - 2] / error[n - 1]) / std::log(h[n - 2] / h[n - 1]);
}

solver::SparseRow stiffness(const solver::FullSystem& system, const effects::Inputs& at) {
  solver::SparseRow k = system.conduction;
  for (const auto& e : system.exchanges) k += e.coefficient(at) * e.matrix;
  return k;
}

Eigen::VectorXd steady(const solver::FullSystem& system, const effects::Inputs& at) {
  const Eigen::SparseMatrix<double> k = stiffness(system, at);
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(k).solve(system.load(at));
}

solver::Material steel() {
  return {8000.0, 40.0, 500.0, 200e9, 0.3, 12e-6, "test"};
}

solver::Material lump(double conductivity_W_mK) {
  solver::Material m = steel();
  m.conductivity_W_mK = conductivity_W_mK;
  return m;
}

effects::Law constant(double value) {
  return [value](const effects::Inputs&) { return value; };
}

void observe_unknowns(solver::FullSystem& system, const std::vector<int>& unknowns) {
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  system.outputs = {};
  system.outputs.state = Eigen::MatrixXd::Zero(system.size(), n);
  system.outputs.ambient = Eigen::VectorXd::Zero(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    system.outputs.name.push_back("unknown " + std::to_string(unknowns[j]));
    system.outputs.unit.emplace_back("K");
    system.outputs.state(unknowns[j], j) = 1.0;
  }
}

Eigen::Vector2d TwoBodies::at(double t_s, const Eigen::Vector2d& start_K) const {
  Eigen::Matrix2d a;
  a << -(link_W_K + loss1_W_K) / capacity1_J_K, link_W_K / capacity1_J_K,  //
      link_W_K / capacity2_J_K, -(link_W_K + loss2_W_K) / capacity2_J_K;
  const double half_trace = 0.5 * a.trace();
  const double det = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
  const double root = std::sqrt(half_trace * half_trace - det);
  const double l1 = half_trace + root, l2 = half_trace - root;
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d grown = (std::exp(l1 * t_s) * (a - l2 * one) - std::exp(l2 * t_s) * (a - l1 * one)) / (l1 - l2);
  // Steady state: a T = -(P/C1, 0), by Cramer's rule.
  const double p = power1_W / capacity1_J_K;
  const Eigen::Vector2d end(-p * a(1, 1) / det, p * a(1, 0) / det);
  return end + grown * (start_K - end);
}

double slab_root(double biot, int i) {
  double low = i * std::numbers::pi, high = low + 0.5 * std::numbers::pi;
  for (int k = 0; k < 200; ++k) {
    const double z = 0.5 * (low + high);
    (z * std::tan(z) < biot ? low : high) = z;  // z tan z rises from 0 to infinity in between
  }
  return 0.5 * (low + high);
}

}  // namespace driftwright::fixtures
