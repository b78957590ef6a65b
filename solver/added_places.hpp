#pragma once
// Bodies and paths of heat that a reduced system was not assembled with, added to it afterwards: a node is one more unknown, a path between two
// bodies the square of the difference of their mean temperatures. No basis is made anew.

#include <utility>

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// What a system lacks of a heat balance.
struct AddedPlaces {
  std::vector<std::pair<std::string, double>> nodes;  ///< name, capacity [J/K]
  std::vector<ExchangePlace> exchanges;               ///< of conductances in all, with the ambient or a node
  [[nodiscard]] bool empty() const { return nodes.empty() && exchanges.empty(); }
  bool operator==(const AddedPlaces&) const = default;
};

/// Nodes and exchanges of a balance that a system has no place for. Of exchanges those of Per::kTotal that have a surrounding: what else is lacking,
/// bind_laws() complains of. A body is in a system where heat can enter it.
[[nodiscard]] AddedPlaces places_lacking(const ReducedSystem& system, const effects::HeatBalance& balance);

/// The system with them, their coefficients zero. Each node is one unknown behind the system's own, sqrt(capacity) times its temperature over the
/// reference [K], so that its mass is one; heat may enter it, and its temperature may be looked at. Nothing else changes; the parts that the matrices are sums of are left out.
/// @throws std::logic_error  for a region or surface without an exchange with a medium, whose matrix its own exchanges take
[[nodiscard]] ReducedSystem with_places(const ReducedSystem& system, const AddedPlaces& added);

/// A state of the system as one of the system with added nodes, each of which is as warm as the mean of the bodies that lose heat to it.
[[nodiscard]] Eigen::VectorXd with_places(const Eigen::VectorXd& state, const ReducedSystem& system,
                                          const AddedPlaces& added);

}  // namespace driftwright::solver
