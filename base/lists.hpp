#pragma once
// Small questions that lists of names and numbers answer.

#include <algorithm>
#include <string>
#include <vector>

namespace driftwright {

/// The `name` of each entry, in their order.
template <class Entries>
[[nodiscard]] std::vector<std::string> names_of(const Entries& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.push_back(entry.name);
  return names;
}

template <class Value>
[[nodiscard]] bool is_in(const std::vector<Value>& list, const Value& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace driftwright
