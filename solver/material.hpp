#pragma once
// Materials by name, each value with its source, and materials of the user's own.

#include <map>
#include <string>
#include <vector>

#include "base/config_map.hpp"
#include "solver/property_curve.hpp"

namespace driftwright::solver {

/// Linear thermal expansion along x, y and z of the machine [1/K]. One number: the same along all.
struct Expansion {
  double x = 0.0, y = 0.0, z = 0.0;
  Expansion() = default;
  Expansion(double all_1_K) : x(all_1_K), y(all_1_K), z(all_1_K) {}  // NOLINT(google-explicit-constructor)
  Expansion(double x_1_K, double y_1_K, double z_1_K) : x(x_1_K), y(y_1_K), z(z_1_K) {}
};

/// Isotropic but for the expansion, at about 20 degC.
struct Material {
  double density_kg_m3 = 0.0;
  double conductivity_W_mK = 0.0;
  double heat_capacity_J_kgK = 0.0;
  double youngs_modulus_Pa = 0.0;
  double poisson_ratio = 0.0;
  Expansion expansion_1_K;
  std::string source;
  PropertyCurve conductivity_curve = {},
                heat_capacity_curve = {};  ///< over temperature; then the values above are those at 20 degC
};

/// The library, by name.
[[nodiscard]] const std::map<std::string, Material>& material_library();

/// What a material given by its values may hold. @param are_compulsory  false: of one of the library with other values
[[nodiscard]] schema::Map material_schema(bool are_compulsory = true);
/// Reads a material given by its values: density, conductivity, heat_capacity, youngs_modulus, poisson_ratio, expansion (one
/// number, or a list of three for x, y and z), and optionally source. Conductivity and heat_capacity may be rows of
/// [temperature, value]. @param m  has the values that are left out. @throws InputError
[[nodiscard]] Material read_material(const ConfigMap& in, Material m = {});

}  // namespace driftwright::solver
