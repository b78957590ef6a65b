#pragma once
// The scenario's uncertain numbers fitted to records; no cause is looked for.
//
// What is fitted is what will be asked: what the simulation gives, driven by what was recorded and by no reading. Where it errs by no more than noise, readings are
// weighed by their noise. Where it errs by more, numbers are fitted beside a discrepancy in which the model's error may lie (discrepancy.hpp), readings weighed by a working
// likelihood of what both together miss (output_error.hpp); what is written and judged is the machine without the discrepancy.

#include "base/mean_error.hpp"
#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

/// How much worse kept-out rows are predicted by one model than by another: the logarithm of what they miss, over the folds.
/// @param misses, others  root mean squares, a fold each; folds that could not judge are NaN
[[nodiscard]] MeanError kept_out_loss(const std::vector<double>& misses, const std::vector<double>& others);

/// The scenario's own numbers at x, with intervals of 95 %. @param known_to  1 sigma of each
[[nodiscard]] std::vector<Estimate> fitted_numbers(const Fitter& fitter, const Eigen::VectorXd& x,
                                                   const Eigen::MatrixXd& covariance, const std::vector<double>& known_to);

/// A diagnosis without causes: numbers, gain, what is left. Where the simulation errs by more than noise, numbers are written unless the rows that they were fitted to are
/// missed by more than by the scenario as it is, or rows that were kept out, by more than a standard error of the folds.
/// @param coarse, runs, listener  as diagnose() has them
[[nodiscard]] Diagnosis calibrate(const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
                                  const DiagnosisOptions& options, const Listener& listener = {});

}  // namespace driftwright::diagnosis
