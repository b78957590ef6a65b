#include "effects/instrument_groups.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace driftwright::effects {
namespace {

constexpr double kSameOfAll = 2.0;  // nats: several instruments seldom have the same error at once

}  // namespace

std::vector<std::vector<std::string>> instrument_groups(const std::vector<std::string>& names) {
  std::map<std::string, std::vector<std::string>> of_card;
  for (const std::string& name : names) {
    if (const auto end = name.find_last_of("_-./"); end != std::string::npos && end > 0)
      of_card[name.substr(0, end)].push_back(name);
  }
  std::vector<std::vector<std::string>> groups = {names};
  for (auto& [card, of_it] : of_card) groups.push_back(std::move(of_it));
  std::erase_if(groups, [](const auto& g) { return g.size() < 2; });
  if (groups.size() > 1) groups.erase(std::remove(groups.begin() + 1, groups.end(), names), groups.end());
  return groups;
}

void add_in_groups(const std::vector<std::string>& names, const Doubt& doubt, std::vector<Doubt>& list) {
  for (const std::vector<std::string>& group : instrument_groups(names)) {
    Doubt common = doubt;
    common.where = fmt::format("{}", fmt::join(group, ","));
    common.law += ", the same of them all";
    common.rarity += kSameOfAll;
    common.added.clear();
    for (const std::string& name : group) {
      common.added.push_back(doubt.added.front());
      common.added.back().place = name;
    }
    list.push_back(std::move(common));
  }
}

}  // namespace driftwright::effects
