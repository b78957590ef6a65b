#pragma once
// Where an NC program has its axes over time, as columns of a cyclogram.

#include <array>
#include <vector>

#include "base/cyclogram.hpp"
#include "nc/program.hpp"

namespace driftwright {

/// Columns position_x, stroke_x, position_y, ... [mm]: the middle and the length of the range that each axis is in, from
/// each row on. Blocks shorter than `resolution_s` are merged into rows of that length or slightly longer; straight moves
/// that last longer are cut into rows of that length at most.
/// Positions are those of the work offset that the program starts in, less `origin_m`; shifts of the origin by the program
/// do not count.
/// @param resolution_s  >= 0; 0: a row a block
[[nodiscard]] std::vector<Cyclogram::Column> position_columns(const NcProgram& program, double resolution_s,
                                                              const std::array<double, 3>& origin_m);

}  // namespace driftwright
