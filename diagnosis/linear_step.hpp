#pragma once
// A system at one drive as a linear one, laws that look at temperatures taken to first order.

#include "solver/thermal_system.hpp"

namespace driftwright::diagnosis {

/// M z' = -K z + constant + hall_K of_hall.
struct LinearSystem {
  Eigen::MatrixXd stiffness;  ///< K, not symmetric where a law looks at temperatures
  Eigen::VectorXd constant, of_hall;
};

/// About the state halfway from `start` to balance at this drive.
/// @param at  its hall is the one to be about
[[nodiscard]] LinearSystem linear_system(const solver::ReducedSystem& system, const effects::Inputs& at,
                                         const Eigen::VectorXd& start);

/// From one row to the next, z' = phi z + constant + hall of_hall + rise of_rise, exactly while the hall rises evenly.
struct LinearStep {
  Eigen::MatrixXd phi;
  Eigen::VectorXd constant, of_hall, of_rise;
};
[[nodiscard]] LinearStep linear_step(const LinearSystem& system, const Eigen::MatrixXd& mass, double step_s);

}  // namespace driftwright::diagnosis
