#pragma once
// Reads `materials:`: what each region of the mesh is made of.

#include <vector>

#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

[[nodiscard]] schema::Map materials_schema();
/// `materials:` maps each region to a name of the library or to a map: of values, or of such a name and how well it is
/// known.
[[nodiscard]] std::vector<MaterialEntry> read_materials(const ConfigMap& in);

}  // namespace driftwright::scenarios
