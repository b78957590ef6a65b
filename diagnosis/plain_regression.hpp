#pragma once
// A regression without any knowledge of the machine on the same rows: the least that a model must beat.
//
// A channel is a linear function of the record's other data: speed, its square and whether the spindle turns, each as it
// is and after first-order lags of 5, 20 and 80 min; the ambient after 0, 1 and 4 h; every other recorded column after 0,
// 10 and 60 min; and, on request, the thermometers' readings. Ridge regression; of nine penalties the one that predicts
// left-out data best, each run in turn, or for a single run each eighth.
// Source: Hoerl & Kennard, Technometrics 12 (1970) 55-67; memories of speed: Brecher, Hirsch & Weck, CIRP Annals 53
// (2004) 299-302.

#include "diagnosis/comparison.hpp"

namespace driftwright::diagnosis {

enum class Regressors {
  kDrive,             ///< the drive and the ambient
  kDriveAndReadings,  ///< also readings of thermometers, except those of the channel itself
};

/// @param runs    complete; their readings are regressors on request
/// @param fitted  the same runs, with NaN for readings that are kept out
/// @return for all runs; rows of outputs without a channel, or with no fitted readings, are 0
[[nodiscard]] Prediction plain_regression(const std::vector<MeasuredRun>& runs, const std::vector<MeasuredRun>& fitted,
                                          int n_outputs, Regressors regressors);

}  // namespace driftwright::diagnosis
