#pragma once
// The experiment that would tell two explanations apart: a cyclogram of a family, chosen by how far they then differ.

#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

struct Experiment {
  std::string why;
  Cyclogram cyclogram;
  double discrimination = 0.0;  ///< d' between the two explanations after the experiment, noise and scatter taken off
  struct Sensor {
    std::string region;
    double difference_K = 0.0;  ///< largest, in the measured cyclograms
  };
  std::optional<Sensor> extra_sensor;
};

/// @param finding  with at least one alternative
[[nodiscard]] std::optional<Experiment> propose_experiment(const Fitter& fitter, const SearchResult& result,
                                                           const Finding& finding);

}  // namespace driftwright::diagnosis
