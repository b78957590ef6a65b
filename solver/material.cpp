#include "solver/material.hpp"

namespace driftwright::solver {
namespace {

/// A number, or rows of [temperature, value]; then `value` becomes the curve's at 20 degC.
void read_property(const ConfigMap& in, const std::string& key, double& value, PropertyCurve& curve) {
  if (!in.is_list(key)) {
    value = in.quantity(key);
    return;
  }
  for (const std::vector<double>& row : in.rows(key)) {
    if (!curve.temperature_K.empty() && !(row[0] > curve.temperature_K.back())) {
      in.fail(key, "temperatures must increase from row to row");
    }
    curve.temperature_K.push_back(row[0]);
    curve.value.push_back(row[1]);
  }
  value = curve.at(293.15);
}

Expansion read_expansion(const ConfigMap& in) {
  if (!in.is_list("expansion")) return in.quantity("expansion");
  const Eigen::Vector3d a_1_K = in.vector3("expansion");
  return {a_1_K[0], a_1_K[1], a_1_K[2]};
}

}  // namespace

schema::Map material_schema() {
  using namespace schema;
  const auto over_temperature = [](const Value& v) { return Ways{v, rows({temperature(), v})}; };
  constexpr double kLeastExpansion_1_K = -1e-4, kMostExpansion_1_K = 1e-3;
  return {.name = "material",
          .keys = {compulsory("density", quantity("kg/m^3", 1.0, 30000.0), "mass per volume"),
                   compulsory("conductivity", over_temperature(quantity("W/(m K)", 1e-3, 5000.0)),
                              "one value, or rows of [temperature, value], linear between and constant outside"),
                   compulsory("heat_capacity", over_temperature(quantity("J/(kg K)", 10.0, 20000.0)), "the same"),
                   compulsory("youngs_modulus", quantity("Pa", 1e3, 2e12), "stiffness"),
                   compulsory("poisson_ratio", quantity("1", 0.0, 0.495), "of contraction to stretch"),
                   compulsory("expansion",
                              Ways{quantity("1/K", kLeastExpansion_1_K, kMostExpansion_1_K),
                                   schema::vector3("1/K", kLeastExpansion_1_K, kMostExpansion_1_K)},
                              "thermal expansion: one number, or three along x, y and z"),
                   schema::optional("source", text(), "the scenario", "where the values come from")}};
}

Material read_material(const ConfigMap& in) {
  Material m{.density_kg_m3 = in.quantity("density"),
             .youngs_modulus_Pa = in.quantity("youngs_modulus"),
             .poisson_ratio = in.quantity("poisson_ratio"),
             .expansion_1_K = read_expansion(in),
             .source = in.text("source")};
  read_property(in, "conductivity", m.conductivity_W_mK, m.conductivity_curve);
  read_property(in, "heat_capacity", m.heat_capacity_J_kgK, m.heat_capacity_curve);
  in.reject_unknown_keys();
  return m;
}

}  // namespace driftwright::solver
