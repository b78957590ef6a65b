#pragma once
// Predictors that drive a table's frame, beside the ring measurement: what `compensate --through frame` shows.

#include "studies/table_study.hpp"

namespace driftwright::studies {

inline const std::vector<std::string> kFrameModels = {"modes", "observer", "regression"};

struct FrameStudy {
  std::string predictor = {};       ///< in words
  std::vector<double> time_s = {};  ///< of the judged rows
  std::vector<TableStrategy> corrections =
      {};  ///< none, rings, the predictor, both; each repeated with other noise and another wrong model
};

/// @param model  one of kFrameModels
/// @throws InputError  where the model needs a linear reduced one
[[nodiscard]] FrameStudy correct_through_frame(const scenarios::Scenario& scenario, const std::string& model,
                                               const Listener& listener);

}  // namespace driftwright::studies
