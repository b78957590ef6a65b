#pragma once
// Words and pictures about one simulated cyclogram, for every report that shows one.

#include "app/results.hpp"
#include "output/html_report.hpp"

namespace driftwright::app {

/// Times of a record in minutes, for plots.
[[nodiscard]] std::vector<double> minutes(const Record& record);

/// Where the speed changes, with what it changes to; none where it changes more than 40 times.
[[nodiscard]] std::vector<output::SectionMark> section_marks(const Cyclogram& cyclogram);

/// Channels of a record over time.
[[nodiscard]] output::Plot channels_plot(const std::string& title, const std::string& y_label, const Record& record,
                                         const std::vector<std::string>& names, const Cyclogram& cyclogram);

/// Displacements, tilts and temperatures over time, eight in a plot.
void add_channel_plots(output::Report& report, const Record& record, const Cyclogram& cyclogram);

/// Who heats, who cools: mean power and heat of each flow across the machine's boundary.
[[nodiscard]] output::Table heat_table(const solver::Trajectory& run);
/// The same of the flows within it.
[[nodiscard]] output::Table inner_heat_table(const solver::Trajectory& run);
/// The same over time: the six largest flows across the boundary, and what is stored.
[[nodiscard]] output::Plot heat_plot(const solver::Trajectory& run, const Cyclogram& cyclogram);

/// Where temperatures left the bounds of conduction: each jump's largest overshoot with its region; empty rows for none.
[[nodiscard]] output::Table overshoot_table(const solver::Trajectory& run, const scenarios::Model& model);
/// The largest of all, in a line; "" for none.
[[nodiscard]] std::string overshoot_text(const solver::Trajectory& run, const scenarios::Model& model);

/// The report of `simulate`: each cyclogram's channels, figures of ISO 230-3, heat flows and overshoots.
[[nodiscard]] output::Report simulation_report(const scenarios::Scenario& scenario, const scenarios::Model& model,
                                               const std::vector<const Cyclogram*>& cyclograms,
                                               const std::vector<scenarios::SimulatedRun>& runs,
                                               const output::Provenance& made_by);

}  // namespace driftwright::app
