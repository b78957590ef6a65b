#pragma once
// Parts of the session's state as JSON, for the state file. Numbers are restored exactly; one that is not finite is
// stored as null and restored as NaN.

#include "follow/live_rows.hpp"
#include "follow/output_stage.hpp"
#include "follow/row_guard.hpp"
#include "output/json_value.hpp"

namespace driftwright::follow {

using output::Json;

[[nodiscard]] Json numbers_json(const std::vector<double>& numbers);
[[nodiscard]] std::vector<double> numbers_of(const Json& j, const char* key);

[[nodiscard]] Json state_json(const LiveRows::State& state);
[[nodiscard]] LiveRows::State live_run_of(const Json& j);
[[nodiscard]] Json state_json(const OutputStage::State& state);
[[nodiscard]] OutputStage::State output_stage_of(const Json& j);
[[nodiscard]] Json state_json(const RowGuard::State& state);
[[nodiscard]] RowGuard::State row_guard_of(const Json& j);

}  // namespace driftwright::follow
