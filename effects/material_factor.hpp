#pragma once
// What an effect does to the material of a region, or to the capacity of a lumped node.

#include <string>

namespace driftwright::effects {

/// Factors on the values of the region's material, whatever their curves. Several at one region multiply.
struct MaterialFactor {
  std::string region;
  double conductivity = 1.0, heat_capacity = 1.0, expansion = 1.0;
  bool is_node =
      false;  ///< then `region` names a lumped node; heat_balance() has applied the factor to its capacity already
};

}  // namespace driftwright::effects
