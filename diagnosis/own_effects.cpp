#include "diagnosis/own_effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/lists.hpp"

namespace driftwright::diagnosis {
namespace {

using effects::Effect;

bool has_same_values(const Effect& a, const Effect& b) {
  return std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(), same_number);
}

/// Whether an added effect changes a heat, an exchange or the capacity of an effect of the scenario.
bool changes_law_of(const Effect& added, const Effect& own) {
  if (!own.kind->contribute || (added.place_kind != effects::Place::kLaw && !added.kind->change_material)) return false;
  const effects::HeatBalance alone = effects::heat_balance({own});
  const auto is_it = [&](const auto& law) { return law.name == added.place; };
  if (added.place_kind == effects::Place::kLaw)
    return std::any_of(alone.heats.begin(), alone.heats.end(), is_it) ||
           std::any_of(alone.exchanges.begin(), alone.exchanges.end(), is_it);
  const effects::HeatBalance both = effects::heat_balance({own, added});
  return !std::equal(alone.nodes.begin(), alone.nodes.end(), both.nodes.begin(), both.nodes.end(),
                     [](const auto& a, const auto& b) { return a.capacity_J_K == b.capacity_J_K; });
}

}  // namespace

int line_of(const Effect& effect) {
  const auto first = effect.reference_where.find("type");
  return first == effect.reference_where.end() ? 0 : first->second.line;
}

std::string own_effects(const TwinState& written, const std::function<void(TwinState&)>& change) {
  TwinState changed = written;
  change(changed);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < written.size(); ++i) {
    const Effect& own = written[i];
    const bool is_changed = !has_same_values(own, changed[i]) ||
                            std::any_of(changed.begin() + static_cast<std::ptrdiff_t>(written.size()), changed.end(),
                                        [&](const Effect& added) { return changes_law_of(added, own); });
    if (!is_changed) continue;
    names.push_back(fmt::format("{} at {}", own.kind->key, effects::where_of(own)));
    if (const int line = line_of(own); line > 0) names.back() += fmt::format(", line {}", line);
  }
  return fmt::format("{}", fmt::join(names, " and "));
}

}  // namespace driftwright::diagnosis
