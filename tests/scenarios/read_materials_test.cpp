// Materials of a scenario: of the library, of the library with other values, of one's own.

#include "scenarios/reader/read_materials.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::read_materials_test {
namespace {

solver::Material read(const std::string& yaml) {
  static const schema::Map description = materials_schema();
  return read_materials(ConfigMap::read_file(write_file("materials.yaml", "body: " + yaml + "\n")).described_by(description))
      .front()
      .material;
}

TEST(ReadMaterials, WhatStandsBesideLikeTakesThePlaceOfTheLibrarysValue) {
  const solver::Material& steel = solver::material_library().at("steel_c45");
  const solver::Material m =
      read("{like: steel_c45, expansion: 10 um/(m K), conductivity: [[20 degC, 40 W/(m K)], [100 degC, 38 W/(m K)]]}");
  EXPECT_DOUBLE_EQ(m.expansion_1_K.z, 1e-5);
  EXPECT_DOUBLE_EQ(m.conductivity_W_mK, 40.0);
  EXPECT_DOUBLE_EQ(m.conductivity_curve.at(373.15), 38.0);
  EXPECT_DOUBLE_EQ(m.density_kg_m3, steel.density_kg_m3);
  EXPECT_DOUBLE_EQ(m.youngs_modulus_Pa, steel.youngs_modulus_Pa);
  EXPECT_NE(steel.expansion_1_K.z, 1e-5);
}

TEST(ReadMaterials, AMaterialOfOnesOwnNeedsAllItsValues) {
  EXPECT_REFUSED(read("{density: 7850 kg/m^3}"), "the keys 'conductivity'");
  EXPECT_REFUSED(read("{like: steel_c45, expansion: 10 W}"), "wrong unit 'W'");
  EXPECT_REFUSED(read("{like: steel_c45, expansoin: 10 um/(m K)}"), "expansion");
}

}  // namespace
}  // namespace driftwright::scenarios::read_materials_test
