#pragma once
// The experiment that would distinguish the remaining explanations: a cyclogram of a family, or one with one more
// thermometer. The choice is the one with the most expected information about the statement.

#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

struct Experiment {
  std::string why;
  Cyclogram cyclogram;
  /// Share of the uncertainty of what is open, of quantity, place and course, that its record is expected to remove: a
  /// lower bound of the mutual information (discrimination.hpp) divided by the entropy so far. 0 to 1.
  double decides = 0.0;
  struct Sensor {
    std::string region;
    double difference_K = 0.0;  ///< largest difference in that cyclogram
    double decides = 0.0;       ///< the same share with it
    Cyclogram cyclogram;
  };
  std::optional<Sensor> extra_sensor;
  bool by_sensor = false;  ///< true: the thermometer is proposed; false: only the cyclogram
  /// Number of records simulated, each with an explanation drawn by its probability, with numbers drawn from their
  /// uncertainty, and with noise.
  int n_simulated = 0;
  int n_told = 0;  ///< those after which the true explanation has a probability of kSure
};

/// The cyclogram whose record is expected to tell most of which explanation is true: a cause, its alternatives of any
/// quantity, place or course, and, for a doubtful cause, nothing in its place, with their probabilities. Every cyclogram is
/// also tried with a thermometer at each body without one. If the best cyclogram alone may leave the question open, and
/// such a thermometer halves what it leaves, the thermometer is proposed. An event of one record does not occur in a new
/// one; if all open explanations are events, the proposal is a record of the same cyclogram with one more thermometer. The
/// noise is that of the fitter; a new thermometer has the noise of the median one. The ambient is constant at its mean.
/// @param in_doubt  for each finding, whether it may be absent; empty: none may
/// @return none if no finding has an alternative or is in doubt, or if no cyclogram has a solution
[[nodiscard]] std::optional<Experiment> propose_experiment(const Fitter& fitter, const SearchResult& result,
                                                           const std::vector<char>& in_doubt = {});

}  // namespace driftwright::diagnosis
