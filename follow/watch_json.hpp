#pragma once
// The limits of a watch as a file, which is valid for one model.

#include "follow/watch.hpp"
#include "output/json_value.hpp"

namespace driftwright::follow {

/// @param model_hash  of the model's file
[[nodiscard]] output::Json watch_json(const WatchLimits& limits, const std::string& model_hash);
/// @throws InputError  naming file and key, for an invalid file, and for limits of another model
[[nodiscard]] WatchLimits read_watch(const std::string& path, const std::string& model_hash);

}  // namespace driftwright::follow
