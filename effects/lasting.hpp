#pragma once
// Causes that last: what begins in one record holds in all that follow it.

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// The effect in a run and in each later one, an entry each; numbers that a doubt sets by name are set in all of them.
[[nodiscard]] inline std::vector<Effect> in_this_and_later_runs(const DoubtScene& scene, std::size_t run,
                                                                const Effect& effect) {
  std::vector<Effect> list;
  for (std::size_t r = run; r < scene.runs.size(); ++r) {
    list.push_back(effect);
    list.back().in = scene.runs[r].name;
  }
  return list;
}

/// A doubt that begins at a time in one run, and the same for all later runs from their start on where there are any: one variant more.
/// @param doubt  with a single effect, in that run, whose time is set in the first one added alone
inline void add_with_lasting(const DoubtScene& scene, std::size_t run, const Doubt& doubt, std::vector<Doubt>& list) {
  list.push_back(doubt);
  if (run + 1 >= scene.runs.size()) return;
  Doubt lasting = doubt;
  lasting.law += " and all later records";
  lasting.added = in_this_and_later_runs(scene, run, doubt.added.front());
  list.push_back(std::move(lasting));
}

}  // namespace driftwright::effects
