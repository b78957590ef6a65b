#pragma once
// A cause on the page of a diagnosis: what is different, what to look at, a figure, how sure, what else it could be; and its
// statistics, folded.

#include "findings/residual_figure.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// The most certain cause: the first with the strongest standing. @pre there is one
[[nodiscard]] std::size_t lead_cause(const diagnosis::Diagnosis& d);
/// The channel that shows best what a cause does; none if there is nothing to show.
[[nodiscard]] std::optional<ShownChannel> channel_of_cause(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                                           std::size_t cause, const std::vector<ShownChannel>& but = {});
/// Readings with the causes that were found; null if there are none of all runs.
[[nodiscard]] const diagnosis::Prediction* with_causes(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d);
/// Their name in legends.
[[nodiscard]] std::string with_causes_text(const diagnosis::Diagnosis& d);

/// The alternatives of a cause with their odds: "contact at a,b (12 %) and 2 others"; "" without.
[[nodiscard]] std::string alternatives_text(const diagnosis::Cause& cause, std::size_t most);

/// One section for each of the first causes, for people only. @param shown  the figure at the top of the page
[[nodiscard]] output::Section causes_section(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                             const std::optional<ShownChannel>& shown);
/// Evidence, odds and searches made again, of all causes: folded.
[[nodiscard]] output::Section cause_statistics(const diagnosis::Diagnosis& d);

}  // namespace driftwright::findings
