#pragma once
// The frame that leaves the least of a table's largest error.

#include "compensation/frames/table_frame.hpp"

namespace driftwright::compensation {

struct MinimaxFrame {
  TableFrame frame;             ///< its misfit_m is the largest distance left
  double least_misfit_m = 0.0;  ///< no frame leaves less anywhere on these points
};

/// Reweighted least squares after Lawson (1961): each point weighs in as it is missed, until the largest distance is within 1 % of what
/// the weights prove to be the least, or 300 rounds are over. Never worse than fit_table_frame(), from which it starts.
/// @param points  three or more, as for fit_table_frame()
/// @throws InputError  as fit_table_frame()
[[nodiscard]] MinimaxFrame fit_minimax_frame(std::span<const RingPair> points);

}  // namespace driftwright::compensation
