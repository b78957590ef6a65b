#pragma once
// The judgement of a strategy as the file of its predictor holds it, under the key `judged` (docs/how-to/validation.md).

#include <nlohmann/json_fwd.hpp>

#include "compensation/judging/strategy_matrix.hpp"

namespace driftwright::compensation {

/// The conditions that all strategies were judged under, then what this one leaves and its verdict. Lengths in um, shares in
/// percent; null: there is no such number. The report has the same keys and values.
[[nodiscard]] nlohmann::ordered_json judgement_json(const StrategyMatrix& matrix, const JudgedStrategy& strategy);

}  // namespace driftwright::compensation
