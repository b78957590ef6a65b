#pragma once
// What measurements say about a machine. Words and numbers are those of diagnosis.json (docs/reference/diagnosis.md).

#include <string>
#include <vector>

namespace driftwright {

struct DiagnoseOptions {
  std::vector<std::string> without = {};  ///< keys of effects that are not looked for
  bool causes_only = false;               ///< leave the scenario's own numbers in the extended scenario as they are
};

/// A number with its 95 % interval.
struct Estimate {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;
};

struct Cause {
  std::string effect;    ///< key of the catalogue
  std::string where;     ///< region, sensor or channel
  std::string law;       ///< in words
  std::string standing;  ///< suspected, ambiguous, named
  std::vector<Estimate> parameters;
  double log_evidence_gain = 0.0;   ///< logarithm of the Bayes factor, natural
  bool is_written = true;           ///< whether the extended scenario has it
  std::string why_not_written;      ///< where it has not, a clause
  std::vector<Cause> alternatives;  ///< what the records cannot tell from it
};

/// What is left of a channel, RMS: as the scenario is, with its numbers fitted, extended; on rows that were kept out; NaN where none could judge.
struct ChannelGain {
  std::string name, unit;
  double rmse_before = 0.0, rmse_calibrated = 0.0, rmse_after = 0.0, noise_floor = 0.0;
};

struct Diagnosis {
  std::string verdict;  ///< consistent, suspected, named, ambiguous, unexplained, insufficient_data
  std::string reason;   ///< one sentence
  std::vector<Cause> causes;
  std::vector<Estimate> calibrated;  ///< the scenario's own numbers, as fitted
  std::string holdout;               ///< how rows were kept out
  std::vector<ChannelGain> gain;
  std::string extended_scenario;         ///< text of a scenario with what was found written in
  std::vector<std::string> not_written;  ///< what of it could not be, and why
};

}  // namespace driftwright
