#include "solver/heat_assembly.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <stdexcept>

#include "mesh/shape.hpp"
#include "solver/joint.hpp"

namespace driftwright::solver {
namespace {

using mesh::CellShape;
using mesh::Mesh;
using Local = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, mesh::kMaxNodesPerCell, mesh::kMaxNodesPerCell>;

Local cell_mass(const Mesh& mesh, int cell, double capacity_J_m3K) {
  const CellShape shape = mesh.cells.shape[cell];
  const auto x = mesh::cell_coords(mesh, mesh.cells.nodes(cell));
  Local m = Local::Zero(x.cols(), x.cols());
  for (const auto& q : mesh::mass_rule(shape)) {
    const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
    m += capacity_J_m3K * q.weight * mesh::jacobian(s, x, shape).det * s.N.head(s.n).transpose() * s.N.head(s.n);
  }
  return m;
}

Local cell_conduction(const Mesh& mesh, int cell, double conductivity_W_mK) {
  const CellShape shape = mesh.cells.shape[cell];
  const auto x = mesh::cell_coords(mesh, mesh.cells.nodes(cell));
  Local k = Local::Zero(x.cols(), x.cols());
  for (const auto& q : mesh::stiffness_rule(shape)) {
    const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
    const mesh::Jacobian j = mesh::jacobian(s, x, shape);
    const Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, mesh::kMaxNodesPerCell> gradient =
        j.dx_dxi.inverse().transpose() * s.dN.leftCols(s.n);
    k += conductivity_W_mK * q.weight * j.det * gradient.transpose() * gradient;
  }
  return k;
}

/// A film's matrix: ∫ N N' dA on the surface, and where the surrounding is an unknown, its coupling.
SparseRow film_matrix(const Mesh& mesh, int surface, int n_unknowns, int surrounding_unknown) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int facet : mesh.facets_on(surface)) {
    const CellShape shape = mesh.facets.shape[facet];
    const auto nodes = mesh.facets.nodes(facet);
    const auto x = mesh::cell_coords(mesh, nodes);
    for (const auto& q : mesh::mass_rule(shape)) {
      const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
      const double area_m2 = q.weight * mesh::jacobian(s, x, shape).det;
      for (int i = 0; i < s.n; ++i) {
        for (int j = 0; j < s.n; ++j) entries.emplace_back(nodes[i], nodes[j], area_m2 * s.N[i] * s.N[j]);
        if (surrounding_unknown >= 0) {
          entries.emplace_back(nodes[i], surrounding_unknown, -area_m2 * s.N[i]);
          entries.emplace_back(surrounding_unknown, nodes[i], -area_m2 * s.N[i]);
        }
      }
      if (surrounding_unknown >= 0) entries.emplace_back(surrounding_unknown, surrounding_unknown, area_m2);
    }
  }
  SparseRow g(n_unknowns, n_unknowns);
  g.setFromTriplets(entries.begin(), entries.end());
  return g;
}

SparseRow joint_matrix(const Mesh& mesh, const mesh::Joint& joint, int n_unknowns) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const JointPoint& p : joint_points(mesh, joint)) {
    std::vector<int> node = p.node_a;
    node.insert(node.end(), p.node_b.begin(), p.node_b.end());
    std::vector<double> jump = p.weight_a;
    for (double w : p.weight_b) jump.push_back(-w);
    for (std::size_t i = 0; i < node.size(); ++i) {
      for (std::size_t j = 0; j < node.size(); ++j) entries.emplace_back(node[i], node[j], p.area_m2 * jump[i] * jump[j]);
    }
  }
  SparseRow g(n_unknowns, n_unknowns);
  g.setFromTriplets(entries.begin(), entries.end());
  return g;
}

Exchange<SparseRow> exchange(const std::string& name, SparseRow matrix, effects::Law coefficient, bool with_hall) {
  Exchange<SparseRow> e{name, std::move(matrix), {}, 0.0, std::move(coefficient)};
  e.to_hall = Eigen::VectorXd::Zero(e.matrix.rows());
  if (with_hall) {
    e.to_hall = e.matrix * Eigen::VectorXd::Ones(e.matrix.cols());
    e.hall_sum = e.to_hall.sum();
  }
  return e;
}

