#pragma once
// What a regression that knows nothing of the machine makes of the same rows: the least that a model has to beat.
//
// A channel is a linear function of what else the record has: speed, its square and whether it turns, each as it is and behind first-order lags of
// 5, 20 and 80 min; the ambient behind 0, 1 and 4 h; every other recorded column behind 0, 10 and 60 min; and, where asked for, the thermometers' readings.
// Ridge regression; its penalty is the one of nine that predicts best what is left out, each run in turn, of a single one its eighths.
// Source: Hoerl & Kennard, Technometrics 12 (1970) 55-67; memories of speed: Brecher, Hirsch & Weck, CIRP Annals 53 (2004) 299-302.

#include "diagnosis/comparison.hpp"

namespace driftwright::diagnosis {

enum class Regressors {
  kDrive,             ///< what drove the machine, and the ambient
  kDriveAndReadings,  ///< and readings of thermometers, that of the channel itself left out
};

/// @param runs    whole; readings are regressors where they are asked for
/// @param fitted  the same runs, readings that are kept out NaN
/// @return of all runs; rows of outputs that are no channel, or one without fitted readings, are 0
[[nodiscard]] Prediction plain_regression(const std::vector<MeasuredRun>& runs, const std::vector<MeasuredRun>& fitted,
                                          int n_outputs, Regressors regressors);

}  // namespace driftwright::diagnosis
