#pragma once
// Small questions that lists of names and numbers answer.

#include <algorithm>
#include <cmath>
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

/// Where the value is first in the list; -1: nowhere.
template <class Value>
[[nodiscard]] int index_of(const std::vector<Value>& list, const Value& value) {
  const auto hit = std::find(list.begin(), list.end(), value);
  return hit == list.end() ? -1 : static_cast<int>(hit - list.begin());
}

/// Whether two numbers are equal, or both are none (NaN).
[[nodiscard]] inline bool same_number(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace driftwright
