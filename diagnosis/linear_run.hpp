#pragma once
// A run of a twin as a linear machine from row to row, about the states that a prediction went through.

#include "diagnosis/heat_smoother.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

struct LinearRun {
  ModalCourse course;             ///< loads: 1 W in each body; its start: each body known to 0.3 K
  Eigen::MatrixXd temperature_K;  ///< predicted mean of each body over the reference, rows x bodies
  Eigen::VectorXd hall_K;         ///< over the reference
};

/// The bodies that heat may be missing in: regions and nodes, not the hall.
[[nodiscard]] std::vector<effects::Body> bodies_of(const effects::DoubtScene& scene);

/// @param rows   of the run that are looked at, increasing
/// @param scale  what each of the run's channels is divided by in ModalCourse::Modes::observe
/// @throws SolveError  where the state has no solution
[[nodiscard]] LinearRun linear_run(const Twin& twin, const MeasuredRun& run, const TwinState& state,
                                   const std::vector<effects::Body>& bodies, const std::vector<Eigen::Index>& rows,
                                   const Eigen::VectorXd& scale, Twin::Workspace& workspace);

/// Mean of a temperature difference from row to row: where an exchange is strong it falls exponentially, and its mean is the logarithmic one.
[[nodiscard]] double mean_difference(double first_K, double second_K);

}  // namespace driftwright::diagnosis
