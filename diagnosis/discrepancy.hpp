#pragma once
// A flexible error of a channel, whatever its cause: terms of drive and ambient after lags, and of a record's start.
//
//     d_c(t) = sum_k a_k x_k(t),   tau_k dx_k/dt = u - x_k,   a_k ~ N(0, rms_c^2)
//
// u: the spindle on, its speed to the power 5/3, cutting, each recorded column, the ambient minus its first value; and
// exp(-t / tau_k) of each record. x_k has unit root mean square over all rows; rms_c is what the scenario as written misses
// the channel by. A number with the same effect as such terms is distinguished from them only by its
// prior, so that it does not absorb other errors, and its interval shows that. Source: Kennedy & O'Hagan, J. R. Stat.
// Soc. B 63 (2001) 425-464: calibration with a discrepancy; Brynjarsdottir & O'Hagan, Inverse Problems 30 (2014) 114007:
// requirements on its prior.

#include "diagnosis/output_error.hpp"

namespace driftwright::diagnosis {

/// Linear columns for a Fitter. @param errors  the error of each channel
[[nodiscard]] std::vector<Prediction> discrepancy_columns(const std::vector<MeasuredRun>& runs, Eigen::Index n_outputs,
                                                          const std::map<std::string, OutputError>& errors);

}  // namespace driftwright::diagnosis
