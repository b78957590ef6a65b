#include "solver/elasticity.hpp"

#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "base/errors.hpp"
#include "mesh/shape.hpp"
#include "solver/joint.hpp"

namespace driftwright::solver {
namespace {

using mesh::CellShape;
using mesh::Mesh;
using ColumnMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;
using Strain = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 3 * mesh::kMaxNodesPerCell>;

Eigen::Matrix<double, 6, 6> stiffness_tensor(const Material& m) {
  const double lame = m.youngs_modulus_Pa * m.poisson_ratio / ((1 + m.poisson_ratio) * (1 - 2 * m.poisson_ratio));
  const double shear = m.youngs_modulus_Pa / (2 * (1 + m.poisson_ratio));
  Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
  d.topLeftCorner<3, 3>().setConstant(lame);
  d.diagonal() << lame + 2 * shear, lame + 2 * shear, lame + 2 * shear, shear, shear, shear;
  return d;
}

/// B of the shear order xy, yz, zx with engineering strains.
Strain strain_matrix(const Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, mesh::kMaxNodesPerCell>& gradient) {
  const int n = static_cast<int>(gradient.cols());
  Strain b = Strain::Zero(6, 3 * n);
  for (int i = 0; i < n; ++i) {
    const double dx = gradient(0, i), dy = gradient(1, i), dz = gradient(2, i);
    b.block<6, 3>(0, 3 * i) << dx, 0, 0, 0, dy, 0, 0, 0, dz, dy, dx, 0, 0, dz, dy, dz, 0, dx;
  }
  return b;
}

struct CellMatrices {
  Eigen::MatrixXd stiffness;     // 3n x 3n
  Eigen::MatrixXd thermal_load;  // 3n x n
};

CellMatrices cell_matrices(const Mesh& mesh, int cell, const Material& material) {
  const CellShape shape = mesh.cells.shape[cell];
  const auto x = mesh::cell_coords(mesh, mesh.cells.nodes(cell));
  const auto d = stiffness_tensor(material);
  const auto n = x.cols();
  CellMatrices m{Eigen::MatrixXd::Zero(3 * n, 3 * n), Eigen::MatrixXd::Zero(3 * n, n)};
  for (const auto& q : mesh::stiffness_rule(shape)) {
    const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
    const mesh::Jacobian j = mesh::jacobian(s, x, shape);
    const Strain b = strain_matrix(j.dx_dxi.inverse().transpose() * s.dN.leftCols(s.n));
    const double volume = q.weight * j.det;
    const Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 3 * mesh::kMaxNodesPerCell, 6> bd = b.transpose() * d;
    m.stiffness += volume * bd * b;
    const Eigen::VectorXd push = bd.leftCols<3>().rowwise().sum();  // B'D (1,1,1,0,0,0)'
    m.thermal_load += volume * material.expansion_1_K * push * s.N.head(s.n);
  }
  return m;
}

/// Springs that tie a joint [N/m^3]: a thousand times E/l, so that the slip under any stress σ is σ l / (1000 E).
double tie_stiffness_N_m3(const Mesh& mesh, const mesh::Joint& joint, const RegionMaterials& materials) {
  const auto slash = joint.name.find('/');
  const double e_Pa = std::max(materials[mesh.region(joint.name.substr(0, slash))].youngs_modulus_Pa,
                               materials[mesh.region(joint.name.substr(slash + 1))].youngs_modulus_Pa);
  const std::vector<int> facets = mesh.facets_on(mesh.surface(joint.side_a));
  const auto nodes = mesh.facets.nodes(facets.front());
  const double length_m = (mesh.coords.col(nodes[0]) - mesh.coords.col(nodes[1])).norm();
  return 1000.0 * e_Pa / length_m;
}

/// Looks whether the fixed directions stop all six rigid motions of each set of parts that joints hold together. A
/// factorisation alone does not tell: rounding makes the pivot of a free motion positive as often as not.
/// @param fixed  true for dof 3 node + direction that is held
void require_held(const Mesh& mesh, const std::vector<std::pair<double, std::vector<JointPoint>>>& ties,
                  const std::vector<bool>& fixed) {
  Cliques neighbours;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) neighbours.add(mesh.cells.nodes(cell));
  for (const auto& [stiffness, points] : ties) {
    for (const JointPoint& point : points) neighbours.add(std::vector<int>{point.node_a[0], point.node_b[0]});
  }
  const std::vector<int> set_of = connected_sets(mesh.n_nodes(), neighbours);
  const Eigen::Vector3d low = mesh.coords.rowwise().minCoeff(), high = mesh.coords.rowwise().maxCoeff();
  const Eigen::Vector3d centre = 0.5 * (low + high);
  const double size_m = (high - low).norm();
  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  std::vector<Matrix6d> held(*std::max_element(set_of.begin(), set_of.end()) + 1, Matrix6d::Zero());
  for (std::size_t dof = 0; dof < fixed.size(); ++dof) {
    if (!fixed[dof]) continue;
    const auto node = static_cast<Eigen::Index>(dof / 3);
    const Eigen::Vector3d e = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(dof % 3));
    Eigen::Matrix<double, 6, 1> motion;  // u_e of t + w x x, as factors of t and of w times the size
    motion << e, ((mesh.coords.col(node) - centre) / size_m).cross(e);
    held[set_of[node]] += motion * motion.transpose();
  }
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    Matrix6d& set = held[set_of[mesh.cells.nodes(cell)[0]]];
    if (set(0, 0) < 0.0) continue;  // seen before
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(set);
    // A held machine stands on feet of more than a thousandth of its size: 1e-6; a free motion leaves rounding, 1e-16.
    if (!(eigen.eigenvalues()[0] > 1e-11 * eigen.eigenvalues()[5])) {
      throw InputError(
          fmt::format("supports: the part with region '{}' is not held; it can still move as a rigid body. Fix more "
                      "surfaces or directions",
                      mesh.regions[mesh.cells.group[cell]]));
    }
    set(0, 0) = -1.0;
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

Elasticity::Elasticity(const Mesh& mesh, const RegionMaterials& materials, const std::vector<Support>& supports)
    : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.n_nodes = mesh.n_nodes();
  p.free_of.assign(3 * p.n_nodes, 0);
  for (const Support& support : supports) {
    for (int facet : mesh.facets_on(mesh.surface(support.surface))) {
      for (int node : mesh.facets.nodes(facet)) {
        for (int i = 0; i < 3; ++i) {
          if (support.fixed[i]) p.free_of[3 * node + i] = -1;
        }
      }
    }
  }
  for (int& row : p.free_of) {
    if (row == 0) row = p.n_free++;
  }

