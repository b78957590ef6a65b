#pragma once
// Doubts about several records: a cause that begins in one record stays in all later ones; a cause that was repaired after
// one was in all earlier ones.

#include <fmt/format.h>

#include <set>

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// One entry of the effect for each of the runs first to end - 1. Numbers that a doubt sets by name are set in all of them.
/// @param end  one past the last run
[[nodiscard]] inline std::vector<Effect> in_runs(const DoubtScene& scene, std::size_t first, std::size_t end,
                                                 const Effect& effect) {
  std::vector<Effect> list;
  for (std::size_t r = first; r < end; ++r) {
    list.push_back(effect);
    list.back().in = scene.runs[r].name;
  }
  return list;
}

/// The same for a run and all later ones.
[[nodiscard]] inline std::vector<Effect> in_this_and_later_runs(const DoubtScene& scene, std::size_t run,
                                                                const Effect& effect) {
  return in_runs(scene, run, scene.runs.size(), effect);
}

/// Adds a doubt that begins at a time in one run; if there are later runs, also a variant in which it stays in all of them
/// from their start on.
/// @param doubt  with a single effect, in that run; its time is set in the first added effect only
inline void add_with_lasting(const DoubtScene& scene, std::size_t run, const Doubt& doubt, std::vector<Doubt>& list) {
  list.push_back(doubt);
  if (run + 1 >= scene.runs.size()) return;
  Doubt lasting = doubt;
  lasting.law += " and all later records";
  lasting.added = in_this_and_later_runs(scene, run, doubt.added.front());
  list.push_back(std::move(lasting));
}

/// Adds a doubt that applies in all runs, and variants of it: in each of several runs alone, from each run but the first on,
/// and up to each run but the last. These describe changes and repairs between two records.
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

/// Adds doubts that begin at a time within a run, for each run in turn: in that run alone, and in it and all later ones.
/// @param doubt   with a single effect whose numbers are set by name, which holds in all runs
/// @param number  name of the begin time
void add_from_a_time_on(const DoubtScene& scene, const Doubt& doubt, const std::string& number, double rarity,
                        std::vector<Doubt>& list);
/// Adds doubts about changes between two records: as add_in_some_runs(), without the variant for all runs.
void add_between_records(const DoubtScene& scene, const Doubt& doubt, std::vector<Doubt>& list);
/// Adds doubts about changes between records and within one: also those of add_from_a_time_on().
void add_changes(const DoubtScene& scene, const Doubt& doubt, std::vector<Doubt>& list);

/// True if a doubt can be limited to some records: it contains no time within a record, and where it applies to some, it is
/// the same in each.
[[nodiscard]] bool can_be_of_some_runs(const Doubt& doubt);
/// The records that it applies to; empty: all.
[[nodiscard]] std::set<std::string> runs_of(const Doubt& doubt);
/// The same doubt for other records, with common numbers. @param runs  in their order; empty: all
[[nodiscard]] Doubt of_runs(const Doubt& doubt, const std::vector<std::string>& runs);

}  // namespace driftwright::effects
