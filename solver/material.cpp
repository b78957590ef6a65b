#include "solver/material.hpp"

#include <fmt/format.h>

namespace driftwright::solver {
namespace {

/// A number, or rows of [temperature, value]; then `value` becomes the curve's at 20 degC.
void read_property(const ConfigMap& in, const std::string& key, const std::string& unit, double low, double high,
                   double& value, PropertyCurve& curve) {
  if (!in.is_list(key)) {
    value = in.quantity(key, unit, low, high);
    return;
  }
  for (const std::vector<double>& row : in.rows(key, {"degC", unit})) {
    if (!curve.temperature_K.empty() && !(row[0] > curve.temperature_K.back())) {
      in.fail(key, "temperatures must increase from row to row");
    }
    if (!(row[1] >= low && row[1] <= high)) {
      in.fail(key, fmt::format("{:g} {} is out of range; {:g} to {:g} is allowed", row[1], unit, low, high));
    }
    curve.temperature_K.push_back(row[0]);
    curve.value.push_back(row[1]);
  }
  value = curve.at(293.15);
}

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
             .youngs_modulus_Pa = in.quantity("youngs_modulus", "Pa", 1e3, 2e12),
             .poisson_ratio = in.quantity("poisson_ratio", "1", 0.0, 0.495),
             .expansion_1_K = read_expansion(in),
             .source = in.text("source", "the scenario")};
  read_property(in, "conductivity", "W/(m K)", 1e-3, 5000.0, m.conductivity_W_mK, m.conductivity_curve);
  read_property(in, "heat_capacity", "J/(kg K)", 10.0, 20000.0, m.heat_capacity_J_kgK, m.heat_capacity_curve);
  in.reject_unknown_keys();
  return m;
}

}  // namespace driftwright::solver
