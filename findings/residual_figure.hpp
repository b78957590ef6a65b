#pragma once
// One channel of one record as a figure: measured, simulated, and simulated with what was found.

#include "output/document.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::findings {

/// A channel of a run.
struct ShownChannel {
  std::size_t run = 0, channel = 0;
  bool operator==(const ShownChannel&) const = default;
};

/// The channel that shows best what a change of the model does: in which the squares of measured minus simulated, in units
/// of the noise, fall most from the scenario as written to `after`. Without `after`, the channel that is missed most.
/// @param after   readings of all runs, or null
/// @param only    names of channels to choose from, where a record has one of them; empty: all
/// @param but     channels that are shown already
/// @return none if the records have no other channel
[[nodiscard]] std::optional<ShownChannel> clearest_channel(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                                           const diagnosis::Prediction* after,
                                                           const std::vector<std::string>& only = {},
                                                           const std::vector<ShownChannel>& but = {});

/// @param after  readings of all runs, or null
/// @param words  the name of these in the legend
[[nodiscard]] output::Plot channel_figure(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                          const ShownChannel& shown, const diagnosis::Prediction* after,
                                          const std::string& words);

/// Readings of a channel in the units of pages: degC, um or urad.
struct ShownScale {
  std::string unit;             ///< of readings
  std::string difference_unit;  ///< of residuals
  double scale = 1.0, zero = 0.0;
};
[[nodiscard]] ShownScale shown_scale(const studies::MeasuredTwin& m, const diagnosis::MeasuredChannel& channel);

}  // namespace driftwright::findings
