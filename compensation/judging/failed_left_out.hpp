#pragma once
// What a strategy leaves on left-out parts of its training runs with failed sensors.

#include <optional>
#include <span>

#include "compensation/judging/strategy_matrix.hpp"

namespace driftwright::compensation {

/// The largest residual of a strategy in the hidden rows of folds with one of its sensors failed [um]. The sensor fails at
/// the share `fails_at` of a fold's hidden part of a run. None without failures, a fold or a sensor.
[[nodiscard]] std::optional<double> failed_left_out_um(const MatrixSettings& settings, const FoldedRuns& folds,
                                                       std::span<const FittedInFold> in_folds);

}  // namespace driftwright::compensation
