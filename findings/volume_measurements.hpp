#pragma once
// R-test, ball-bar and the place of a rotary axis as sections and tables of the document of a work volume.

#include "output/document.hpp"
#include "studies/work_volume.hpp"

namespace driftwright::findings {

/// "C" of the axis c.
[[nodiscard]] std::string axis_letter(const scenarios::MovingAxis& axis);
/// The CSV of a table of one axis, whose columns other axes do not have: "tables/axis_c_location.csv".
[[nodiscard]] std::string own_csv(const scenarios::MovingAxis& axis, const std::string& table);
[[nodiscard]] output::Column urad_column(const std::string& key, const std::string& title);

/// Where the axis of rotation is at each time (XOC, YOC, AOC, BOC of ISO 230-7), fitted to the points of a line along it.
/// Nothing of an axis that moves neither the tool nor the work, and where the positions do not tell.
void add_axis_location(output::Section& section, const studies::WorkVolume& volume,
                       const std::vector<const studies::VolumePoint*>& line, const scenarios::VolumeSettings& settings,
                       const std::vector<scenarios::MovingAxis>& axes, std::size_t axis);

/// Readings, fit and picture; nothing of a measurement that was not asked for.
void add_measurements(output::Section& body, const studies::WorkVolume& volume, const scenarios::VolumeSettings& settings,
                      const std::vector<scenarios::MovingAxis>& axes);

}  // namespace driftwright::findings
