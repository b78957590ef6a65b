// The library of materials. docs/reference/materials.md shows it as a table; tests/solver/materials_test.cpp keeps the two
// equal.

#include "solver/material.hpp"

namespace driftwright::solver {
namespace {

Material entry(double density_kg_m3, double conductivity_W_mK, double heat_capacity_J_kgK, double youngs_modulus_GPa,
               double poisson_ratio, Expansion expansion_um_mK, const std::string& source) {
  Material m;
  m.density_kg_m3 = density_kg_m3;
  m.conductivity_W_mK = conductivity_W_mK;
  m.heat_capacity_J_kgK = heat_capacity_J_kgK;
  m.youngs_modulus_Pa = 1e9 * youngs_modulus_GPa;
  m.poisson_ratio = poisson_ratio;
  m.expansion_1_K = {1e-6 * expansion_um_mK.x, 1e-6 * expansion_um_mK.y, 1e-6 * expansion_um_mK.z};
  m.source = source;
  return m;
}

}  // namespace

const std::map<std::string, Material>& material_library() {
  static const std::map<std::string, Material> library = {
      // Cast irons. Expansion of grey iron: EN 1561 gives 10.0 (-100 to 20 degC) and 11.7 (20 to 200 degC).
      {"cast_iron_gjl250",
       entry(7200, 48.5, 460, 110, 0.26, 11.0, "EN 1561 annex A, EN-GJL-250; E of 103 to 118 GPa, expansion 10.0 to 11.7")},
      {"cast_iron_gjl300",
       entry(7250, 47.5, 460, 125, 0.26, 11.0, "EN 1561 annex A, EN-GJL-300; E of 108 to 137 GPa, expansion 10.0 to 11.7")},
      {"cast_iron_gjs400", entry(7100, 36.2, 515, 169, 0.275, 12.5, "EN 1563 annex, EN-GJS-400-15: 20 to 400 degC values")},
      {"cast_iron_gjs600", entry(7200, 32.5, 515, 174, 0.275, 12.5, "EN 1563 annex, EN-GJS-600-3: 20 to 400 degC values")},
      // Steels
      {"steel_c45", entry(7850, 45.0, 470, 210, 0.30, 11.5, "VDI-Waermeatlas D6.1; EN 10088-1 style tables for C45")},
      {"steel_16mncr5",
       entry(7850, 44.0, 460, 210, 0.30, 11.5, "data sheets of 1.7131; conductivity of 39 to 44, expansion 11.1 to 11.7")},
      {"steel_42crmo4",
       entry(7840, 42.6, 470, 210, 0.30, 11.5,
             "conductivity: Meusburger sheet of 1.7225; density: kooz.si sheet (E of 190 to 210 GPa); others as C45, "
             "expansion 11.1 to 12.3")},
      {"steel_x5crni18_10", entry(7900, 15.0, 500, 200, 0.30, 16.0, "EN 10088-1 annex E, 1.4301; expansion 20 to 100 degC")},
      {"bearing_steel", entry(7810, 42.0, 470, 208, 0.30, 11.9, "100Cr6 (EN ISO 683-17), solid ring without cage and gaps")},
      // Light metals and copper
      {"aluminium_6082", entry(2700, 172.0, 896, 70, 0.33, 23.4, "EN 573 / Aluminium-Taschenbuch, EN AW-6082 T6")},
      {"aluminium_7075",
       entry(2810, 130.0, 960, 71.7, 0.33, 23.5, "ASM Metals Handbook vol. 2, 7075-T6; conductivity of T73: 155")},
      {"aluminium_alsi10mg",
       entry(2650, 140.0, 910, 75, 0.33, 21.0, "EN 1706 annex, EN AC-43000; conductivity of 130 to 150, E of 70 to 76 GPa")},
      {"titanium_ti6al4v", entry(4430, 6.7, 526, 113.8, 0.342, 8.6, "ASM Metals Handbook vol. 2, Ti-6Al-4V annealed")},
      {"brass_cuzn39pb3", entry(8470, 123.0, 377, 96, 0.35, 21.4, "Deutsches Kupferinstitut, CuZn39Pb3 (CW614N)")},
      {"copper_etp", entry(8930, 394.0, 386, 127, 0.34, 17.0, "Deutsches Kupferinstitut, Cu-ETP (CW004A)")},
      // Low expansion
      {"invar_36", entry(8050, 10.0, 515, 141, 0.29, 1.5,
                         "CarTech Invar 36 sheet (20.5e6 psi; NIST's fit gives an E of 152 GPa); expansion to 100 degC of "
                         "1.2 to 1.9 with heat treatment")},
      {"glass_float", entry(2500, 1.0, 720, 70, 0.20, 9.0, "EN 572-1, soda lime; the glass of encoder scales: about 8")},
      {"glass_ceramic_robax", entry(2600, 1.6, 800, 92, 0.25, 0.0, "SCHOTT ROBAX sheet; expansion 0 +- 0.3")},
      {"glass_ceramic_zerodur",
       entry(2530, 1.46, 800, 90.3, 0.24, 0.0, "SCHOTT ZERODUR sheet; expansion 0 +- 0.1 in class 2, 0 to 50 degC")},
      // Stone and composites
      {"granite", entry(2900, 3.0, 840, 70, 0.25, 6.5,
                        "density, heat capacity, E, Poisson: makeitfrom.com; others typical of dark machine granite "
                        "(gabbro); E of 50 to 90 GPa, conductivity 2 to 3.5, expansion 5 to 8")},
      {"mineral_casting",
       entry(2400, 2.0, 1000, 40, 0.25, 15.0,
             "typical of epoxy-bound mineral casting; E of 30 to 45 GPa, conductivity 1.3 to 3, expansion 12 to 20: ask the "
             "maker")},
      {"cfrp_quasi_isotropic",
       entry(
           1600, 5.0, 900, 50, 0.30,
           {2.5, 2.5, 40.0},
           "typical of HT fibre, epoxy, 60 % by volume, plies 0/45/90/-45 in the x-y plane; E and conductivity are those in "
           "the plane (across: 8 to 10 GPa, 0.7), expansion across of 30 to 60")},
      // Ceramics
      {"silicon_nitride",
       entry(3290, 30.0, 800, 310, 0.27, 3.2,
             "Lily Bearing, hot-pressed Si3N4 for balls; expansion of 2.2 to 3.3; heat capacity: handbooks, 700 to 800")},
      {"alumina", entry(3890, 35.0, 880, 375, 0.22, 6.5,
                        "Lily Bearing, 99.5 % Al2O3; expansion of 5.5 (to 100 degC) to 8.4 (to 1000 degC)")},
      // Smeared parts
      {"motor_mean",
       entry(
           5200, 20.0, 460, 60, 0.30, 13.0,
           "our estimate: an induction motor smeared over its cylinder (2/3 lamination and copper, 1/3 air); mass and heat "
           "capacity from catalogue masses of 2.2 to 4 kW motors")},
  };
  return library;
}

}  // namespace driftwright::solver