  std::vector<std::pair<double, std::vector<JointPoint>>> ties;
  Cliques cliques;  // of free unknowns
  const auto add_clique = [&](auto&& nodes) {
    std::vector<int> rows;
    for (int node : nodes) {
      for (int i = 0; i < 3; ++i) {
        if (p.free_of[3 * node + i] >= 0) rows.push_back(p.free_of[3 * node + i]);
      }
    }
    cliques.add(rows);
  };
  for (int cell = 0; cell < mesh.cells.size(); ++cell) add_clique(mesh.cells.nodes(cell));
  for (const mesh::Joint& joint : mesh.joints) {
    ties.emplace_back(tie_stiffness_N_m3(mesh, joint, materials), joint_points(mesh, joint));
    for (const JointPoint& point : ties.back().second) {
      std::vector<int> nodes = point.node_a;
      nodes.insert(nodes.end(), point.node_b.begin(), point.node_b.end());
      add_clique(nodes);
    }
  }
  std::vector<bool> fixed(p.free_of.size());
  for (std::size_t dof = 0; dof < fixed.size(); ++dof) fixed[dof] = p.free_of[dof] < 0;
  require_held(mesh, ties, fixed);
  SparseRow k = pattern(p.n_free, cliques);

  std::vector<Eigen::Triplet<double>> thermal;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto nodes = mesh.cells.nodes(cell);
    const CellMatrices m = cell_matrices(mesh, cell, materials[mesh.cells.group[cell]]);
    std::vector<int> rows, kept;
    for (std::size_t i = 0; i < 3 * nodes.size(); ++i) {
      const int dof = 3 * nodes[i / 3] + static_cast<int>(i % 3);
      if (p.free_of[dof] >= 0) {
        rows.push_back(p.free_of[dof]);
        kept.push_back(static_cast<int>(i));
      }
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        thermal.emplace_back(dof, nodes[j], m.thermal_load(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      }
    }
    scatter_add(k, rows, m.stiffness(kept, kept));
  }
  p.thermal_load.resize(3 * p.n_nodes, p.n_nodes);
  p.thermal_load.setFromTriplets(thermal.begin(), thermal.end());
  thermal = {};

  for (const auto& [stiffness, points] : ties) {
    for (const JointPoint& point : points) {
      for (int direction = 0; direction < 3; ++direction) {
        std::vector<int> rows;
        std::vector<double> jump;
        const auto add = [&](const std::vector<int>& nodes, const std::vector<double>& weights, double sign) {
          for (std::size_t i = 0; i < nodes.size(); ++i) {
            const int row = p.free_of[3 * nodes[i] + direction];
            if (row < 0) continue;
            rows.push_back(row);
            jump.push_back(sign * weights[i]);
          }
        };
        add(point.node_a, point.weight_a, 1.0);
        add(point.node_b, point.weight_b, -1.0);
        const Eigen::Map<const Eigen::VectorXd> b(jump.data(), static_cast<Eigen::Index>(jump.size()));
        scatter_add(k, rows, stiffness * point.area_m2 * b * b.transpose());
      }
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
    throw InputError(
        "supports: the machine is not held; some part can still move as a rigid body. Fix more surfaces or "
        "directions");
  }
}

Eigen::VectorXd Elasticity::influence(const DisplacementFunctional& functional) const {
  Eigen::VectorXd l = Eigen::VectorXd::Zero(3 * parts_->n_nodes);
  for (const auto& [node, weight] : functional.terms) l.segment<3>(3 * node) += weight;
  return parts_->thermal_load.transpose() * parts_->solve(l);
}

Eigen::Matrix3Xd Elasticity::displacement(const Eigen::VectorXd& theta) const {
  const Eigen::VectorXd u = parts_->solve(parts_->thermal_load * theta.head(parts_->n_nodes));
  return Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, parts_->n_nodes);
}

}  // namespace driftwright::solver
