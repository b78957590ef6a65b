#pragma once
// Factors on the material of a region, on the capacity of a lumped node, or on the sensitivity of a displacement to a body.

#include <string>
#include <vector>

#include "effects/heat_balance.hpp"

namespace driftwright::effects {

/// Factors on the values of the body's material, also if these are curves, and on the sensitivities of displacements to its
/// temperature. Several at one body multiply. heat_balance() has already applied those of lumped nodes to their capacities.
struct MaterialFactor {
  Body body;
  double conductivity = 1.0, heat_capacity = 1.0, expansion = 1.0;
  /// The only displacement whose sensitivity `expansion` changes; "": the material's expansion and all sensitivities.
  std::string displacement = {};
};

/// The product of all factors on the sensitivity of a displacement to a body's temperature.
[[nodiscard]] inline double sensitivity_factor(const std::vector<MaterialFactor>& factors, const Body& body,
                                               const std::string& displacement) {
  double product = 1.0;
  for (const MaterialFactor& f : factors) {
    if (f.body == body && (f.displacement.empty() || f.displacement == displacement)) product *= f.expansion;
  }
  return product;
}

}  // namespace driftwright::effects
