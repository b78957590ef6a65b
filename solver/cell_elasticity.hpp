#pragma once
// Strain and stress inside one cell: ε = B u, σ = D (ε - α θ). Components in the order xx, yy, zz, xy, yz, zx; shear strains
// are engineering ones, 2 ε_xy.
// Source of the formulas: Zienkiewicz, Taylor & Zhu, The Finite Element Method, vol. 1, ch. 2 and 6.

#include <Eigen/Core>

#include "mesh/mesh.hpp"
#include "mesh/shape.hpp"
#include "solver/material.hpp"

namespace driftwright::solver {

/// Stress components xx, yy, zz, xy, yz, zx [Pa].
using Stress = Eigen::Matrix<double, 6, 1>;

/// Strain matrix B, 6 x 3n [1/m].
using StrainMatrix = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 3 * mesh::kMaxNodesPerCell>;

/// D [Pa] of an isotropic material.
[[nodiscard]] Eigen::Matrix<double, 6, 6> elasticity_tensor_Pa(const Material& material);

/// Free thermal strain per kelvin [1/K], six components.
[[nodiscard]] Eigen::Matrix<double, 6, 1> thermal_strain_1_K(const Material& material);

/// The data at a point of a cell from which stiffness, thermal load and stress are computed.
struct CellPoint {
  mesh::ShapeValues shape;
  StrainMatrix strain;  ///< B
  double det_m3 = 0.0;  ///< Jacobian determinant
};
/// @param coords  3 x n nodes of the cell [m]
[[nodiscard]] CellPoint cell_point(mesh::CellShape shape, const Eigen::Ref<const Eigen::Matrix3Xd>& coords,
                                   const Eigen::Vector3d& xi);

}  // namespace driftwright::solver
