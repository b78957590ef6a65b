#pragma once
// How many rows of series that follow themselves are worth one.

#include <Eigen/Core>
#include <span>

namespace driftwright {

/// 1 + 2 sum of the correlations of rows so many apart, of all series together, about zero: what is off by the same in all rows is told once. The sum ends where two neighbouring
/// correlations are no longer positive together. Between 1 and the number of readings. @param series  NaN where there is no reading
/// Source: Geyer, Statistical Science 7 (1992) 473-483.
[[nodiscard]] double rows_as_one(std::span<const Eigen::VectorXd> series);

}  // namespace driftwright
