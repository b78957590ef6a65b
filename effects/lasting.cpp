#include "effects/lasting.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "effects/time_windows.hpp"

namespace driftwright::effects {
namespace {

constexpr double kFirst_s = 1.0;    // earliest begin within a record
constexpr double kLateTrial = 1.5;  // trial relative to that for all records, because it acts only part of the time

/// The effect in each of its records, separately.
std::vector<Effect> in_each(const Doubt& doubt) {
  std::vector<Effect> list;
  for (const Effect& e : doubt.added) {
    if (e.in == doubt.added.front().in) list.push_back(e);
  }
  for (Effect& e : list) e.in = "";
  return list;
}

}  // namespace

void add_from_a_time_on(const DoubtScene& scene, const Doubt& doubt, const std::string& number, double rarity,
                        std::vector<Doubt>& list) {
  for (std::size_t r = 0; r < scene.runs.size(); ++r) {
    const DoubtScene::Run& run = scene.runs[r];
    Doubt late = doubt;
    late.law += " from a time on, in " + run.name;
    late.added[0].in = run.name;
    late.numbers.push_back(doubted_time(
        number, run.length_s, [](std::span<Effect> added, double value) { added[0].from_s = std::max(kFirst_s, value); }));
    late.trial *= kLateTrial;
    late.rarity = rarity;
    late.grid = time_grid(run.length_s, 8);
    add_with_lasting(scene, r, late, list);
  }
}

void add_between_records(const DoubtScene& scene, const Doubt& doubt, std::vector<Doubt>& list) {
  std::vector<Doubt> in_some;
  add_in_some_runs(scene, doubt, in_some);
  list.insert(list.end(), in_some.begin() + 1, in_some.end());
}

void add_changes(const DoubtScene& scene, const Doubt& doubt, std::vector<Doubt>& list) {
  add_between_records(scene, doubt, list);
  add_from_a_time_on(scene, doubt, "time", 0.0, list);
}

std::set<std::string> runs_of(const Doubt& doubt) {
  std::set<std::string> names;
  for (const Effect& e : doubt.added) names.insert(e.in);
  names.erase("");
  return names;
}

bool can_be_of_some_runs(const Doubt& doubt) {
  if (doubt.is_built_in) return false;
  const bool has_time = std::any_of(doubt.numbers.begin(), doubt.numbers.end(), [](const auto& n) { return n.is_time; });
  const bool is_timed = std::any_of(doubt.added.begin(), doubt.added.end(), [](const Effect& e) {
    const auto windows = e.tables.find(kWindows);
    const bool has_windows = windows != e.tables.end() && !windows->second.time_s.empty();
    return e.kind->timing == Timing::kAlways || e.from_s > 0.0 || has_windows;
  });
  const std::size_t n_runs = std::max<std::size_t>(1, runs_of(doubt).size());
  return !has_time && !is_timed && doubt.when.empty() == doubt.added.front().in.empty() &&
         doubt.added.size() == n_runs * in_each(doubt).size();
}

Doubt of_runs(const Doubt& doubt, const std::vector<std::string>& runs) {
  Doubt other = doubt;
  const std::vector<Effect> in_one = in_each(doubt);
  other.when = runs.empty() ? "" : fmt::format("in {}", fmt::join(runs, ", "));
  other.added = runs.empty() ? in_one : std::vector<Effect>{};
  for (const std::string& run : runs) {
    for (Effect e : in_one) {
      e.in = run;
      other.added.push_back(std::move(e));
    }
  }
  for (DoubtedNumber& number : other.numbers) {
    if (!number.set) continue;
    number.set = [set = number.set, n = in_one.size()](std::span<Effect> added, double value) {
      for (std::size_t first = 0; first < added.size(); first += n) set(added.subspan(first, n), value);
    };
  }
  return other;
}

}  // namespace driftwright::effects
