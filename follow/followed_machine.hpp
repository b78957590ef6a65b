#pragma once
// The machine of a scenario on a stream, driven by speed, ambient and positions of feed axes: the same drift as `predict`,
// for all its displacements.

#include <memory>

#include "base/listener.hpp"
#include "follow/followed_predictor.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::follow {

/// Opens the model that predictions run on.
/// @throws InputError  for a machine that a stream does not describe fully: thermostats, effects that change recorded
/// drives or displacements (`learned`, `feed_axis` and `linear_scale` excepted), other laws of recorded columns, laws that
/// hold for a part of a run
[[nodiscard]] std::unique_ptr<Followed> followed_machine(const scenarios::Scenario& scenario, const FollowOptions& options,
                                                         const Listener& listener);

}  // namespace driftwright::follow
