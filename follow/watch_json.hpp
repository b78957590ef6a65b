#pragma once
// The limits of a watch as JSON: within the model's file, or as a file of its own, which is valid for one model.

#include "follow/watch.hpp"
#include "output/json_value.hpp"

namespace driftwright::follow {

[[nodiscard]] output::Json limits_json(const WatchLimits& limits);
/// @throws InputError  naming the key
[[nodiscard]] WatchLimits limits_of(const output::Json& json);

/// @param model_hash  of the model's file
[[nodiscard]] output::Json watch_json(const WatchLimits& limits, const std::string& model_hash);
/// @throws InputError  naming file and key, for an invalid file, and for limits of another model
[[nodiscard]] WatchLimits read_watch(const std::string& path, const std::string& model_hash);

}  // namespace driftwright::follow
