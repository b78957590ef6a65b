#pragma once
// The elastic machine at any pose, in a basis W of displacements: u = W q with (W'K W) q = W'f. Galerkin's projection, so an
// output l'u has an error of the product of two: that of the displacement, and that of the response K⁻¹l.
//
// W and the part of K that the cells make move and turn with their bodies, so both are kept as they are at one pose. Springs
// of joints and supports are projected at each pose, as the machine has them there.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/motion.hpp"
#include "solver/elasticity.hpp"
#include "solver/node_matrix.hpp"
#include "solver/springs.hpp"
#include "solver/thermal_load.hpp"

namespace driftwright::solver {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct ElasticBasis {
  RowMatrix displacement;     ///< W: 3 n_nodes x m, orthonormal, at the pose at which it was made
  Eigen::MatrixXd stiffness;  ///< W'K W of the cells, m x m
};

/// The vectors at the nodes, 3 n_nodes x any, turned with the regions. @param motions  of each region
[[nodiscard]] RowMatrix turned(const mesh::Mesh& mesh, const std::vector<mesh::Motion>& motions, const RowMatrix& vectors);

/// W'K W with springs. @param w  W turned to the pose of the springs
[[nodiscard]] Eigen::MatrixXd stiffness_with(const ElasticBasis& basis, const RowMatrix& w,
                                             std::span<const SpringLayer> layers);
/// W'l of each, m x n.
[[nodiscard]] Eigen::MatrixXd projected(const RowMatrix& w, std::span<const DisplacementFunctional> functionals);

/// Makes a basis from displacements.
class ElasticBasisMaker {
 public:
  /// @param fixed  true for dof 3 node + direction that a support fixes
  ElasticBasisMaker(const mesh::Mesh& mesh, const RegionMaterials& materials, const std::vector<bool>& fixed);

  /// Adds the columns, 3 n_nodes x any; parts of them that the basis has already are left out.
  void add(const Eigen::MatrixXd& columns);
  [[nodiscard]] const ElasticBasis& basis() const { return basis_; }
  /// W'G: forces of temperatures, m x n_nodes.
  [[nodiscard]] const Eigen::MatrixXd& force() const { return force_; }

 private:
  NodeMatrix cells_;
  ThermalLoad load_;
  ElasticBasis basis_;
  Eigen::MatrixXd force_;
};

}  // namespace driftwright::solver
