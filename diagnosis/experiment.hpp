#pragma once
// The experiment that would distinguish the remaining explanations: a cyclogram of a family, or one more thermometer,
// chosen by the difference of their predictions.

#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

struct Experiment {
  std::string why;
  Cyclogram cyclogram;
  double discrimination =
      0.0;  ///< least d' of all pairs of explanations after it, reduced by the uncertainty of their numbers
  struct Sensor {
    std::string region;
    double difference_K = 0.0;    ///< largest difference in that cyclogram
    double discrimination = 0.0;  ///< least d' with it
    Cyclogram cyclogram;
  };
  std::optional<Sensor> extra_sensor;
  bool by_sensor = false;  ///< true: the thermometer is proposed; false: only the cyclogram
  /// Number of records simulated with each explanation, with numbers drawn from their uncertainty, and with noise.
  int n_simulated = 0;
  int n_told = 0;  ///< those in which the true explanation led all others by more than the required margin
};

/// The cyclogram with the largest least d' over all pairs of open explanations: a cause and its alternatives, or a
/// doubtful cause and nothing in its place. An event of one record does not occur in a new one; if all open explanations
/// are events, the proposal is a record of the same cyclogram with one more thermometer. The noise is that of the fitter;
/// a new thermometer has the noise of the median one. The ambient is constant at its mean.
/// @param in_doubt  for each finding, whether it may be absent; empty: none may
/// @return none if no finding has an alternative or is in doubt, or if no cyclogram has a solution
[[nodiscard]] std::optional<Experiment> propose_experiment(const Fitter& fitter, const SearchResult& result,
                                                           const std::vector<char>& in_doubt = {});

}  // namespace driftwright::diagnosis
