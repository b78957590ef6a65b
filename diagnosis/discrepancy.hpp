#pragma once
// What a scenario may miss of a channel, whatever the cause: terms of drive and ambient behind lags, and of a record's start.
//
//     d_c(t) = sum_k a_k x_k(t),   tau_k dx_k/dt = u - x_k,   a_k ~ N(0, rms_c^2), x_k of unit root mean square over all rows, rms_c: what the scenario as written misses the channel by
//
// u: the spindle on, the power 5/3 of its speed, cutting, each recorded column, the ambient less its first value; and exp(-t / tau_k) of each record. A number that does what such terms do is told
// from them by what was known of it alone, so that it does not take up what is wrong elsewhere, and its interval says so.
// Source: Kennedy & O'Hagan, J. R. Stat. Soc. B 63 (2001) 425-464: calibration beside a discrepancy; Brynjarsdottir & O'Hagan, Inverse Problems 30 (2014) 114007: what its prior must say.

#include "diagnosis/output_error.hpp"

namespace driftwright::diagnosis {

/// Linear columns for a Fitter. @param errors  what each channel is missed by
[[nodiscard]] std::vector<Prediction> discrepancy_columns(const std::vector<MeasuredRun>& runs, Eigen::Index n_outputs,
                                                          const std::map<std::string, OutputError>& errors);

}  // namespace driftwright::diagnosis
