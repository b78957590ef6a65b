#pragma once
// The axis behind a pulse injector, for the report, the terminal and summary.json.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "compensation/injector/axis_loop.hpp"
#include "output/html_report.hpp"
#include "scenarios/reader/read_axis_loop.hpp"

namespace driftwright::app {

/// Appends heading, bars of the causes, tables and plots.
void add_axis_loop(output::Report& report, const scenarios::AxisLoopSettings& settings, const compensation::AxisLoopRun& run,
                   double tolerance_um, const std::vector<output::SectionMark>& marks);

/// One line.
[[nodiscard]] std::string axis_loop_line(const scenarios::AxisLoopSettings& settings, const compensation::AxisLoopRun& run);

[[nodiscard]] nlohmann::ordered_json axis_loop_json(const scenarios::AxisLoopSettings& settings,
                                                    const compensation::AxisLoopRun& run);

}  // namespace driftwright::app
