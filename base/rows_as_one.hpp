#pragma once
// How many rows of an autocorrelated series carry as much information as one independent row.

#include <Eigen/Core>
#include <span>

namespace driftwright {

/// 1 + 2 × sum of the autocorrelations over the lag in rows, of all series together, about zero: an offset that is equal in
/// all rows counts as one observation. The sum ends where the sum of two neighbouring correlations is no longer positive.
/// The result lies between 1 and the number of readings. @param series NaN where there is no reading
/// Source: Geyer, Statistical Science 7 (1992) 473-483.
[[nodiscard]] double rows_as_one(std::span<const Eigen::VectorXd> series);

}  // namespace driftwright
