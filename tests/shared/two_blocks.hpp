#pragma once
// A small machine of two parts that several tests reduce: it has a heat source, films and a joint.

#include "solver/heat_assembly.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::fixtures {

/// Block a is heated and has a film, both growing with speed; block b is cooled.
inline effects::HeatBalance two_blocks_balance() {
  effects::HeatBalance balance;
  balance.heats.push_back(
      {"bearing", effects::region("a"), [](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; }});
  balance.exchanges.push_back(effects::make_film(
      "side", "a.y1", [](const effects::Inputs& u) { return 5.0 + 0.02 * u.drive.speed_rpm; }, "ambient"));
  balance.exchanges.push_back(effects::make_film("back", "b.x1", constant(30.0), "ambient"));
  balance.exchanges.push_back(effects::make_contact("contact", "a/b", constant(1500.0)));
  return balance;
}

inline solver::FullSystem two_blocks(int n, const effects::HeatBalance& balance = two_blocks_balance()) {
  const mesh::Mesh mesh = two_boxes({{0, 0, 0}, {0.05, 0.1, 0.1}, {n, n, n}, mesh::CellShape::kTet10},
                                    {{0.05, 0, 0}, {0.3, 0.1, 0.1}, {3 * n, n, n}, mesh::CellShape::kTet10}, "a.x1", "b.x0");
  solver::FullSystem system = solver::assemble_heat(mesh, {steel(), steel()}, balance);
  observe_unknowns(system, {node_at(mesh, {0, 0, 0}), node_at(mesh, {0.35, 0.1, 0.1})});
  return system;
}

}  // namespace driftwright::fixtures
