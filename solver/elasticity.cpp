#include "solver/elasticity.hpp"

#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <cmath>

#include "base/errors.hpp"
#include "mesh/shape.hpp"
#include "solver/cell_elasticity.hpp"
#include "solver/rigid_motion.hpp"
#include "solver/springs.hpp"

namespace driftwright::solver {
namespace {

using mesh::Mesh;
using ColumnMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;

struct CellMatrices {
  Eigen::MatrixXd stiffness;     // 3n x 3n
  Eigen::MatrixXd thermal_load;  // 3n x n
};

CellMatrices cell_matrices(const Mesh& mesh, int cell, const Material& material) {
  const mesh::CellShape shape = mesh.cells.shape[cell];
  const auto x = mesh::cell_coords(mesh, mesh.cells.nodes(cell));
  const auto d = elasticity_tensor_Pa(material);
  const auto free_strain = thermal_strain_1_K(material);
  const auto n = x.cols();
  CellMatrices m{Eigen::MatrixXd::Zero(3 * n, 3 * n), Eigen::MatrixXd::Zero(3 * n, n)};
  for (const auto& q : mesh::stiffness_rule(shape)) {
    const CellPoint p = cell_point(shape, x, q.xi);
    const double volume = q.weight * p.det_m3;
    const Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 3 * mesh::kMaxNodesPerCell, 6> bd = p.strain.transpose() * d;
    m.stiffness.noalias() += volume * bd * p.strain;
    m.thermal_load.noalias() += volume * (bd * free_strain) * p.shape.N.head(p.shape.n);
  }
  return m;
}

void check_materials(const Mesh& mesh, const RegionMaterials& materials) {
  for (std::size_t r = 0; r < materials.size(); ++r) {
    const Material& m = materials[r];
    const std::string region = r < mesh.regions.size() ? mesh.regions[r] : "?";
    if (!(m.youngs_modulus_Pa > 0.0 && std::isfinite(m.youngs_modulus_Pa))) {
      throw InputError(
          fmt::format("region '{}': a Young's modulus of {:g} Pa; one above zero is wanted", region, m.youngs_modulus_Pa));
    }
    if (!(m.poisson_ratio > -1.0 && m.poisson_ratio < 0.5)) {
      throw InputError(fmt::format("region '{}': a Poisson ratio of {:g}; -1 to 0.5, both excluded, is allowed", region,
                                   m.poisson_ratio));
    }
    for (double a_1_K : {m.expansion_1_K.x, m.expansion_1_K.y, m.expansion_1_K.z}) {
      if (!std::isfinite(a_1_K)) throw InputError(fmt::format("region '{}': the expansion is no finite number", region));
    }
  }
}

}  // namespace

struct Elasticity::Parts {
  int n_nodes = 0;
  std::vector<int> free_of;  // dof 3 node + direction -> row of the reduced system, -1 where fixed
  int n_free = 0;
  Eigen::SparseMatrix<double> thermal_load;  // 3 n_nodes x n_nodes
  mutable Eigen::CholmodSupernodalLLT<ColumnMatrix, Eigen::Lower> factor;

  Eigen::VectorXd solve(const Eigen::VectorXd& force) const {  // full length in, full length out, zero where fixed
    Eigen::VectorXd b(n_free), u = Eigen::VectorXd::Zero(3 * n_nodes);
    for (int i = 0; i < 3 * n_nodes; ++i) {
      if (free_of[i] >= 0) b[free_of[i]] = force[i];
    }
    const Eigen::VectorXd x = factor.solve(b);
    for (int i = 0; i < 3 * n_nodes; ++i) {
      if (free_of[i] >= 0) u[i] = x[free_of[i]];
    }
    return u;
  }
};

Elasticity::~Elasticity() = default;
Elasticity::Elasticity(Elasticity&&) noexcept = default;

Elasticity::Elasticity(const Mesh& mesh, const RegionMaterials& materials, const std::vector<Support>& supports,
                       const std::vector<JointMechanics>& joints)
    : parts_(std::make_unique<Parts>()) {
  check_materials(mesh, materials);
  Parts& p = *parts_;
  p.n_nodes = mesh.n_nodes();
  std::vector<bool> fixed(3 * static_cast<std::size_t>(p.n_nodes), false);
  for (const Support& support : supports) {
    for (int facet : mesh.facets_on(mesh.surface(support.surface))) {
      for (int node : mesh.facets.nodes(facet)) {
        for (int i = 0; i < 3; ++i) {
          if (support.fixed[i]) fixed[3 * node + i] = true;
        }
      }
    }
  }
  const std::vector<SpringLayer> layers = spring_layers(mesh, materials, supports, joints);
  require_held(mesh, layers, fixed);
  p.free_of.assign(fixed.size(), -1);
  for (int node : mesh.cells.node) {  // nodes in no cell have no stiffness
    for (int i = 0; i < 3; ++i) {
      if (!fixed[3 * node + i]) p.free_of[3 * node + i] = 0;
    }
  }
  for (int& row : p.free_of) {
    if (row == 0) row = p.n_free++;
  }

  /// Rows of the unknowns of some nodes, and which of their 3 n displacements these are.
  const auto free_rows = [&](auto&& nodes) {
    std::pair<std::vector<int>, std::vector<int>> rows_and_positions;
    int position = 0;
    for (int node : nodes) {
      for (int i = 0; i < 3; ++i, ++position) {
        if (p.free_of[3 * node + i] < 0) continue;
        rows_and_positions.first.push_back(p.free_of[3 * node + i]);
        rows_and_positions.second.push_back(position);
      }
    }
    return rows_and_positions;
  };
  Cliques cliques;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) cliques.add(free_rows(mesh.cells.nodes(cell)).first);
  for (const SpringLayer& layer : layers) {
    for (const SpringPoint& point : layer) cliques.add(free_rows(point.node).first);
  }
  SparseRow k = pattern(p.n_free, cliques);

