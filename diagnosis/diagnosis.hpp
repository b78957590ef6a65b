#pragma once
// The result of comparing measurements with a simulation: verdict, causes, what remains unexplained, and the gain of the
// extended scenario.

#include <limits>
#include <optional>

#include "diagnosis/experiment.hpp"
#include "diagnosis/heat_wander.hpp"
#include "diagnosis/posterior.hpp"
#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

enum class Verdict { kConsistent, kSuspected, kNamed, kAmbiguous, kUnexplained, kInsufficientData };
[[nodiscard]] const char* word(Verdict verdict);

/// What a channel measures: temperature, displacement or tilt. @param unit  K, um or urad, or m or rad
[[nodiscard]] const char* quantity_word(const std::string& unit);

/// The certainty of a cause.
enum class Standing {
  kSuspected,  ///< statement below kSure; or kept-out rows not better; or more left than it explains
  kAmbiguous,  ///< certain, but others would explain as much
  kNamed,
};
[[nodiscard]] const char* word(Standing standing);

/// A number with its 95 % interval.
struct Estimate {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;
  // Of calibrated numbers:
  double deviation = 0.0;  ///< from the scenario's value, in standard deviations of its prior
  double known_to = 0.0;   ///< standard deviation of that prior: of the logarithm if is_share, otherwise in the unit
  bool is_share = false;
  bool is_written = true;  ///< whether extended.yaml contains this value
  int line = 0;            ///< of the scenario's effect whose number it is, in its file; 0: of none
};

struct Cause {
  std::string effect, where, law;
  std::vector<Estimate> parameters;
  double log_evidence_gain = 0.0;
  std::vector<Cause> alternatives;
  Standing standing = Standing::kSuspected;
  std::string doubt = {};      ///< reason why it is only suspected, a clause; "" if it is certain
  double probability = 0.0;    ///< of the statement that it names
  double kept_out_nats = 0.0;  ///< how much likelier it makes the kept-out rows; 0 for scenario numbers that moved too far
  bool is_written = true;      ///< whether extended.yaml contains it
  std::string why_not_written = {};  ///< reason, a clause; "" if it is written
  /// Share of the odds among all alternatives (rivals.hpp): its own; in `odds` that of its kind at any place, and that of
  /// its place within the kind.
  double share = 1.0;
  Odds odds = {};
  std::string own = {};  ///< the scenario's effects that it changes (own_effects.hpp); "": it only adds something
};

/// The content of extended.yaml: claims that predict kept-out rows better, and the scenario's own numbers as fitted with
/// them.
struct Written {
  Hypothesis hypothesis;
  std::vector<std::size_t> causes;  ///< indices in Diagnosis::causes, one per claim
  Fit fit;
  std::vector<std::string> why_not =
      {};                        ///< for each claim of the search: reason why it is left out, a clause; "" if it is written
  bool keeps_numbers = true;     ///< false: nothing is written
  bool causes_alone = false;     ///< the scenario's own numbers are unchanged
  std::string why_nothing = {};  ///< if nothing is written, or causes alone: the reason, a clause
  /// Certain claims that are left out, while the scenario's own numbers were fitted without them: these numbers may have
  /// absorbed their effect.
  std::vector<std::size_t> taken_up = {};
};

/// Residuals of a channel for several versions of the model.
struct ChannelGain {
  std::string name, unit;  ///< K, um, urad
  double noise_floor = 0.0;
  double rmse_before = 0.0, rmse_calibrated = 0.0,
         rmse_after =
             0.0;  ///< as written; scatter alone; what extended.yaml holds, fitted without them: on rows that were kept out
  double peak_before = 0.0, peak_after = 0.0;
  /// RMSE of regressions without a machine model, on the same kept-out rows (plain_regression.hpp): on drive and ambient,
  /// and also on thermometers.
  double rmse_of_drive = 0.0, rmse_of_readings = 0.0;
  /// RMSE over all rows of all records, to which the numbers were fitted: of the scenario as written, and of the written
  /// file; NaN if that was not simulated.
  double rmse_all_before = 0.0, rmse_written = 0.0;
  /// On kept-out rows as rmse_after: with the named causes and the scenario's numbers fitted with them. NaN if there are
  /// none.
  double rmse_named = std::numeric_limits<double>::quiet_NaN();
};

