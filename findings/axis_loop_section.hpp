#pragma once
// The section of a document about an axis with a pulse injector.

#include "compensation/injector/axis_loop.hpp"
#include "output/document.hpp"
#include "scenarios/reader/read_axis_loop.hpp"

namespace driftwright::findings {

/// Section `axis_loop`: causes of error included one after another, counts, faults, plots.
[[nodiscard]] output::Section axis_loop_section(const scenarios::AxisLoopSettings& settings,
                                                const compensation::AxisLoopResult& run, double tolerance_um,
                                                const std::vector<output::SectionMark>& marks);

}  // namespace driftwright::findings
