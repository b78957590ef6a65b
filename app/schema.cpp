// What files may hold, for editors, validators and the documentation.

#include <fmt/format.h>

#include "app/verbs.hpp"
#include "findings/diagnosis_keys.hpp"
#include "output/json_schema.hpp"
#include "output/result_keys.hpp"
#include "output/schema_tables.hpp"
#include "scenarios/reader/scenario.hpp"
#include "scenarios/reader/sweep_plan.hpp"

namespace driftwright::app {

void schema(const SchemaOptions& options) {
  if (options.what == "diagnosis" || options.what == "calibration") {
    const auto keys = options.what == "diagnosis" ? findings::diagnosis_keys() : findings::calibration_keys();
    fmt::print("{}", options.markdown ? output::result_table(keys)
                                      : output::result_schema(keys, fmt::format("Driftwright {}.json", options.what)));
    return;
  }
  const bool is_scenario = options.what == "scenario";
  const auto& files = is_scenario ? scenarios::scenario_schemas() : scenarios::sweep_schemas();
  if (options.markdown) {
    fmt::print("{}", output::schema_tables(files, "effects.md"));
  } else {
    fmt::print("{}", output::json_schema(files, is_scenario ? "Driftwright scenario" : "Driftwright study"));
  }
}

}  // namespace driftwright::app
