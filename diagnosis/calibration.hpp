#pragma once
// Fits the scenario's uncertain numbers to records, without a search for causes.
//
// The fit uses what will later be asked: the simulation, driven by the recorded drive and by no reading. If its error is
// no larger than the noise, readings are weighed by their noise. If it is larger, numbers are fitted together with a
// discrepancy that may absorb the model's error (discrepancy.hpp), and readings are weighed by a working likelihood of
// the error that both together leave (output_error.hpp); the machine without the discrepancy is written and judged.

#include "base/mean_error.hpp"
#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

/// How much worse one model predicts kept-out rows than another: logarithm of the ratio of their errors, over the folds.
/// @param misses, others  root mean squares, one per fold; NaN for folds that could not judge
[[nodiscard]] MeanError kept_out_loss(const std::vector<double>& misses, const std::vector<double>& others);

/// The scenario's own numbers at x, with 95 % intervals. @param known_to  standard deviation of each prior
[[nodiscard]] std::vector<Estimate> fitted_numbers(const Fitter& fitter, const Eigen::VectorXd& x,
                                                   const Eigen::MatrixXd& covariance, const std::vector<double>& known_to);

/// What a fit leaves open of the scenario's own numbers, whatever the offsets of its records are.
/// @param numbers, covariance  one entry, row and column for each knob
[[nodiscard]] scenarios::KnownTogether known_together(const std::vector<Estimate>& numbers, const std::vector<Knob>& knobs,
                                                      const Eigen::MatrixXd& covariance);

/// A diagnosis without causes: numbers, gain, and what is left. Numbers are written unless the error is larger than the
/// scenario's: on the rows that they were fitted to, or on kept-out rows by more than a standard error of the folds. If the
/// simulation errs by more than noise, nor may displacements together lose on fitted rows, nor a channel on kept-out rows.
/// @param coarse, runs, listener  as in diagnose()
[[nodiscard]] Diagnosis calibrate(const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
                                  const DiagnosisOptions& options, const Listener& listener = {});

}  // namespace driftwright::diagnosis