/// Root mean squares of kept-out errors divided by the noise of their channels, over all channels; the same versions as
/// in ChannelGain.
struct KeptOutMisses {
  double as_written = 0.0, calibrated = 0.0, extended = 0.0;
  double named = std::numeric_limits<double>::quiet_NaN();
};

/// The part of the residual that no candidate explains.
struct Unexplained {
  struct Channel {
    std::string name, unit;
    double rms = 0.0;          ///< of the smooth part of the residual
    double times_noise = 0.0;  ///< its squares minus those expected of noise, in standard deviations of the latter
  };
  std::vector<Channel> channels;  ///< channels that stand out, worst first
  double nats = 0.0;              ///< evidence that a cause of the right shape would have at most
  std::optional<std::size_t>
      statement;                ///< index in Diagnosis::statements of the statement that has no name in the catalogue
  bool fails_held_out = false;  ///< the causes predict kept-out data worse than scatter alone
};

struct Diagnosis {
  Verdict verdict = Verdict::kConsistent;
  std::string reason;
  std::vector<Cause> causes;
  Posterior statements;  ///< what is missing, in a grammar wider than the catalogue, with probabilities
  std::optional<Experiment> experiment;
  std::optional<Unexplained> unexplained;
  /// Causes, intervals and gains treat the model's error as noise, because it is far larger than the noise with any
  /// claim.
  bool weighed_by_model_error = false;
  std::optional<HeatWander> wander;  ///< with weighed_by_model_error: random heat in bodies, by which readings are moved
  std::string ended_at;              ///< the step in which the user ended it; empty: it is complete
  std::string holdout;               ///< how the gain was held out
  std::vector<ChannelGain> gain;
  KeptOutMisses misses;
  std::vector<DataFinding> data;
  int n_candidates = 0;
  SearchResult search;  ///< its claims are the first causes, in this order; after them numbers that moved too far
  std::map<std::string, NoiseModel> noise;
  Written written;
  std::vector<Knob> scatter;         ///< uncertain numbers: the scenario's own and each run's ambient
  std::vector<std::size_t> moved;    ///< indices of those that moved so far that they are causes, in the order of these
  std::vector<Estimate> calibrated;  ///< these numbers as fitted with the written causes
  scenarios::KnownTogether known_together;  ///< of calibrate(): what the fit leaves open of them, without the ambient
  Prediction as_written;
  /// For each cause: all that was found but this cause, at the same numbers. Empty if it was not simulated: the diagnosis
  /// was ended, or the machine has no solution without the cause.
  std::vector<Prediction> without_cause;
  Prediction extended;  ///< prediction by extended.yaml for all rows of all records
};

struct DiagnosisOptions {
  std::set<std::string> without;
  int most_effects = 3;  ///< 0: scatter alone
  /// Share of the error of the twin's mesh in the difference to the other mesh: 1 / |size ratio² - 1| if errors grow with
  /// the square of the size.
  double mesh_error_share = 1.0;
  NoiseFloor floor;
};

/// @param coarse    the same machine on a coarser mesh, or null: errors of the mesh are no finding
/// @param runs      at least one
/// @param listener  after a request to end, the diagnosis contains what is known so far, marked as incomplete
[[nodiscard]] Diagnosis diagnose(const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
                                 const DiagnosisOptions& options, const Listener& listener = {});

/// Marks the scenario's own numbers as not written, except those that are causes: for a file with causes only.
void leave_numbers(Diagnosis& d);

}  // namespace driftwright::diagnosis
