#pragma once
// Effects in the user's YAML, for tests of whole systems.

#include <string>
#include <vector>

#include "effects/effect.hpp"
#include "solver/heat_assembly.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::fixtures {

/// The heat balance of a list of effects, one YAML map each.
inline effects::HeatBalance balance_of(const std::vector<std::string>& entries) {
  std::vector<effects::Effect> effects;
  for (const std::string& text : entries) {
    effects.push_back(effects::read_effect(ConfigMap::read_file(write_file("effect_list.yaml", text))));
  }
  return effects::heat_balance(effects);
}

/// A system of lumped nodes only.
inline solver::FullSystem lumped_system(const std::vector<std::string>& entries) {
  return solver::assemble_heat({}, {}, balance_of(entries));
}

/// Index of a flow by its name; fails the test if it does not exist.
inline Eigen::Index flow(const solver::Trajectory& run, const std::string& name) {
  for (std::size_t j = 0; j < run.flows.size(); ++j) {
    if (run.flows[j].name == name) return static_cast<Eigen::Index>(j);
  }
  throw std::logic_error("no flow '" + name + "'");
}

}  // namespace driftwright::fixtures
