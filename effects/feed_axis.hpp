#pragma once
// What others need to know of the effect `feed_axis`: its sections, and the axis' error as sums over their temperatures.

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "effects/effect.hpp"
#include "effects/screw_rod.hpp"

namespace driftwright::effects {

/// The screw of an effect `feed_axis`.
[[nodiscard]] ScrewRod screw_rod(const Effect& feed_axis);
/// The lumped nodes of its sections, from the fixed bearing on: NAME_1, NAME_2, ...
[[nodiscard]] std::vector<Body> screw_sections(const Effect& feed_axis);

/// The effect `feed_axis` whose screw has that name, or nullptr.
[[nodiscard]] Effect* feed_axis_of(std::vector<Effect>& effects, const std::string& screw);
/// Names of all screws of a machine.
[[nodiscard]] std::vector<std::string> screw_names(const std::vector<Effect>& effects);

/// The error of the axis at a place of its travel, as sensitivities [m/K] to its sections (axis_error_m_K()).
/// @throws RangeError  with the allowed range, for a place outside the travel
[[nodiscard]] std::vector<std::pair<Body, double>> axis_error_at(const Effect& feed_axis, double position_m);

/// Whether the nut stays within its travel. @param stroke_mm  about the middle, >= 0
[[nodiscard]] bool is_within_travel(const Effect& feed_axis, double middle_mm, double stroke_mm);

/// Whether all that a row says of this effect is in the row: positions that it only reads at that time, without a lag.
/// True of `feed_axis` and `linear_scale`.
[[nodiscard]] bool follows_positions(const Effect& effect);

/// What an effect that follows positions adds to a displacement [m]: sums over mean temperatures, whose weights are cubics
/// of the position within each piece.
struct ErrorAlong {
  std::string displacement, position;  ///< name and column
  std::vector<Body> bodies;
  std::vector<double> ends_mm;                             ///< of the pieces; empty: one piece, wherever the axis is
  std::function<std::vector<double>(double)> weights_m_K;  ///< of the bodies, at a position [mm]
};
/// Of such an effect that reads a recorded position; none: it adds nothing. @throws RangeError  for a screw with `stretch`
[[nodiscard]] std::optional<ErrorAlong> error_along(const Effect& effect);

/// Makes the effect add the error at the nut's present place to a displacement. One displacement a screw.
/// @throws RangeError  without a recorded position, for a second displacement
void read_out_at_nut(Effect& feed_axis, const std::string& displacement);
/// The displacement to which an effect adds it; "": none, or another sort of effect.
[[nodiscard]] std::string read_at_nut(const Effect& effect);

}  // namespace driftwright::effects
