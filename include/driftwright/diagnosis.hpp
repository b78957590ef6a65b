#pragma once
// What measurements say about a machine. Words and numbers are those of diagnosis.json (docs/reference/diagnosis.md).

#include <string>
#include <vector>

namespace driftwright {

/// How `Machine::diagnose` searches.
struct DiagnoseOptions {
  std::vector<std::string> without = {};  ///< keys of effects that are not searched for; each must be one of a candidate
  bool causes_only = false;               ///< leave the scenario's own numbers in the extended scenario as they are
  /// Go on with records that have a blunder (a speed in 1/s, a sign, exchanged channels ...); else they are refused.
  bool as_recorded = false;
};

/// A number with its 95 % interval.
struct Estimate {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;
};

/// One cause that the measurements suggest.
struct Cause {
  std::string effect;    ///< key of the catalogue
  std::string where;     ///< region, sensor or channel
  std::string law;       ///< in words
  std::string standing;  ///< suspected, ambiguous, named
  std::vector<Estimate> parameters;
  double log_evidence_gain = 0.0;   ///< natural logarithm of the Bayes factor
  bool is_written = true;           ///< whether the extended scenario contains it
  std::string why_not_written;      ///< if it does not: the reason, as a clause
  std::vector<Cause> alternatives;  ///< other causes that the records cannot distinguish from it
};

/// RMS of the residual of one channel. NaN where no row could be judged.
struct ChannelGain {
  std::string name, unit;
  /// On rows that were kept out of the fit: with the scenario as it is, with its numbers fitted, and with the extended
  /// scenario.
  double rmse_before = 0.0, rmse_calibrated = 0.0, rmse_after = 0.0, noise_floor = 0.0;
  /// Over all rows of all records: with the scenario as it is, and with the extended scenario as read back.
  double rmse_all_before = 0.0, rmse_written = 0.0;
};

/// The result of a diagnosis.
struct Diagnosis {
  std::string verdict;  ///< consistent, suspected, named, ambiguous, unexplained, insufficient_data
  std::string reason;   ///< one sentence
  std::vector<Cause> causes;
  std::vector<Estimate> calibrated;  ///< the scenario's own numbers, as fitted
  std::string holdout;               ///< how rows were kept out
  std::vector<ChannelGain> gain;
  std::string extended_scenario;         ///< what the program writes, with absolute paths; empty if it cannot be read back
  std::vector<std::string> not_written;  ///< in that case, the reason
};

}  // namespace driftwright
