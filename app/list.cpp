#include <fmt/format.h>

#include <algorithm>

#include "app/verbs.hpp"
#include "base/errors.hpp"
#include "effects/catalogue_table.hpp"
#include "effects/effect.hpp"
#include "solver/material.hpp"

namespace driftwright::app {

void list(const ListOptions& options) {
  if (options.what == "materials") {
    if (options.markdown) throw InputError("--markdown goes with effects; materials are one table of plain text");
    fmt::print("{:<24} {:>8} {:>10} {:>10} {:>10} {:>10} {:>8}\n", "material", "kg/m^3", "J/(kg K)", "W/(m K)", "um/(m K)",
               "GPa", "Poisson");
    for (const auto& [name, m] : solver::material_library()) {
      fmt::print("{:<24} {:>8.0f} {:>10.0f} {:>10.4g} {:>10.4g} {:>10.4g} {:>8.2f}\n", name, m.density_kg_m3,
                 m.heat_capacity_J_kgK, m.conductivity_W_mK, 1e6 * m.expansion_1_K.x, 1e-9 * m.youngs_modulus_Pa,
                 m.poisson_ratio);
    }
    return;
  }
  if (options.markdown) {
    fmt::print("{}", effects::catalogue_table());
    return;
  }
  std::size_t width = 0;
  for (const effects::EffectKind& kind : effects::catalogue()) width = std::max(width, kind.key.size());
  for (const effects::EffectKind& kind : effects::catalogue()) fmt::print("{:<{}}  {}\n", kind.key, width, kind.title);
}

}  // namespace driftwright::app
