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
/// of the noise, fall most from `before` to `after`. Without `after`, the channel that is missed most.
/// @param before, after  readings of all runs; `after` may be null
/// @param only  names of channels to choose from, where a record has one of them; empty: all
/// @return none if there are no such readings
[[nodiscard]] std::optional<ShownChannel> clearest_channel(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                                           const diagnosis::Prediction& before,
                                                           const diagnosis::Prediction* after,
                                                           const std::vector<std::string>& only = {});

/// A simulated curve: its name in the legend, and readings of all runs.
struct ShownCurve {
  std::string label;
  const diagnosis::Prediction* readings = nullptr;
};
/// "nose in monday", for titles.
[[nodiscard]] std::string channel_words(const studies::MeasuredTwin& m, const ShownChannel& shown);
/// The channel as measured, and simulated curves of it.
[[nodiscard]] output::Plot channel_figure(const studies::MeasuredTwin& m, const ShownChannel& shown, std::string title,
                                          const std::vector<ShownCurve>& simulated);

/// Readings of a channel in the units of pages: degC, um or urad.
struct ShownScale {
  std::string unit;             ///< of readings
  std::string difference_unit;  ///< of residuals
  double scale = 1.0, zero = 0.0;
};
[[nodiscard]] ShownScale shown_scale(const studies::MeasuredTwin& m, const diagnosis::MeasuredChannel& channel);

}  // namespace driftwright::findings
