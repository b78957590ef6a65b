#pragma once
// Linearises a system at one drive, including its laws of temperatures.

#include "solver/thermal_system.hpp"

namespace driftwright::diagnosis {

/// M z' = -K z + constant + ambient_K of_ambient.
struct LinearSystem {
  Eigen::MatrixXd stiffness;  ///< K, not symmetric where a law looks at temperatures
  Eigen::VectorXd constant, of_ambient;
};

/// Linearised at the state halfway from `start` to balance at this drive.
/// @param at  gives the ambient
[[nodiscard]] LinearSystem linear_system(const solver::ReducedSystem& system, const effects::Inputs& at,
                                         const Eigen::VectorXd& start);

/// One step from row to row, z' = phi z + constant + ambient of_ambient + rise of_rise, exact while the ambient rises
/// linearly.
struct LinearStep {
  Eigen::MatrixXd phi;
  Eigen::VectorXd constant, of_ambient, of_rise;
};
[[nodiscard]] LinearStep linear_step(const LinearSystem& system, const Eigen::MatrixXd& mass, double step_s);

}  // namespace driftwright::diagnosis
