#pragma once
// A system at one drive as a linear one, laws that look at temperatures taken to first order.

#include "solver/thermal_system.hpp"

namespace driftwright::diagnosis {

/// M z' = -K z + constant + ambient_K of_ambient.
struct LinearSystem {
  Eigen::MatrixXd stiffness;  ///< K, not symmetric where a law looks at temperatures
  Eigen::VectorXd constant, of_ambient;
};

/// About the state halfway from `start` to balance at this drive.
/// @param at  its ambient is the one to be about
[[nodiscard]] LinearSystem linear_system(const solver::ReducedSystem& system, const effects::Inputs& at,
                                         const Eigen::VectorXd& start);

/// From one row to the next, z' = phi z + constant + ambient of_ambient + rise of_rise, exactly while the ambient rises evenly.
struct LinearStep {
  Eigen::MatrixXd phi;
  Eigen::VectorXd constant, of_ambient, of_rise;
};
[[nodiscard]] LinearStep linear_step(const LinearSystem& system, const Eigen::MatrixXd& mass, double step_s);

}  // namespace driftwright::diagnosis
