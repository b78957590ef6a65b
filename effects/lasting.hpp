#pragma once
// Causes of more than one record: what begins in one holds in all that follow it; what was mended behind one held in all up to it.

#include <fmt/format.h>

#include <set>

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// The effect in each of some runs, an entry each; numbers that a doubt sets by name are set in all of them.
/// @param end  behind the last one
[[nodiscard]] inline std::vector<Effect> in_runs(const DoubtScene& scene, std::size_t first, std::size_t end,
                                                 const Effect& effect) {
  std::vector<Effect> list;
  for (std::size_t r = first; r < end; ++r) {
    list.push_back(effect);
    list.back().in = scene.runs[r].name;
  }
  return list;
}

/// In a run and in each later one.
[[nodiscard]] inline std::vector<Effect> in_this_and_later_runs(const DoubtScene& scene, std::size_t run,
                                                                const Effect& effect) {
  return in_runs(scene, run, scene.runs.size(), effect);
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

/// A doubt that holds in all runs, and the same in each of several alone, from each but the first one on and up to each but the last one: what was
/// changed between two records, or mended.
/// @param doubt  with a single effect whose numbers are set by name
inline void add_in_some_runs(const DoubtScene& scene, const Doubt& doubt, std::vector<Doubt>& list) {
  list.push_back(doubt);
  const std::size_t n = scene.runs.size();
  for (std::size_t run = 0; run < n && n > 1; ++run) {
    Doubt once = doubt;
    once.when = "in " + scene.runs[run].name;
    once.added.front().in = scene.runs[run].name;
    list.push_back(std::move(once));
    if (run == 0 || run + 1 == n) continue;
    Doubt lasting = doubt;
    lasting.when = fmt::format("from {} on", scene.runs[run].name);
    lasting.added = in_this_and_later_runs(scene, run, doubt.added.front());
    list.push_back(std::move(lasting));
    Doubt mended = doubt;
    mended.when = fmt::format("up to {}", scene.runs[run].name);
    mended.added = in_runs(scene, 0, run + 1, doubt.added.front());
    list.push_back(std::move(mended));
  }
}

/// A doubt that begins at a time in one run, in that one alone and in all later ones, each run in turn.
/// @param doubt   with a single effect whose numbers are set by name, which holds in all runs
/// @param number  what its time is called
void add_from_a_time_on(const DoubtScene& scene, const Doubt& doubt, const std::string& number, double rarity,
                        std::vector<Doubt>& list);
/// What was changed between two records: as add_in_some_runs(), without what holds in all of them.
void add_between_records(const DoubtScene& scene, const Doubt& doubt, std::vector<Doubt>& list);
/// And within one: as add_from_a_time_on().
void add_changes(const DoubtScene& scene, const Doubt& doubt, std::vector<Doubt>& list);

/// Whether a doubt can be said of some records alone: it tells of no time within one, and where it holds in some it holds alike in each.
[[nodiscard]] bool can_be_of_some_runs(const Doubt& doubt);
/// The records that it holds in; empty: all.
[[nodiscard]] std::set<std::string> runs_of(const Doubt& doubt);
/// The same doubt of other records, its numbers alike in each. @param runs  in their order; empty: all
[[nodiscard]] Doubt of_runs(const Doubt& doubt, const std::vector<std::string>& runs);

}  // namespace driftwright::effects
