#pragma once
// Projects a system on a basis, which gives a small system.

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// M-orthonormal basis of the columns; columns that add nothing (below 1e-10 of their length) are dropped.
[[nodiscard]] Eigen::MatrixXd orthonormalise(const SparseRow& mass, const Eigen::MatrixXd& columns);

/// Galerkin projection on an M-orthonormal basis: same laws, probes and thermostats, small matrices, M = 1.
/// @throws std::logic_error  for a system with nonlinear terms, varying heat capacity or prescribed unknowns (reducible()
///                           makes one without them)
[[nodiscard]] ReducedSystem project(const FullSystem& system, const Eigen::MatrixXd& basis);

/// A smaller system from a reduced one with M = 1. @param basis  orthonormal
[[nodiscard]] ReducedSystem project(const ReducedSystem& system, const Eigen::MatrixXd& basis);

/// The same system in unknowns w = C'z with M = C C', in which M = 1. @param start  z at t = 0, which becomes w
[[nodiscard]] ReducedSystem with_unit_mass(const ReducedSystem& system, Eigen::VectorXd& start);

}  // namespace driftwright::solver
