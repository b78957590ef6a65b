#pragma once
// The section about one simulated cyclogram, for every document that contains one.

#include "base/record_band.hpp"
#include "machine/simulated_run.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// Times of a record in minutes, for plots.
[[nodiscard]] std::vector<double> minutes(const Record& record);

/// The times of speed changes, with the new speed; none if there are more than 40.
[[nodiscard]] std::vector<output::SectionMark> section_marks(const Cyclogram& cyclogram);

/// Gives a series whose y are all values of a channel the interval of the channel, if the band has one.
void add_interval(output::Series& series, const RecordBand* band, const std::string& channel);

/// Channels of a record over time. @param band  intervals of them; null: none
[[nodiscard]] output::Plot channels_plot(const std::string& title, const std::string& y_label, const Record& record,
                                         const std::vector<std::string>& names, const Cyclogram& cyclogram,
                                         const RecordBand* band = nullptr);

/// Displacements, tilts and temperatures over time, eight per plot, and what their band contains.
void add_channel_plots(output::Section& section, const Record& record, const Cyclogram& cyclogram,
                       const RecordBand* band = nullptr);

/// Heat sources and sinks: mean power and heat of each flow across the machine's boundary (`heat_flows`) and within it
/// (`inner_heat_flows`), and the six largest of the former over time.
void add_heat(output::Section& section, const solver::Trajectory& run, const Cyclogram& cyclogram);

/// Violations of the bounds of conduction: each jump's largest overshoot with its place (`overshoots`), and the largest of
/// all in a sentence; nothing without overshoots.
void add_overshoots(output::Section& section, const solver::Trajectory& run, const scenarios::Model& model);

}  // namespace driftwright::findings
