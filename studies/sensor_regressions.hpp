#pragma once
// Regressions of each displacement on the best-ranked thermometers: the correction of `run`, and of the page of `view`.

#include "compensation/predictors/regression.hpp"
#include "compensation/sensors/grey_relational.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

struct SensorRegressions {
  compensation::Ranking ranking = {};                        ///< of the thermometers against the study's target
  std::vector<compensation::Regression> regressions = {};    ///< on the best sensors, one per displacement
  std::vector<compensation::Regression> single_sensor = {};  ///< on the best one only: what temperature alone achieves
};

/// Fits on readings rounded to the study's instrument resolution. @param training  records, at least one
[[nodiscard]] SensorRegressions fit_on_best_sensors(std::vector<Record> training, const scenarios::Study& study,
                                                    const std::vector<std::string>& displacements);

}  // namespace driftwright::studies