Eigen::VectorXd unit_heat(const Mesh& mesh, int region, int n_unknowns) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(n_unknowns);
  for (int cell : mesh.cells_in(region)) {
    const CellShape shape = mesh.cells.shape[cell];
    const auto nodes = mesh.cells.nodes(cell);
    const auto x = mesh::cell_coords(mesh, nodes);
    for (const auto& q : mesh::mass_rule(shape)) {
      const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
      const double volume = q.weight * mesh::jacobian(s, x, shape).det;
      for (int i = 0; i < s.n; ++i) load[nodes[i]] += volume * s.N[i];
    }
  }
  return load / load.sum();
}

int must_exist(int index, const std::string& name) {
  if (index < 0) throw std::logic_error("assemble_heat: the mesh has no '" + name + "'");
  return index;
}

int node_unknown(const effects::HeatBalance& balance, const Mesh& mesh, const std::string& name) {
  for (std::size_t i = 0; i < balance.nodes.size(); ++i) {
    if (balance.nodes[i].name == name) return mesh.n_nodes() + static_cast<int>(i);
  }
  return must_exist(-1, name);
}

std::vector<Exchange<SparseRow>> make_exchanges(const Mesh& mesh, const effects::HeatBalance& balance, int n) {
  std::vector<Exchange<SparseRow>> exchanges;
  for (const effects::Film& film : balance.films) {
    const bool to_hall = film.surrounding == "hall";
    const int surrounding = to_hall ? -1 : node_unknown(balance, mesh, film.surrounding);
    const int surface = must_exist(mesh.surface(film.surface), film.surface);
    exchanges.push_back(exchange(film.name, film_matrix(mesh, surface, n, surrounding), film.htc_W_m2K, to_hall));
  }
  for (const effects::Contact& contact : balance.contacts) {
    const mesh::Joint* joint = mesh.joint(contact.joint);
    must_exist(joint ? 0 : -1, contact.joint);
    const double conductance = contact.conductance_W_m2K;
    exchanges.push_back(exchange(
        contact.name, joint_matrix(mesh, *joint, n), [=](const effects::Inputs&) { return conductance; }, false));
  }
  for (const effects::LumpedNode& node : balance.nodes) {
    SparseRow g(n, n);
    const int unknown = node_unknown(balance, mesh, node.name);
    g.insert(unknown, unknown) = 1.0;
    const double conductance = node.hall_conductance_W_K;
    exchanges.push_back(exchange(
        "air_node " + node.name, std::move(g), [=](const effects::Inputs&) { return conductance; }, true));
  }
  return exchanges;
}

}  // namespace

FullSystem assemble_heat(const Mesh& mesh, const RegionMaterials& materials, const effects::HeatBalance& balance) {
  const int n = mesh.n_nodes() + static_cast<int>(balance.nodes.size());
  FullSystem system;
  system.exchanges = make_exchanges(mesh, balance, n);
  for (const effects::HeatInput& heat : balance.heats) {
    system.sources.push_back(
        {heat.name, unit_heat(mesh, must_exist(mesh.region(heat.region), heat.region), n), heat.power_W});
  }

  Cliques cliques;  // the common pattern: cells, and the entries of every exchange
  for (int cell = 0; cell < mesh.cells.size(); ++cell) cliques.add(mesh.cells.nodes(cell));
  for (const auto& e : system.exchanges) {
    for (int row = 0; row < n; ++row) {
      for (SparseRow::InnerIterator entry(e.matrix, row); entry; ++entry) {
        if (entry.col() > row) cliques.add(std::vector<int>{row, static_cast<int>(entry.col())});
      }
    }
  }
  system.mass = pattern(n, cliques);
  system.conduction = system.mass;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const Material& m = materials[mesh.cells.group[cell]];
    scatter_add(system.mass, mesh.cells.nodes(cell), cell_mass(mesh, cell, m.density_kg_m3 * m.heat_capacity_J_kgK));
    scatter_add(system.conduction, mesh.cells.nodes(cell), cell_conduction(mesh, cell, m.conductivity_W_mK));
  }
  for (std::size_t i = 0; i < balance.nodes.size(); ++i) {
    system.mass.coeffRef(mesh.n_nodes() + static_cast<int>(i), mesh.n_nodes() + static_cast<int>(i)) =
        balance.nodes[i].capacity_J_K;
  }
  system.ones = Eigen::VectorXd::Ones(n);
  return system;
}

}  // namespace driftwright::solver
