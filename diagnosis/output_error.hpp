#pragma once
// How much a row counts where the model errs by more than noise: by what the simulation, run free, is off by, and for how long that stays alike.
//
// A working likelihood: rows of a channel are taken as independent, each with the variance s² of what the simulation misses (the residual's mean square, no reading
// fed back), and the whole to the power 1/τ, τ = 1 + 2 Σ ρ_k the number of rows that are worth one: n rows count as n/τ independent ones do, and so wide are intervals.
// Sources: Ljung, System Identification, 2nd ed. (1999), ch. 7, output error; Pauli, Racugno & Ventura, Statistica Sinica 21 (2011) 149-164, the power; Geyer,
// Statistical Science 7 (1992) 473-483, where the sum of correlations ends.

#include "diagnosis/comparison.hpp"

namespace driftwright::diagnosis {

/// What a channel is missed by.
struct OutputError {
  std::string unit = {};     ///< "K", "m" or "rad"
  double rms = 0.0;          ///< in it
  double rows_as_one = 1.0;  ///< τ, at least 1
  Eigen::Index n = 0;        ///< readings
};

/// Of each channel, over all runs. A channel without readings has none.
[[nodiscard]] std::map<std::string, OutputError> output_errors(const std::vector<MeasuredRun>& runs,
                                                               const Prediction& prediction);

/// Noise that weighs readings so: n rows count as n/τ. @param least  the channels' noise, below which none counts
[[nodiscard]] std::map<std::string, NoiseModel> working_noise(const std::map<std::string, OutputError>& errors,
                                                              const std::map<std::string, NoiseModel>& least);

}  // namespace driftwright::diagnosis
