#pragma once
// What measurements say about a simulation: verdict, causes, what stays unexplained, and what mending it gains.

#include <optional>

#include "diagnosis/experiment.hpp"
#include "diagnosis/search.hpp"
#include "diagnosis/unnamed.hpp"
#include "diagnosis/waveform.hpp"

namespace driftwright::diagnosis {

enum class Verdict { kConsistent, kNamed, kAmbiguous, kUnexplained, kInsufficientData };
[[nodiscard]] const char* word(Verdict verdict);

/// A number with its 95 % interval.
struct Estimate {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;
  double deviation = 0.0;  ///< from what the scenario says, in standard deviations of its prior; of calibrated numbers
};

struct Cause {
  std::string effect, where, law;
  std::vector<Estimate> parameters;
  double log_evidence_gain = 0.0;
  std::vector<Cause> alternatives;
};

/// Residuals of a channel in three states of the model.
struct ChannelGain {
  std::string name, unit;  ///< K, um, urad
  double noise_floor = 0.0;
  double rmse_before = 0.0, rmse_calibrated = 0.0,
         rmse_after = 0.0;  ///< as written; scatter alone; with the causes; kept out of the fit
  double peak_before = 0.0, peak_after = 0.0;
};

/// What no candidate explains.
struct Unexplained {
  struct Channel {
    std::string name, unit;
    double rms = 0.0;          ///< of the smooth part of the residual
    double times_noise = 0.0;  ///< its squares over what noise would have, in standard deviations of that
  };
  std::vector<Channel> channels;  ///< worst first; those that stand out
  std::string correlates_with;    ///< what its waveform looks like, or ""
  double correlation = 0.0;
  std::string heat_would_sit_in;       ///< region whose missing heat would explain most of it, or ""
  std::vector<double> time_s, heat_W;  ///< that latent heat in the first run, per row
  std::optional<Unnamed> one_cause;    ///< that explains it better than the named ones
  bool fails_held_out = false;         ///< the causes predict kept-out data worse than scatter alone
};

struct Diagnosis {
  Verdict verdict = Verdict::kConsistent;
  std::string reason;
  std::vector<Cause> causes;
  std::optional<Experiment> experiment;
  std::optional<Unexplained> unexplained;
  /// Causes, intervals and gains count what the model misses as noise: it misses far more than noise, whatever is claimed.
  bool weighed_by_model_error = false;
  std::string holdout;  ///< how the gain was held out
  std::vector<ChannelGain> gain;
  /// What the scenario with its numbers fitted, and no cause, misses over time, body by body and displacement by displacement.
  std::vector<Waveform> waveforms;
  std::vector<DataFinding> data;
  int n_candidates = 0;
  SearchResult search;
  std::map<std::string, NoiseModel> noise;
  std::vector<Estimate> calibrated;  ///< scatter's numbers, as fitted with the causes
  Prediction as_written, scatter_alone, extended;
};

struct DiagnosisOptions {
  std::set<std::string> without;
  int most_effects = 3;  ///< 0: scatter alone
  /// Error of the twin's mesh over the difference to the other one: 1 / |size ratio² - 1| where errors go with the square of the size.
  double mesh_error_share = 1.0;
  double floor_K = 2e-3, floor_m = 5e-9, floor_rad = 5e-8;  ///< errors of the reduced model
};

/// @param coarse  the same machine on a coarser mesh, or null: what its mesh does is no finding
/// @param runs    at least one
[[nodiscard]] Diagnosis diagnose(const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
                                 const DiagnosisOptions& options, const std::function<void(const std::string&)>& say);

}  // namespace driftwright::diagnosis
