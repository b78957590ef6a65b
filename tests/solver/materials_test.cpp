// The library of materials and the table that shows it; materials of the user's own.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/errors.hpp"
#include "solver/material.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::solver::materials_test {
namespace {

std::string expansion_text(const Expansion& a) {
  if (a.x == a.y && a.y == a.z) return fmt::format("{:.1f}", 1e6 * a.x);
  return fmt::format("{:.1f}, {:.1f}, {:.1f}", 1e6 * a.x, 1e6 * a.y, 1e6 * a.z);
}

std::string table() {
  std::string text =
      "| name | density kg/m^3 | conductivity W/(m K) | heat capacity J/(kg K) | E GPa | Poisson | expansion "
      "1e-6/K | source, scatter |\n|---|---|---|---|---|---|---|---|\n";
  for (const auto& [name, m] : material_library()) {
    text += fmt::format("| `{}` | {:g} | {:g} | {:g} | {:g} | {:g} | {} | {} |\n", name, m.density_kg_m3,
                        m.conductivity_W_mK, m.heat_capacity_J_kgK, 1e-9 * m.youngs_modulus_Pa, m.poisson_ratio,
                        expansion_text(m.expansion_1_K), m.source);
  }
  return text;
}

TEST(MaterialLibrary, IsTheTableInTheDocumentation) {
  std::ostringstream text;
  text << std::ifstream("docs/reference/materials.md").rdbuf();
  const std::string page = text.str();
  const auto at = page.find("| name |");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(page.substr(at, page.find("\n\n", at) + 1 - at), table())
      << "the table that docs/reference/materials.md should hold";
}

TEST(MaterialLibrary, ValuesArePlausibleAndHaveASource) {
  for (const auto& [name, m] : material_library()) {
    SCOPED_TRACE(name);
    EXPECT_GT(m.source.size(), 10u);
    EXPECT_GE(m.density_kg_m3, 1000.0);
    EXPECT_LE(m.density_kg_m3, 9000.0);
    EXPECT_GE(m.heat_capacity_J_kgK, 300.0);  // rho c of dense solids is 1.3 to 4.2 MJ/(m^3 K)
    EXPECT_GE(m.density_kg_m3 * m.heat_capacity_J_kgK, 1.3e6);
    EXPECT_LE(m.density_kg_m3 * m.heat_capacity_J_kgK, 4.3e6);
    EXPECT_GE(m.youngs_modulus_Pa, 30e9);
    EXPECT_LE(m.youngs_modulus_Pa, 400e9);
    EXPECT_GT(m.poisson_ratio, 0.15);
    EXPECT_LT(m.poisson_ratio, 0.40);
  }
}

Material read(const std::string& expansion) {
  const std::string file =
      write_file("material.yaml",
                 "density: 1600 kg/m^3\nconductivity: 5 W/(m K)\nheat_capacity: 900 J/(kg K)\nyoungs_modulus: 50 GPa\n"
                 "poisson_ratio: 0.3\nexpansion: " +
                     expansion + "\n");
  return read_material(ConfigMap::read_file(file).described_by(material_schema()));
}

TEST(Material, ExpansionIsOneNumberOrOneForEachAxis) {
  const Material same = read("12e-6 1/K"), three = read("[1e-6 1/K, 2e-6 1/K, 30e-6 1/K]");
  EXPECT_EQ(same.expansion_1_K.x, 12e-6);
  EXPECT_EQ(same.expansion_1_K.z, 12e-6);
  EXPECT_EQ(three.expansion_1_K.x, 1e-6);
  EXPECT_EQ(three.expansion_1_K.y, 2e-6);
  EXPECT_EQ(three.expansion_1_K.z, 30e-6);
}

TEST(Material, ExpansionWithoutSenseIsRefused) {
  EXPECT_REFUSED(read("[1e-6 1/K, 2e-6 1/K]"), "three quantities");
  EXPECT_REFUSED(read("[1e-6 1/K, 2e-6 1/K, 1 1/K]"), "outside what is allowed");
  EXPECT_REFUSED(read("[1e-6 1/K, nan 1/K, 1e-6 1/K]"), "finite");
  EXPECT_REFUSED(read(".nan"), "expansion");
}

}  // namespace
}  // namespace driftwright::solver::materials_test
