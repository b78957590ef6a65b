#include "solver/material.hpp"

namespace driftwright::solver {
namespace {

/// Reads a number, or rows of [temperature, value]; `value` is then the curve's value at 20 degC. Does nothing if the key is
/// left out.
void read_property(const ConfigMap& in, const std::string& key, double& value, PropertyCurve& curve) {
  if (!in.has(key)) return;
  curve = {};
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

schema::Map material_schema(bool are_compulsory) {
  using namespace schema;
  const std::string left_out = "that of the library";
  const auto property = [&](const std::string& name, const auto& ways, const std::string& meaning) {
    return are_compulsory ? compulsory(name, ways, meaning) : schema::optional(name, ways, Said{left_out}, meaning);
  };
  const auto over_temperature = [](const Value& v) { return Ways{v, rows({temperature(), v})}; };
  constexpr double kLeastExpansion_1_K = -1e-4, kMostExpansion_1_K = 1e-3;
  return {.name = "material",
          .keys = {property("density", quantity("kg/m^3", 1.0, 30000.0), "mass per volume"),
                   property("conductivity", over_temperature(quantity("W/(m K)", 1e-3, 5000.0)),
                            "one value, or rows of [temperature, value], linear between and constant outside"),
                   property("heat_capacity", over_temperature(quantity("J/(kg K)", 10.0, 20000.0)), "the same"),
                   property("youngs_modulus", quantity("Pa", 1e3, 2e12), "stiffness"),
                   property("poisson_ratio", quantity("1", 0.0, 0.495), "of contraction to stretch"),
                   property("expansion",
                            Ways{quantity("1/K", kLeastExpansion_1_K, kMostExpansion_1_K),
                                 schema::vector3("1/K", kLeastExpansion_1_K, kMostExpansion_1_K)},
                            "thermal expansion: one number, or three along x, y and z"),
                   schema::optional("source", text(), "the scenario", "where the values come from")}};
}

Material read_material(const ConfigMap& in, Material m) {
  if (in.has("density")) m.density_kg_m3 = in.quantity("density");
  if (in.has("youngs_modulus")) m.youngs_modulus_Pa = in.quantity("youngs_modulus");
  if (in.has("poisson_ratio")) m.poisson_ratio = in.quantity("poisson_ratio");
  if (in.has("expansion")) m.expansion_1_K = read_expansion(in);
  if (in.has("source") || m.source.empty()) m.source = in.text("source");
  read_property(in, "conductivity", m.conductivity_W_mK, m.conductivity_curve);
  read_property(in, "heat_capacity", m.heat_capacity_J_kgK, m.heat_capacity_curve);
  in.reject_unknown_keys();
  return m;
}

}  // namespace driftwright::solver
