#pragma once
// The pictures of a matrix of strategies.

#include <optional>

#include "compensation/judging/strategy_matrix.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// Families x seasons; the runs themselves if there is one family without seasons, as with records.
[[nodiscard]] output::Picture intact_map(const compensation::StrategyMatrix& matrix);
/// Families x ways of sensor failure, the worst of all sensors.
[[nodiscard]] std::optional<output::Picture> failed_map(const compensation::StrategyMatrix& matrix);
/// The drift of the run that is hardest for few sensors, and what strategies predict of it.
[[nodiscard]] std::optional<output::Plot> hardest_course(const compensation::StrategyMatrix& matrix);
[[nodiscard]] output::Bars left_bars(const compensation::StrategyMatrix& matrix);

}  // namespace driftwright::findings
