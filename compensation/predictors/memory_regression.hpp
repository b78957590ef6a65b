#pragma once
// Regressions on thermometers and on what a machine remembers: where it was warm, how fast and whether it turned.

#include "compensation/predictors/fitted_formulas.hpp"

namespace driftwright::compensation {

/// What the columns of such a regression are made of.
enum class Columns {
  kAndDrive,     ///< thermometers as they read, and the drive
  kAndMemories,  ///< thermometers and lags of each, and the drive
  kModes         ///< what thermometers have in common, lags of that, and the drive
};

/// Ridge regression on many fixed first-order lags,
///
///     d = b0 + sum_T [ b T + sum_k b_k L_k[T] ] + sum_u [ c u + sum_k c_k M_k[u] ],   u of n, n^2 and 1 while n is not 0,
///
/// T of the thermometers and the ambient, L behind 20, 60 and 180 min; n the drive, M behind 2, 5, 10, 20, 40, 80 and 160 min. Lags longer than
/// longest_lag_s() are left out. Of kModes, T is each of the first `n_modes` principal components of the thermometers in units of their
/// deviations: few numbers that any row of a warm machine is made of, so that levels which were never fitted are not made up of differences
/// between thermometers that are nearly alike. A body without a thermometer follows heat and its neighbours in sums of such lags, and a
/// penalty on columns of unit deviation prefers the sums that are smooth in the lag. Its size is the only thing that is chosen: by the mean RMS error
/// of each record left out, or of each block of a single one (in_blocks()).
///
/// What it cannot know: what a speed does that is far above all that it was fitted on, and what drove the machine before a record
/// began. Speeds start from standstill (DriftModel): a record that is cut out of a longer one must not begin while the machine is warm from
/// turning, or is to be predicted with the rows before it.
/// @param sensors  thermometers, at least one unless there is a drive; @param drive  channel in rpm, or ""
/// @param ambient     channel, or "": one that is among the sensors, too, counts once
/// @param n_modes     of kModes alone, 1 to one less than thermometers
/// @throws InputError  as product_sums(), without any input, for kAndDrive without a drive, and for fewer thermometers than modes + 1
/// Source: ridge as fit_ridge(); principal components as fit_principal_components(); lags of speed as inputs beside temperatures: Brecher, Hirsch &
/// Weck, CIRP Annals 53 (2004) 299; leaving out a row's neighbours with it, where they are alike: Burman, Chow & Nolan, Biometrika 81 (1994) 351.
[[nodiscard]] FittedFormula fit_with_memories(std::span<const Record> records, const std::vector<std::string>& sensors,
                                              const std::string& drive, const std::string& ambient,
                                              const std::string& target, Columns columns = Columns::kAndMemories,
                                              int n_modes = 0);

}  // namespace driftwright::compensation
