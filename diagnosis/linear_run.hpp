#pragma once
// A run of a twin as a linear machine from row to row, about the states that a prediction went through.

#include "diagnosis/heat_smoother.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

struct LinearRun {
  ModalCourse course;             ///< loads: 1 W in each body; its start: each body known to 0.3 K
  Eigen::MatrixXd temperature_K;  ///< predicted mean of each body over the reference, rows x bodies
  Eigen::VectorXd ambient_K;      ///< over the reference
  Eigen::MatrixXd turning_W;      ///< heat of each body that would be missing from row to row if the spindle stood, bodies x rows - 1
  Eigen::MatrixXd decay;          ///< of each mode from row to row, modes x rows - 1
};

/// The bodies that heat may be missing in: regions and nodes, not the ambient.
[[nodiscard]] std::vector<effects::Body> bodies_of(const effects::DoubtScene& scene);

/// @param rows   of the run that are looked at, increasing
/// @param scale  what each of the run's channels is divided by in ModalCourse::Modes::observe
/// @throws SolveError  where the state has no solution
[[nodiscard]] LinearRun linear_run(const Twin& twin, const MeasuredRun& run, const TwinState& state,
                                   const std::vector<effects::Body>& bodies, const std::vector<Eigen::Index>& rows,
                                   const Eigen::VectorXd& scale, Twin::Workspace& workspace);

/// What each mode gains from row to row by heat in bodies. @param heat_W  of each body that linear_run() was given, bodies x rows - 1
/// @return  modes x rows - 1
[[nodiscard]] Eigen::MatrixXd modal_gain(const LinearRun& run, const Eigen::MatrixXd& heat_W);

/// What gains of the modes from one row to another do to the channels, over their scale. @return n_channels x n_rows
[[nodiscard]] Eigen::MatrixXd response(const LinearRun& run, const Eigen::MatrixXd& gain, Eigen::Index from,
                                       Eigen::Index to);

/// Mean of a temperature difference from row to row: where an exchange is strong it falls exponentially, and its mean is the logarithmic one.
[[nodiscard]] double mean_difference(double first_K, double second_K);

}  // namespace driftwright::diagnosis
