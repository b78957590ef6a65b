#pragma once
// A regression on thermometers and on what a machine remembers: where it was warm, how fast and whether it turned, how warm its ambient was.

#include "compensation/predictors/fitted_formulas.hpp"

namespace driftwright::compensation {

/// Ridge regression on many fixed first-order lags,
///
///     d = b0 + sum_T [ b T + sum_k b_k L_k[T] ] + sum_u [ c u + sum_k c_k M_k[u] ],   u of n, n^2 and 1 while n is not 0,
///
/// T of the thermometers and the ambient, L behind 20, 60 and 180 min; n the drive, M behind 2, 5, 10, 20, 40, 80 and 160 min. A body without
/// a thermometer follows heat and its neighbours in sums of such lags, and a penalty on columns of unit deviation prefers the sums that
/// are smooth in the lag. It weighs three times as much on what is remembered, and on the drive itself, as on a thermometer's reading. Its
/// size is the only thing that is chosen: the one with the smallest RMS error on data left out, as a mean over what is left out: each
/// record in turn, or, of a single record, an eighth of its rows that lie together, at 22 places.
///
/// What it cannot know: what a speed does that is far above all that it was fitted on, and what drove the machine before a record
/// began. Speeds start from standstill (DriftModel): a record that is cut out of a longer one must not begin while the machine is warm from
/// turning, or is to be predicted with the rows before it.
/// @param sensors  thermometers, at least one unless there is a drive; @param drive  channel in rpm, or ""
/// @param ambient     channel, or "": one that is among the sensors, too, counts once
/// @throws InputError  as product_sums(), without any input, and for a single record with fewer than 48 complete rows
/// Source: ridge as fit_ridge(); lags of speed as inputs beside temperatures: Brecher, Hirsch & Weck, CIRP Annals 53 (2004) 299; leaving out
/// a row's neighbours with it, where they are alike: Burman, Chow & Nolan, Biometrika 81 (1994) 351.
[[nodiscard]] FittedFormula fit_with_memories(std::span<const Record> records, const std::vector<std::string>& sensors,
                                              const std::string& drive, const std::string& ambient,
                                              const std::string& target);

}  // namespace driftwright::compensation
