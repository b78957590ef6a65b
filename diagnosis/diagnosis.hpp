#pragma once
// What measurements say about a simulation: verdict, causes, what stays unexplained, and what mending it gains.

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

/// How surely a cause is one.
enum class Standing {
  kSuspected,  ///< its statement is less sure than kSure; or it does not predict kept-out rows better; or more is left than it explains
  kAmbiguous,  ///< sure, but others would do as well
  kNamed,
};
[[nodiscard]] const char* word(Standing standing);

/// A number with its 95 % interval.
struct Estimate {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;
  // Of calibrated numbers:
  double deviation = 0.0;  ///< from what the scenario says, in standard deviations of its prior
  double known_to = 0.0;   ///< 1 sigma of that: of the logarithm where is_share, else in the unit
  bool is_share = false;
  bool is_written = true;  ///< whether extended.yaml holds this value
};

struct Cause {
  std::string effect, where, law;
  std::vector<Estimate> parameters;
  double log_evidence_gain = 0.0;
  std::vector<Cause> alternatives;
  Standing standing = Standing::kSuspected;
  std::string doubt = {};    ///< why it is only suspected, a clause; "" where it is not
  double probability = 0.0;  ///< of the statement that it is a name of
  double kept_out_nats =
      0.0;  ///< how much likelier kept-out rows are with it than without it; of numbers that have gone too far 0
  bool is_written = true;            ///< whether extended.yaml has it
  std::string why_not_written = {};  ///< a clause; "" where it is written
  /// Share of the odds of all that was fitted in its place (rivals.hpp): its own; of its kind wherever it sits; and, of the kind's, that of its place.
  double share = 1.0;
  Odds odds = {};
  int n_searched = 0, n_again = 0;  ///< searches without a part of the rows, and in how many of them it was found again
};

/// What extended.yaml holds: claims that predict kept-out rows better, and the scenario's own numbers as fitted beside them.
struct Written {
  Hypothesis hypothesis;
  std::vector<std::size_t> causes;  ///< of Diagnosis::causes, one a claim
  Fit fit;
  std::vector<std::string> why_not =
      {};                        ///< of each claim of the search, why it is left out, a clause; "" where it is written
  bool keeps_numbers = true;     ///< false: nothing is written
  bool causes_alone = false;     ///< the scenario's own numbers are as they were
  std::string why_nothing = {};  ///< where nothing is written, or causes alone: why, a clause
  /// Claims that stood up and are left out, while the scenario's own numbers were fitted anew without them: these may have taken up what the claims do.
  std::vector<std::size_t> taken_up = {};
};

/// Residuals of a channel in three states of the model.
struct ChannelGain {
  std::string name, unit;  ///< K, um, urad
  double noise_floor = 0.0;
  double rmse_before = 0.0, rmse_calibrated = 0.0,
         rmse_after =
             0.0;  ///< as written; scatter alone; what extended.yaml holds, fitted without them: on rows that were kept out
  double peak_before = 0.0, peak_after = 0.0;
  /// Of regressions that know nothing of the machine, on the same kept-out rows (plain_regression.hpp): what drove it and the ambient; thermometers too.
  double rmse_of_drive = 0.0, rmse_of_readings = 0.0;
  /// Over the whole of all records, the rows that numbers were fitted to: of the scenario as written; of the file that is written, NaN where nobody simulated it.
  double rmse_all_before = 0.0, rmse_written = 0.0;
  /// On kept-out rows as rmse_after: the causes that are named, with the scenario's numbers fitted beside them; and what the searches without these rows found, whatever
  /// of it is written, which these rows had no say in. NaN where there is none.
  double rmse_named = std::numeric_limits<double>::quiet_NaN(), rmse_found = std::numeric_limits<double>::quiet_NaN();
};

/// Root mean squares of kept-out misses over the noise of their channels, all channels together; as ChannelGain has them of each.
struct KeptOutMisses {
  double as_written = 0.0, calibrated = 0.0, extended = 0.0;
  double named = std::numeric_limits<double>::quiet_NaN(), found = std::numeric_limits<double>::quiet_NaN();
};

/// What no candidate explains.
struct Unexplained {
  struct Channel {
    std::string name, unit;
    double rms = 0.0;          ///< of the smooth part of the residual
    double times_noise = 0.0;  ///< its squares over what noise would have, in standard deviations of that
  };
  std::vector<Channel> channels;         ///< worst first; those that stand out
  double nats = 0.0;                     ///< what a cause of the right shape would bring at most
  std::optional<std::size_t> statement;  ///< of Diagnosis::statements, that it is: the catalogue has no name for it
  bool fails_held_out = false;           ///< the causes predict kept-out data worse than scatter alone
  double ambient_off_K = 0.0;            ///< where the causes stand beside an ambient so far off its record; 0: they do not
};

struct Diagnosis {
  Verdict verdict = Verdict::kConsistent;
  std::string reason;
  std::vector<Cause> causes;
  Posterior statements;  ///< what is missing, in a grammar that is wider than the catalogue, and how sure that is
  std::optional<Experiment> experiment;
  std::optional<Unexplained> unexplained;
  /// Causes, intervals and gains count what the model misses as noise: it misses far more than noise, whatever is claimed.
  bool weighed_by_model_error = false;
  std::optional<HeatWander>
      wander;            ///< where it is weighed by that: heat that comes and goes in bodies; its readings are moved from
  std::string ended_at;  ///< what was being done when somebody wanted an end; empty: it is complete
  std::string holdout;   ///< how the gain was held out
  std::vector<ChannelGain> gain;
  KeptOutMisses misses;
  std::vector<DataFinding> data;
  int n_candidates = 0;
  SearchResult search;  ///< its claims are the first causes, in their order; behind them numbers that have gone too far
  std::map<std::string, NoiseModel> noise;
  Written written;
  std::vector<Knob> scatter;         ///< what is known roughly: the scenario's own numbers and each run's ambient
  std::vector<std::size_t> moved;    ///< which of these have gone so far that they are causes
  std::vector<Estimate> calibrated;  ///< of these, as fitted with the causes that are written
  Prediction as_written, scatter_alone;
  Prediction extended;  ///< what extended.yaml gives over the whole of all records
};

struct DiagnosisOptions {
  std::set<std::string> without;
  int most_effects = 3;  ///< 0: scatter alone
  /// Error of the twin's mesh over the difference to the other one: 1 / |size ratio² - 1| where errors go with the square of the size.
  double mesh_error_share = 1.0;
  NoiseFloor floor;
};

/// @param coarse    the same machine on a coarser mesh, or null: what its mesh does is no finding
/// @param runs      at least one
/// @param listener  once it wants an end, the diagnosis says what is known so far, and that it is incomplete
[[nodiscard]] Diagnosis diagnose(const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
                                 const DiagnosisOptions& options, const Listener& listener = {});

/// Marks the scenario's own numbers as not written, but for those that have gone so far that they are causes: a file of causes only.
void leave_numbers(Diagnosis& d);

}  // namespace driftwright::diagnosis
