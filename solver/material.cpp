#include "solver/material.hpp"

#include <fmt/format.h>

namespace driftwright::solver {
namespace {

constexpr double kLeastExpansion_1_K = -1e-4, kMostExpansion_1_K = 1e-3;

}  // namespace

const std::map<std::string, Material>& material_library() {
  static const std::map<std::string, Material> library = {
      {"cast_iron_gjl250",
       {7200, 48.5, 460, 110e9, 0.26, 11.0e-6, "EN 1561 annex A, EN-GJL-250: 20-200 degC values (E of 103 to 118 GPa)"}},
      {"cast_iron_gjs400", {7100, 36.2, 515, 169e9, 0.275, 12.5e-6, "EN 1563 annex, EN-GJS-400-15: 20-400 degC values"}},
      {"steel_c45", {7850, 45.0, 470, 210e9, 0.30, 11.5e-6, "VDI-Waermeatlas D6.1; EN 10088-1 style tables for C45"}},
      {"bearing_steel", {7810, 42.0, 470, 208e9, 0.30, 11.9e-6, "100Cr6 (EN ISO 683-17), solid ring without cage and gaps"}},
      {"aluminium_6082", {2700, 172.0, 896, 70e9, 0.33, 23.4e-6, "EN 573 / Aluminium-Taschenbuch, EN AW-6082 T6"}},
      {"motor_mean",
       {5200, 20.0, 460, 60e9, 0.30, 13.0e-6,
        "our estimate: an induction motor smeared over its cylinder (2/3 lamination and copper, 1/3 air); "
        "mass and heat "
        "capacity from catalogue masses of 2.2 to 4 kW motors"}},
  };
  return library;
}

namespace {

Expansion read_expansion(const ConfigMap& in) {
  if (!in.is_list("expansion")) return in.quantity("expansion", "1/K", kLeastExpansion_1_K, kMostExpansion_1_K);
  const Eigen::Vector3d a_1_K = in.vector3("expansion", "1/K");
  for (double a : a_1_K) {
    if (!(a >= kLeastExpansion_1_K && a <= kMostExpansion_1_K)) {
      in.fail("expansion", fmt::format("{:g} 1/K lies outside what is allowed, {:g} to {:g} 1/K", a, kLeastExpansion_1_K,
                                       kMostExpansion_1_K));
    }
  }
  return {a_1_K[0], a_1_K[1], a_1_K[2]};
}

}  // namespace

Material read_material(const ConfigMap& in) {
  Material m{.density_kg_m3 = in.quantity("density", "kg/m^3", 1.0, 30000.0),
             .conductivity_W_mK = in.quantity("conductivity", "W/(m K)", 1e-3, 5000.0),
             .heat_capacity_J_kgK = in.quantity("heat_capacity", "J/(kg K)", 10.0, 20000.0),
             .youngs_modulus_Pa = in.quantity("youngs_modulus", "Pa", 1e3, 2e12),
             .poisson_ratio = in.quantity("poisson_ratio", "1", 0.0, 0.495),
             .expansion_1_K = read_expansion(in),
             .source = in.text("source", "the scenario")};
  in.reject_unknown_keys();
  return m;
}

}  // namespace driftwright::solver
