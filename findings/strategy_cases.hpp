#pragma once
// What the tables and pictures of a matrix of strategies ask its cases.

#include <string>

#include "compensation/judging/strategy_matrix.hpp"

namespace driftwright::findings {

[[nodiscard]] inline bool is_intact(const compensation::Case& c) {
  return c.failed.empty();
}

[[nodiscard]] inline bool has_failures(const compensation::StrategyMatrix& m) {
  return m.settings.fails_at.has_value();
}

/// What the model of the strategies with physics lost when it was made linear; null if nothing.
[[nodiscard]] inline const compensation::LinearisedModel* linearised_of(const compensation::StrategyMatrix& m) {
  const std::optional<compensation::Physics>& physics = m.settings.strategies.physics;
  return physics && physics->linearised ? &*physics->linearised : nullptr;
}

[[nodiscard]] inline bool has_failed(const compensation::Case& c) {
  return !is_intact(c);
}

[[nodiscard]] inline std::string run_name(const compensation::JudgedRunOfMachine& r) {
  return r.season.empty() ? r.name : r.name + ", " + r.season;
}

}  // namespace driftwright::findings
