#pragma once
// A small gantry table on its bed, with a contact and two films, as the beginning of a scenario.

#include <string>

namespace driftwright::fixtures {

/// The text up to its `effects`, of which a test's own follow as "  - {...}". @param mesh_size  "400 mm"
inline std::string small_table(const std::string& mesh_size) {
  return R"(name: small_table
reference_temperature: 20 degC
machine:
  generator: gantry_table
  table: {length: 2 m, width: 1 m, height: 200 mm}
  bed: {length: 2.4 m, width: 1 m, height: 300 mm}
  guideways: {width: 150 mm, height: 100 mm, gauge: 700 mm}
  mesh_size: )" +
         mesh_size + R"(
materials: {table: cast_iron_gjl250, bed: cast_iron_gjl250}
supports: [{surface: bed_underside, fixed: [x, y, z]}]
effects:
  - {type: contact, joint: bed/table, conductance: 150 W/(m^2 K)}
  - {type: convection, surface: table_top, film: 8 W/(m^2 K)}
  - {type: convection, surface: bed_sides, film: 6 W/(m^2 K)}
)";
}

}  // namespace driftwright::fixtures
