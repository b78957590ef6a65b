#pragma once
// What an effect does to the material of a region, to the capacity of a lumped node, or to how a displacement follows a body.

#include <string>
#include <vector>

#include "effects/heat_balance.hpp"

namespace driftwright::effects {

/// Factors on the values of the body's material, whatever their curves, and on the sensitivities of displacements to its temperature.
/// Several at one body multiply. heat_balance() has applied those of lumped nodes to their capacities already.
struct MaterialFactor {
  Body body;
  double conductivity = 1.0, heat_capacity = 1.0, expansion = 1.0;
  std::string displacement =
      {};  ///< the only one whose sensitivity the expansion is about; "": the material's, and all of them
};

/// What all of them together make of the sensitivity of a displacement to a body's temperature.
[[nodiscard]] inline double sensitivity_factor(const std::vector<MaterialFactor>& factors, const Body& body,
                                               const std::string& displacement) {
  double product = 1.0;
  for (const MaterialFactor& f : factors) {
    if (f.body == body && (f.displacement.empty() || f.displacement == displacement)) product *= f.expansion;
  }
  return product;
}

}  // namespace driftwright::effects
