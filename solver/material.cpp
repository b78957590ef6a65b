#include "solver/material.hpp"

#include <fmt/format.h>

namespace driftwright::solver {
namespace {

constexpr double kLeastExpansion_1_K = -1e-4, kMostExpansion_1_K = 1e-3;

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
