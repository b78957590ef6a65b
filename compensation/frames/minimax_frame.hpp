#pragma once
// Fits the frame with the smallest largest error of a table.

#include "compensation/frames/table_frame.hpp"

namespace driftwright::compensation {

struct MinimaxFrame {
  TableFrame frame;             ///< its misfit_m is the largest remaining distance
  double least_misfit_m = 0.0;  ///< lower bound: no frame has a smaller largest distance on these points
};

/// Reweighted least squares after Lawson (1961): the weight of each point grows with its error, until the largest distance
/// is within 1 % of the lower bound that the weights prove, or 300 rounds are done. Never worse than fit_table_frame(), from
/// which it starts.
/// @param points  three or more, as for fit_table_frame()
/// @throws InputError  as fit_table_frame()
[[nodiscard]] MinimaxFrame fit_minimax_frame(std::span<const RingPair> points);

}  // namespace driftwright::compensation
