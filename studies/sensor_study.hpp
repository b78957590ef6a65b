#pragma once
// Ranks and chooses the sensors of records: what `select` shows.

#include <optional>

#include "compensation/predictors/regression_quality.hpp"
#include "compensation/sensors/ranking_stability.hpp"
#include "compensation/sensors/sensor_selection.hpp"
#include "studies/record_study.hpp"

namespace driftwright::studies {

/// The best sensors by another image or quantity.
struct OtherRanking {
  compensation::Image image;
  compensation::Quantity quantity;
  std::vector<std::string> best;
  std::string not_defined;  ///< reason if there is no such ranking; else empty
};

/// The choice of a selector, and the regression on it.
struct ChosenSensors {
  std::string selector;
  compensation::Selection selection;
  compensation::Regression regression;
  compensation::RegressionQuality quality;
  std::string not_possible;  ///< reason if it chose nothing; else empty
};

struct SensorStudy {
  std::string target;
  int n_to_choose = 0;
  compensation::Ranking ranking;
  compensation::RankingStability stability;
  std::vector<OtherRanking> others;
  std::vector<ChosenSensors> chosen;
  std::vector<std::string> warnings;  ///< about records and sensors, one sentence each
};

/// Ranks the candidates of the scenario's study on the records and lets every selector choose.
/// @throws InputError  as read_records() and rank_channels()
[[nodiscard]] SensorStudy study_sensors(const scenarios::Scenario& scenario, const RecordPaths& paths);

}  // namespace driftwright::studies
