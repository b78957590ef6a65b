#include "studies/planned_twin.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.hpp"
#include "diagnosis/foresight.hpp"
#include "diagnosis/scatter.hpp"
#include "effects/reading_chain.hpp"
#include "machine/simulated_run.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::studies {
namespace {

/// The machine's own instruments, and a thermometer on each of its parts without one.
void list_channels(const scenarios::MachineModel& model, PlannedTwin& p) {
  const solver::Outputs& outputs = p.twin->outputs();
  std::vector<std::string> measured_parts;
  for (const scenarios::Sensor& s : model.sensors) {
    if (const auto* node = std::get_if<std::string>(&s.place)) measured_parts.push_back(effects::mean_output(*node));
  }
  for (std::size_t o = 0; o < outputs.name.size(); ++o) {
    const bool is_further = effects::is_mean_output(outputs.name[o]);
    if (outputs.ambient[static_cast<Eigen::Index>(o)] == 1.0) continue;  // on the ambient, which is recorded anyway
    if (is_further && std::find(measured_parts.begin(), measured_parts.end(), outputs.name[o]) != measured_parts.end())
      continue;
    (is_further ? p.further : p.channels).push_back({outputs.name[o], static_cast<int>(o), outputs.unit[o], {}});
  }
}

diagnosis::NoiseModel noise_of(const std::string& unit, const InstrumentNoise& noise, const diagnosis::Focus& focus) {
  const diagnosis::NoiseFloor floor = floor_of(focus.machine.system);
  if (unit == "K") return {std::hypot(noise.temperature_K, std::max(floor.white_K, focus.error_K)), floor.slow_K, 1200.0};
  if (unit == "m")
    return {std::hypot(1e-6 * noise.displacement_um, std::max(floor.white_m, focus.error_m)), floor.slow_m, 1200.0};
  return {std::hypot(1e-6 * noise.tilt_urad, floor.white_rad), floor.slow_rad, 1200.0};
}

}  // namespace

PlannedTwin open_planned_twin(const scenarios::Scenario& scenario, const std::string& verb,
                              const std::vector<Cyclogram>& like, double interval_s, const InstrumentNoise& noise,
                              const Listener& listener) {
  const scenarios::MachineModel& model = scenarios::require_machine(scenario, verb);
  if (const auto columns = scenarios::wanted_columns(model, like.front().name); !columns.empty())
    throw InputError(model.where,
                     fmt::format("`{}` plans speeds, feeds and cutting power; this machine is driven by the recorded {}, "
                                 "which no programme can order",
                                 verb, fmt::join(columns, ", ")));
  PlannedTwin p;
  listener.begin("meshing");
  p.mesh = scenarios::place(model).mesh;
  p.ambient = model.ambient;
  std::vector<diagnosis::MeasuredRun> runs;
  for (const Cyclogram& c : like) runs.push_back(diagnosis::planned_run(c, interval_s, p.ambient, true, {}));
  p.parts = std::make_unique<TwinParts>(TwinParts{diagnosis::augment(scenario, p.mesh, runs), {}});
  p.parts->machine = scenarios::open_reduced(p.parts->augmented.model, p.parts->augmented.plan, listener);
  solver::TransientOptions tolerances = scenario.solver.transient;  // a fraction of the noise is accurate enough
  tolerances.relative_tolerance = std::max(tolerances.relative_tolerance, 1e-4);
  tolerances.absolute_tolerance_K = std::max(tolerances.absolute_tolerance_K, 2e-3);
  const diagnosis::Twin whole(p.parts->augmented, p.parts->machine, tolerances);
  listener.begin("computing the states that such runs reach");
  p.focus = std::make_unique<diagnosis::Focus>(
      diagnosis::focus(whole, runs, diagnosis::scatter(whole), diagnosis::candidates(whole, runs, {})));
  p.twin.emplace(p.parts->augmented, p.focus->machine, tolerances);
  list_channels(model, p);
  if (p.channels.empty())
    throw InputError(
        model.where,
        fmt::format("`{}` needs a thermometer or a displacement that would be read; add one to `sensors` or `displacements`",
                    verb));
  for (const auto* list : {&p.channels, &p.further}) {
    for (const diagnosis::MeasuredChannel& c : *list) p.noise[c.name] = noise_of(c.unit, noise, *p.focus);
  }
  return p;
}

}  // namespace driftwright::studies
