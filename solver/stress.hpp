#pragma once
// Stresses from displacements and temperatures: σ = D (B u - α θ), components as in cell_elasticity.hpp.

#include "solver/cell_elasticity.hpp"
#include "solver/elasticity.hpp"

namespace driftwright::solver {

/// Six components per node [Pa], one column each.
using NodalStress = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Stresses recovered at the nodes. In each cell a polynomial is fitted by least squares to the stresses at the points of
/// mesh::stiffness_rule() (tetrahedra: linear; a single point: constant) and extrapolated to its nodes; at each node the
/// values of the adjacent cells are averaged, weighted by their volumes.
///
/// The average is taken over cells of one region. A node that several regions share (a mesh imported with welded parts) gets
/// the value of the region with the largest von Mises stress there: stress jumps between materials, and the mean
/// would occur in neither. Nodes in no cell get zero.
[[nodiscard]] NodalStress nodal_stress_Pa(const mesh::Mesh& mesh, const RegionMaterials& materials,
                                          const Eigen::Matrix3Xd& displacement_m, const Eigen::VectorXd& theta_K);

/// sqrt( ½[(σx-σy)² + (σy-σz)² + (σz-σx)²] + 3(τxy² + τyz² + τzx²) ), in the unit of the stress.
[[nodiscard]] double von_mises(const Stress& stress);

/// Stresses at the nodes.
struct StressField {
  Eigen::Matrix<double, 6, Eigen::Dynamic> stress_MPa;  ///< rows xx, yy, zz, xy, yz, xz: VTK's order of a symmetric tensor
  Eigen::VectorXd von_mises_MPa;
};
/// nodal_stress_Pa() with its von Mises stresses; the same arguments.
[[nodiscard]] StressField stress_field(const mesh::Mesh& mesh, const RegionMaterials& materials,
                                       const Eigen::Matrix3Xd& displacement_m, const Eigen::VectorXd& theta_K);

}  // namespace driftwright::solver