  std::vector<Eigen::Triplet<double>> thermal;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto nodes = mesh.cells.nodes(cell);
    const CellMatrices m = cell_matrices(mesh, cell, materials[mesh.cells.group[cell]]);
    for (std::size_t i = 0; i < 3 * nodes.size(); ++i) {
      const int dof = 3 * nodes[i / 3] + static_cast<int>(i % 3);
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        thermal.emplace_back(dof, nodes[j], m.thermal_load(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      }
    }
    const auto [rows, positions] = free_rows(nodes);
    scatter_add(k, rows, m.stiffness(positions, positions));
  }
  p.thermal_load.resize(3 * p.n_nodes, p.n_nodes);
  p.thermal_load.setFromTriplets(thermal.begin(), thermal.end());
  thermal = {};

  for (const SpringLayer& layer : layers) {
    for (const SpringPoint& point : layer) {
      const auto n = static_cast<Eigen::Index>(point.node.size());
      Eigen::MatrixXd jump(3, 3 * n);
      for (Eigen::Index i = 0; i < n; ++i) {
        jump.middleCols<3>(3 * i) = point.weight[static_cast<std::size_t>(i)] * Eigen::Matrix3d::Identity();
      }
      const Eigen::MatrixXd local = jump.transpose() * point.stiffness_N_m * jump;
      const auto [rows, positions] = free_rows(point.node);
      scatter_add(k, rows, local(positions, positions));
    }
  }

  // The transpose of a symmetric matrix in rows is itself in columns: no copy but the wider indices.
  const ColumnMatrix columns = ColumnMatrix(Eigen::SparseMatrix<double, Eigen::ColMajor, int>(k.transpose()));
  k = SparseRow();
  p.factor.cholmod().nmethods = 1;
  p.factor.cholmod().method[0].ordering = CHOLMOD_METIS;
  p.factor.cholmod().print = 0;
  p.factor.compute(columns);
  if (p.factor.info() != Eigen::Success) {
    if (p.factor.cholmod().status == CHOLMOD_OUT_OF_MEMORY) {
      throw SolveError(fmt::format("not enough memory to factorise {} elastic unknowns; take a coarser mesh", p.n_free));
    }
    throw SolveError(
        "the elastic stiffness has no Cholesky factor: springs or materials of too different stiffness, or cells without "
        "volume");
  }
}

Eigen::VectorXd Elasticity::influence(const DisplacementFunctional& functional) const {
  Eigen::VectorXd l = Eigen::VectorXd::Zero(3 * parts_->n_nodes);
  for (const auto& [node, weight] : functional.terms) l.segment<3>(3 * node) += weight;
  return parts_->thermal_load.transpose() * parts_->solve(l);
}

Eigen::VectorXd Elasticity::influence(const StressFunctional& functional) const {
  Eigen::VectorXd g = influence(functional.displacement);
  for (const auto& [node, weight_Pa_K] : functional.temperature) g[node] += weight_Pa_K;
  return g;
}

Eigen::Matrix3Xd Elasticity::displacement(const Eigen::VectorXd& theta) const {
  const Eigen::VectorXd u = parts_->solve(parts_->thermal_load * theta.head(parts_->n_nodes));
  return Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, parts_->n_nodes);
}

}  // namespace driftwright::solver
