#pragma once
// A cause on the page of a diagnosis: what is different, what to look at, a figure, how sure, what else it could be; and its
// statistics, folded.

#include "findings/residual_figure.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// The most certain cause: the first with the strongest standing. @pre there is one
[[nodiscard]] std::size_t lead_cause(const diagnosis::Diagnosis& d);
/// The channel of the surest cause in which all that was found shows best; none if there is nothing to show.
[[nodiscard]] std::optional<ShownChannel> channel_of_lead(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d);
/// Readings with the causes that were found; null if there are none of all runs.
[[nodiscard]] const diagnosis::Prediction* with_causes(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d);
/// Their name in legends.
[[nodiscard]] std::string with_causes_text(const diagnosis::Diagnosis& d);

/// The alternatives of a cause with their odds: "contact at a,b (12 %) and 2 others"; "" without.
[[nodiscard]] std::string alternatives_text(const diagnosis::Cause& cause, std::size_t most);

/// One section for each of the first causes, for people only. Of several causes each has a figure of the channel in which it
/// shows most: measured, simulated with all that was found but this cause, and with this cause too. So the distance of the
/// two curves is this cause, and the last one is the mended machine. A single cause has the figure at the top of the page.
[[nodiscard]] output::Section causes_section(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d);
/// Evidence, odds and searches made again, of all causes: folded.
[[nodiscard]] output::Section cause_statistics(const diagnosis::Diagnosis& d);

}  // namespace driftwright::findings
