#pragma once
// What an effect does to the material of a region.

#include <string>

namespace driftwright::effects {

/// Factors on the values of the region's material, whatever their curves.
struct MaterialFactor {
  std::string region;
  double conductivity = 1.0, heat_capacity = 1.0, expansion = 1.0;
};

}  // namespace driftwright::effects
