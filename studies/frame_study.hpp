#pragma once
// Predictors that correct a table's frame, compared with the ring measurement: what `compensate --through frame` shows.

#include "studies/table_study.hpp"

namespace driftwright::studies {

inline const std::vector<std::string> kFrameModels = {"modes", "observer", "regression"};

struct FrameStudy {
  std::string predictor = {};       ///< in words
  std::vector<double> time_s = {};  ///< of the judged rows
  std::vector<TableStrategy> corrections =
      {};  ///< none, rings, the predictor, both; each repeated with other noise and another scattered model
};

/// @param model  one of kFrameModels
/// @throws InputError  if the model needs a linear reduced machine and there is none
[[nodiscard]] FrameStudy correct_through_frame(const scenarios::Scenario& scenario, const std::string& model,
                                               const Listener& listener);

}  // namespace driftwright::studies
