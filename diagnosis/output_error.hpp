#pragma once
// The weight of a row if the model errs by more than noise: from the error of the free-running simulation and its
// correlation in time.
//
// A working likelihood: the rows of a channel are treated as independent, each with the variance s² of the simulation's
// error (mean square of the residual, without feedback of readings), and the whole is raised to the power 1/τ, with τ = 1
// + 2 Σ ρ_k, the number of rows that carry the information of one: n rows count as n/τ independent ones, which sets the
// width of intervals.
// fed back), and the whole to the power 1/τ, τ = 1 + 2 Σ ρ_k the number of rows that are worth one: n rows count as n/τ
// independent ones do, and so wide are intervals. Sources: Ljung, System Identification, 2nd ed. (1999), ch. 7, output
// error; Pauli, Racugno & Ventura, Statistica Sinica 21 (2011) 149-164, the power; Geyer, Statistical Science 7 (1992)
// 473-483, where the sum of correlations ends.

#include "diagnosis/comparison.hpp"

namespace driftwright::diagnosis {

/// The error of a channel.
struct OutputError {
  std::string unit = {};     ///< "K", "m" or "rad"
  double rms = 0.0;          ///< in it
  double rows_as_one = 1.0;  ///< τ, at least 1
  Eigen::Index n = 0;        ///< readings
};

/// The error of each channel, over all runs. A channel without readings has no entry.
[[nodiscard]] std::map<std::string, OutputError> output_errors(const std::vector<MeasuredRun>& runs,
                                                               const Prediction& prediction);

/// Noise that weighs readings in this way: n rows count as n/τ. @param least  the channels' noise, as a lower bound
[[nodiscard]] std::map<std::string, NoiseModel> working_noise(const std::map<std::string, OutputError>& errors,
                                                              const std::map<std::string, NoiseModel>& least);

}  // namespace driftwright::diagnosis
