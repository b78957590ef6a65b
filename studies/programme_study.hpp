#pragma once
// Compares predictors of drift: each learns from the programme's tests, or from the model, and predicts its cyclograms.

#include <functional>

#include "compensation/predictors/assembled_curves.hpp"
#include "compensation/predictors/deployed_predictor.hpp"
#include "compensation/predictors/identified_modes.hpp"
#include "compensation/predictors/scaled_modes.hpp"
#include "machine/simulated_run.hpp"

namespace driftwright::studies {

/// The error of a predictor on one channel of one cyclogram.
struct PredictionError {
  double peak = 0.0;                 ///< of the true course
  double largest = 0.0, mean = 0.0;  ///< of |true - predicted|, over its rows
  double of = 0.0;                   ///< reference of percentages: max(peak of the channel, 10 % of the peak of the vector)
  [[nodiscard]] double largest_percent() const { return of > 0.0 ? 100.0 * largest / of : 0.0; }
  [[nodiscard]] double mean_percent() const { return of > 0.0 ? 100.0 * mean / of : 0.0; }
};

struct JudgedCyclogram {
  Cyclogram cyclogram;
  compensation::CyclogramType type = compensation::CyclogramType::kContinuous;
  bool is_random = false;
  std::vector<double> time_s;
  Eigen::MatrixXd truth;  ///< n_channels x n_times, um and urad, since the start
};

/// Predictors of one kind, one per channel, and their predictions from drive and ambient alone.
struct JudgedPredictor {
  std::vector<compensation::DeployedPredictor>
      channels;                            ///< all with one name, in the order of TestChannels; those of tilts predict urad
  std::vector<Eigen::MatrixXd> predicted;  ///< per judged cyclogram, as its truth
  std::vector<std::vector<PredictionError>> errors;  ///< per judged cyclogram, per channel
  double seconds = 0.0;  ///< mean time of one prediction of one channel; printed on the terminal only

  [[nodiscard]] const std::string& name() const { return channels.front().name; }
};

struct ProgrammeStudy {
  compensation::TestChannels channels;  ///< displacements, then tilts
  std::vector<JudgedCyclogram> judged;
  std::vector<JudgedPredictor> predictors;
  compensation::IdentifiedModes identified;
  std::vector<compensation::ScaledModes::Factor> factors;
  int n_modes_wanted =
      0;  ///< number of the model's completed modes with which every error is at most 1 %; 0: no number is enough
  std::string without_model;  ///< reason if the predictors from the model and the hybrid are left out; else empty
  std::vector<std::pair<int, double>> error_by_modes;  ///< number of modes, largest error of all [%]
  std::vector<double> time_constant_s;                 ///< of the model's modes at standstill, slowest first
  struct Scheduled {
    std::string predictor, channel;
    int n_inside = 0, n_cyclograms = 0;  ///< random cyclograms, and how many the corrections keep within the tolerance
    double worst_um = 0.0, mean_changes = 0.0;
    int most_changes = 0;
  };
  std::vector<Scheduled> scheduled;
};

/// The errors of one channel over some cyclograms: the largest error, and the mean of their mean errors.
struct Summary {
  double largest = 0.0, largest_percent = 0.0, mean = 0.0, mean_percent = 0.0;
  int n = 0;
};
/// @param counts  selects the cyclograms
[[nodiscard]] Summary summary(const ProgrammeStudy& study, const JudgedPredictor& predictor, std::size_t channel,
                              const std::function<bool(const JudgedCyclogram&)>& counts);

/// @throws InputError, SolveError  as the predictors
[[nodiscard]] ProgrammeStudy study_programme(const scenarios::Scenario& scenario, const scenarios::Model& model,
                                             const Listener& listener);

}  // namespace driftwright::studies
