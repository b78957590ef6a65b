#include "app/results.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/version.hpp"
#include "base/quantity.hpp"

namespace driftwright::app {

output::ResultsFolder open_results(const CommonOptions& options, const std::string& scenario_name) {
  const std::string target = options.out.empty() ? "results/" + scenario_name : options.out;
  return {target, options.force, output::Provenance{kVersion, options.scenario}};
}

std::vector<std::string> provenance_lines(const output::Provenance& made_by, const std::string& what) {
  return {fmt::format("{}; Driftwright {}, scenario {}", what, made_by.version, made_by.scenario)};
}

std::string shown_path(const std::filesystem::path& path) {
  const std::string relative = std::filesystem::relative(path).string();
  return relative.starts_with("..") ? path.string() : relative;
}

const scenarios::MachineModel& require_machine(const scenarios::Scenario& scenario, const std::string& verb) {
  if (scenario.machine) return *scenario.machine;
  throw InputError(fmt::format("{}: `{}` needs the key `machine`; this scenario is about measured records alone (select, validate)",
                               scenario.path, verb));
}

const scenarios::Study& require_study(const scenarios::Scenario& scenario, const std::string& verb) {
  if (scenario.study) return *scenario.study;
  throw InputError(fmt::format("{}: `{}` needs the key `study`, which says the target and what to fit", scenario.path, verb));
}

SimulatedRun simulate_cyclogram(const scenarios::Scenario& scenario, const scenarios::Machine& machine, const Cyclogram& cyclogram,
                                Progress& progress, output::FieldSeries* fields) {
  const scenarios::MachineModel& model = *scenario.machine;
  const scenarios::SolverSettings& settings = scenario.solver;
  progress.begin(fmt::format("simulating {}, {:.0f} min", cyclogram.name, cyclogram.duration_s() / 60.0));
  const double end_s = cyclogram.duration_s();
  double next_field_s = 0.0;
  const auto at_output = [&](double time_s, const Eigen::VectorXd& state) {
    progress.update(time_s / end_s);
    if (!fields || (time_s < next_field_s - 1e-6 && time_s < end_s)) return;
    const Eigen::VectorXd nodes = state.head(machine.placed.mesh.n_nodes());
    fields->write(time_s, (nodes.array() + (model.reference_K - kZeroCelsius_K)).matrix(), 1e6 * machine.elasticity.displacement(nodes));
    while (next_field_s <= time_s + 1e-6) next_field_s += settings.fields_every_s;
  };
  SimulatedRun run;
  run.trajectory = solver::simulate(machine.system, cyclogram, model.hall, scenarios::output_times_s(cyclogram, settings.output_interval_s),
                                    settings.transient, Eigen::VectorXd::Zero(machine.system.size()), at_output);
  run.record = scenarios::to_record(run.trajectory, machine.system.outputs, cyclogram, model.reference_K);
  return run;
}

}  // namespace driftwright::app
