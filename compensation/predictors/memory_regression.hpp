#pragma once
// Regressions on thermometers and on the machine's history: earlier temperatures, speeds and running times, as lags.

#include "compensation/predictors/fitted_formulas.hpp"

namespace driftwright::compensation {

/// The columns of such a regression.
enum class Columns {
  kAndDrive,     ///< thermometer readings, and the drive
  kAndMemories,  ///< thermometer readings and lags of each, and the drive
  kModes         ///< principal components of the thermometers, lags of these, and the drive
};

/// Ridge regression on many fixed first-order lags,
///
///     d = b0 + sum_T [ b T + sum_k b_k L_k[T] ] + sum_u [ c u + sum_k c_k M_k[u] ],   u of n, n^2 and 1 while n is not 0,
///
/// T: the thermometers and the ambient, L: lags of 20, 60 and 180 min; n: the drive, M: lags of 2, 5, 10, 20, 40, 80 and 160
/// min. Lags longer than longest_lag_s() are left out. With kModes, T is each of the first `n_modes` principal components of
/// the thermometers in units of their deviations. These are few numbers that describe any row of a warm machine; so levels
/// outside the training data are not computed from differences between nearly equal thermometers. The temperature of a body
/// without a thermometer is a sum of such lags of heat and of its neighbours, and a penalty on columns of unit deviation
/// prefers sums that are smooth in the lag. Only the size of the penalty is chosen: by the mean RMS error of each left-out
/// record, or of each block of a single one (in_blocks()).
///
/// Limits: it cannot know the effect of a speed far above all speeds of the training data, nor what drove the machine before
/// a record began. Speeds start from standstill (DriftModel): a record cut out of a longer one must not begin while the
/// machine is warm from running, or must be predicted together with the rows before it.
/// @param sensors  thermometers, at least one unless there is a drive; @param drive  channel in rpm, or ""
/// @param ambient     channel, or ""; if it is also among the sensors it counts once
/// @param n_modes     for kModes only, from 1 to the number of thermometers - 1
/// @throws InputError  as product_sums(), without any input, for kAndDrive without a drive, and for fewer thermometers than
///                     modes + 1
/// Source: ridge as fit_ridge(); principal components as fit_principal_components(); lags of speed as inputs beside
/// temperatures: Brecher, Hirsch & Weck, CIRP Annals 53 (2004) 299; leaving out a row together with its similar neighbours:
/// Burman, Chow & Nolan, Biometrika 81 (1994) 351.
[[nodiscard]] FittedFormula fit_with_memories(std::span<const Record> records, const std::vector<std::string>& sensors,
                                              const std::string& drive, const std::string& ambient,
                                              const std::string& target, Columns columns = Columns::kAndMemories,
                                              int n_modes = 0);

}  // namespace driftwright::compensation
