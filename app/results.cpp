#include "app/results.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <optional>

#include "base/quantity.hpp"
#include "base/version.hpp"
#include "machine/as_recorded.hpp"
#include "machine/heat_flow_record.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/stress.hpp"

namespace driftwright::app {

output::ResultsFolder open_results(const CommonOptions& options, const std::string& scenario_name) {
  const std::string target = options.out.empty() ? "results/" + scenario_name : options.out;
  return {target, options.force, output::Provenance{kVersion, options.scenario}};
}

std::vector<std::string> provenance_lines(const output::Provenance& made_by, const std::string& what) {
  return {fmt::format("{}; Driftwright {}, scenario {}", what, made_by.version, made_by.scenario)};
}

std::string heat_flows_csv(const solver::Trajectory& run, const std::string& cyclogram, const output::Provenance& made_by) {
  return record_csv(scenarios::heat_flow_record(run, cyclogram),
                    provenance_lines(made_by,
                                     "mean heat flow since the row before; > 0 into the machine, within_...: > 0 out of "
                                     "the body; cyclogram " +
                                         cyclogram));
}

std::string shown_path(const std::filesystem::path& path) {
  const std::string relative = std::filesystem::relative(path).string();
  return relative.starts_with("..") ? path.string() : relative;
}

std::string fields_note(const output::FieldSeries& fields) {
  constexpr std::size_t kManyTimes = 100;
  if (fields.format() != FieldsFormat::kVtu || fields.n_times() <= kManyTimes) return "";
  return fmt::format(
      "note: fields at {} times, each file with the mesh; `solver: {{fields_format: xdmf}}` would hold the mesh once\n",
      fields.n_times());
}

scenarios::FieldSink sink_of(output::FieldSeries* fields, std::size_t cyclogram) {
  if (!fields) return {};
  return {.cyclogram = cyclogram, .take = [fields](const scenarios::WholeFields& whole) {
            fields->write(whole.time_s, whole.temperature_degC, whole.displacement_um,
                          whole.stress ? &*whole.stress : nullptr);
          }};
}

}  // namespace driftwright::app
