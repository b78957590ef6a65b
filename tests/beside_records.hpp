#pragma once
// A scenario's twin beside records that another scenario was simulated for, with noise: what a diagnosis is tried on.

#include <optional>

#include "base/random.hpp"
#include "diagnosis/diagnosis.hpp"
#include "diagnosis/scatter.hpp"
#include "scenarios/as_recorded.hpp"
#include "scenarios/machine.hpp"
#include "solver/transient.hpp"
#include "tests/temporary_file.hpp"

namespace driftwright::diagnosis {

inline constexpr double kNoise_K = 0.03, kNoise_um = 0.2;

/// Records of a scenario by the full model, with noise, as files.
inline std::vector<std::string> record(const std::string& path, const std::string& folder) {
  const scenarios::Scenario s = scenarios::read_scenario(path);
  const scenarios::MachineModel& model = *s.machine;
  const scenarios::Machine machine = scenarios::build(model, scenarios::place(model));
  Random random(3, 0);
  std::vector<std::string> paths;
  for (const Cyclogram& c : s.cyclograms) {
    const scenarios::FeltRun felt = scenarios::felt_run(model, c);
    Record r = scenarios::as_recorded(
        model,
        solver::simulate(machine.system, felt.cyclogram, felt.hall, scenarios::output_times_s(c, 60.0),
                         {.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7}, scenarios::start_state(model, machine)),
        machine.system.outputs, c);
    for (Channel& channel : r.channels) {
      const double noise = channel.unit == "degC" && channel.name != "ambient" ? kNoise_K
                           : channel.unit == "um"                              ? kNoise_um
                                                                               : 0.0;
      for (double& v : channel.values) v += noise * random.normal();
    }
    paths.push_back(write_file(folder + "_" + c.name + ".csv", record_csv(r)));
  }
  return paths;
}

/// A twin of a scenario beside records.
struct Beside {
  scenarios::Scenario scenario;
  std::vector<MeasuredRun> runs;
  AugmentedModel augmented;
  scenarios::ReducedMachine machine;
  std::optional<Twin> twin;

  Beside(const std::string& path, const std::vector<std::string>& records) : scenario(scenarios::read_scenario(path)) {
    const scenarios::PlacedMachine placed = scenarios::place(*scenario.machine);
    const solver::Outputs names = scenarios::output_names(*scenario.machine, placed);
    for (const std::string& r : records) runs.push_back(read_measured(r, *scenario.machine, names));
    augmented = augment(scenario, placed.mesh, runs);
    const scenarios::MachineModel& model = augmented.model;
    machine = scenarios::reduce(model, scenarios::build(model, scenarios::place(model)), augmented.plan);
    twin.emplace(augmented, machine, solver::TransientOptions{.relative_tolerance = 1e-5, .absolute_tolerance_K = 1e-4});
  }
  [[nodiscard]] Diagnosis diagnosed(int most_effects) const {
    DiagnosisOptions how;
    how.most_effects = most_effects;
    return diagnose(*twin, nullptr, runs, how, [](const std::string&) {});
  }
};

}  // namespace driftwright::diagnosis
