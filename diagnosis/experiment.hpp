#pragma once
// The experiment that would tell explanations apart: a cyclogram of a family or one more thermometer, chosen by how far they then differ.

#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

struct Experiment {
  std::string why;
  Cyclogram cyclogram;
  double discrimination =
      0.0;  ///< least d' of the explanations two by two after it; what is not known of their numbers is taken off
  struct Sensor {
    std::string region;
    double difference_K = 0.0;    ///< largest, in that cyclogram
    double discrimination = 0.0;  ///< least d' with it
    Cyclogram cyclogram;
  };
  std::optional<Sensor> extra_sensor;
  bool by_sensor = false;  ///< the thermometer is what is proposed; else the cyclogram alone
  /// Records simulated under each explanation, its numbers drawn from what is known of them, noise drawn as well.
  int n_simulated = 0;
  int n_told = 0;  ///< of these: the one they were made with came out ahead of the others by more than they may differ
};

/// The cyclogram with the largest least d' over all pairs that the findings leave open: a cause and its alternatives, one that is in doubt and nothing in its place.
/// What happened in one record only does nothing
/// in a new one; where all that is open did so, a record of that cyclogram with one more thermometer is what is left.
/// Noise is the fitter's, a further thermometer's that of the median one. The ambient stands at its mean.
/// @param in_doubt  per finding, whether it may be none; empty: none is
/// @return none where no finding has an alternative or is in doubt, or no cyclogram has a solution
[[nodiscard]] std::optional<Experiment> propose_experiment(const Fitter& fitter, const SearchResult& result,
                                                           const std::vector<char>& in_doubt = {});

}  // namespace driftwright::diagnosis
