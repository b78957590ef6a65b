#pragma once
// Adds bodies and heat paths to a reduced system that was assembled without them: a node is one more unknown, a path between
// two bodies adds the square of the difference of their mean temperatures. The basis is not computed again.

#include <utility>

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// The parts of a heat balance that a system lacks.
struct AddedPlaces {
  std::vector<std::pair<std::string, double>> nodes;  ///< name, capacity [J/K]
  std::vector<ExchangePlace> exchanges;               ///< total conductances [W/K] to the ambient or a node
  [[nodiscard]] bool empty() const { return nodes.empty() && exchanges.empty(); }
  bool operator==(const AddedPlaces&) const = default;
};

/// The nodes and exchanges of a balance that a system has no place for. Of the exchanges only those of Per::kTotal with a
/// surrounding; bind_laws() reports everything else that is missing. A body is part of a system if heat can enter it.
[[nodiscard]] AddedPlaces places_lacking(const ReducedSystem& system, const effects::HeatBalance& balance);

/// The system with these added, their coefficients zero. Each node adds one unknown after the system's own: sqrt(capacity)
/// times its temperature above the reference [K], so that its mass is one. Heat may enter a node, and laws may use its
/// temperature. Nothing else changes, except that ThermalSystem::parts is left empty.
/// @throws std::logic_error for a region or surface without an exchange with a medium, because its matrix is taken from its
///         exchanges
[[nodiscard]] ReducedSystem with_places(const ReducedSystem& system, const AddedPlaces& added);

/// A state of the system extended by the added nodes. Each node starts at the mean temperature of the bodies that lose heat
/// to it.
[[nodiscard]] Eigen::VectorXd with_places(const Eigen::VectorXd& state, const ReducedSystem& system,
                                          const AddedPlaces& added);

}  // namespace driftwright::solver
