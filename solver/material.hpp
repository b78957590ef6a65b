#pragma once
// Materials by name, each value with its source, and materials defined by the user.

#include <map>
#include <string>
#include <vector>

#include "base/config_map.hpp"
#include "solver/property_curve.hpp"

namespace driftwright::solver {

/// Linear thermal expansion along x, y and z of the machine [1/K]. A single number applies to all three.
struct Expansion {
  double x = 0.0, y = 0.0, z = 0.0;
  Expansion() = default;
  Expansion(double all_1_K) : x(all_1_K), y(all_1_K), z(all_1_K) {}  // NOLINT(google-explicit-constructor)
  Expansion(double x_1_K, double y_1_K, double z_1_K) : x(x_1_K), y(y_1_K), z(z_1_K) {}
};

/// A material, isotropic except for the expansion, at about 20 degC.
struct Material {
  double density_kg_m3 = 0.0;
  double conductivity_W_mK = 0.0;
  double heat_capacity_J_kgK = 0.0;
  double youngs_modulus_Pa = 0.0;
  double poisson_ratio = 0.0;
  Expansion expansion_1_K;
  std::string source;
  PropertyCurve conductivity_curve = {},
                heat_capacity_curve = {};  ///< over temperature; the values above are then those at 20 degC
};

/// The library, by name.
[[nodiscard]] const std::map<std::string, Material>& material_library();

/// The schema of a material given by its values. @param are_compulsory  false: for a library material with changed values
[[nodiscard]] schema::Map material_schema(bool are_compulsory = true);
/// Reads a material given by its values: density, conductivity, heat_capacity, youngs_modulus, poisson_ratio, expansion (one
/// number, or a list of three for x, y and z), and optionally source. Conductivity and heat_capacity may be rows of
/// [temperature, value]. @param m  supplies the values that are left out. @throws InputError
[[nodiscard]] Material read_material(const ConfigMap& in, Material m = {});

}  // namespace driftwright::solver
