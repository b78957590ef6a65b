#include "output/fmu/fmu_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/quantity.hpp"
#include "base/shown_units.hpp"
#include "effects/reading_chain.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::output {
namespace {

using scenarios::MachineModel;
using scenarios::Scenario;

std::vector<std::vector<double>> drives_of(const Scenario& scenario, const std::vector<DriveRange>& ranges) {
  constexpr std::size_t kMost = 24;  // each needs a decomposition; others are decomposed when they occur
  std::vector<std::vector<double>> drives;
  for (const Cyclogram& c : scenario.cyclograms) {
    for (const Cyclogram::Section& s : c.sections) {
      std::vector<double> x;
      for (const DriveRange& r : ranges) x.push_back(value_of(r.variable, s.drive));
      if (drives.size() < kMost && std::find(drives.begin(), drives.end(), x) == drives.end())
        drives.push_back(std::move(x));
    }
  }
  return drives;
}

DriveLaw table_of(const Scenario& scenario, const solver::BoundLaw& law, const std::string& name,
                  const std::vector<DriveRange>& ranges) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(scenario.machine->where,
                     fmt::format("'{}' {}; no FMU is made of such a machine yet (docs/how-to/fmu.md)", name, why));
  };
  if (law.thermostat >= 0) refuse("obeys a thermostat");
  if (law.looks_at_state()) refuse("follows temperatures of the machine");
  std::optional<DriveLaw> table = tabulated([&](const Drive& drive) { return law({.drive = drive}); }, ranges);
  if (!table) refuse("depends on two variables of the drive together, or jumps about");
  return *table;
}

std::vector<FmuOutput> outputs_of(const solver::Outputs& outputs, double reference_K) {
  std::vector<FmuOutput> list;
  for (std::size_t o = 0; o < outputs.name.size(); ++o) {
    const auto column = static_cast<Eigen::Index>(o);
    const bool is_temperature = outputs.unit[o] == "K";
    list.push_back({.name = outputs.name[o],
                    .unit = shown_reading_unit(outputs.unit[o]),
                    .state = outputs.state.col(column),
                    .ambient = outputs.ambient[column],
                    .factor = shown_scale(outputs.unit[o]),
                    .offset = is_temperature ? reference_K - kZeroCelsius_K : 0.0});
  }
  return list;
}

/// All of the model except the start and the parts of one kind only; sources and exchanges are kept separate.
FmuModel model_of(const Scenario& scenario, const solver::ReducedSystem& system) {
  const MachineModel& machine = *scenario.machine;
  if (!system.mass.isIdentity(1e-8)) throw std::logic_error("machine_fmu: the mass matrix must be the unit matrix");
  if (!system.thermostats.empty())
    throw InputError(machine.where,
                     fmt::format("thermostat '{}' switches; no FMU is made of such a machine yet (docs/how-to/fmu.md)",
                                 system.thermostats.front().name));
  if (!system.change_times_s.empty())
    throw InputError(machine.where,
                     "a law changes with time on its own; no FMU is made of such a machine yet (docs/how-to/fmu.md)");
  FmuModel model{.name = scenario.name, .drive = largest_drives(scenario.cyclograms), .reference_K = system.reference_K};
  const Eigen::Index n = system.size();
  model.conduction = system.conduction;
  model.constant_load = model.ambient_load = Eigen::VectorXd::Zero(n);
  for (const solver::HeatSource& s : system.sources)
    model.sources.push_back({s.load, table_of(scenario, s.power_W, s.name, model.drive)});
  for (const auto& e : system.exchanges) {
    model.exchanges.push_back({.matrix = e.matrix,
                               .to_ambient = e.reaches_ambient() ? e.to_ambient : Eigen::VectorXd(Eigen::VectorXd::Zero(n)),
                               .offset = e.offset.size() > 0 ? e.offset : Eigen::VectorXd(Eigen::VectorXd::Zero(n)),
                               .coefficient = table_of(scenario, e.coefficient, e.name, model.drive)});
  }
  model.outputs = outputs_of(system.outputs, system.reference_K);
  model.ones = system.ones;
  model.ambient = machine.ambient;
  model.known_drives = drives_of(scenario, model.drive);
  return model;
}

void sum_up_constants(FmuModel& model) {
  std::erase_if(model.sources, [&](const FmuSource& s) {
    if (s.power_W.terms.empty()) model.constant_load += s.power_W.at_rest * s.load;
    return s.power_W.terms.empty();
  });
  std::erase_if(model.exchanges, [&](const FmuExchange& e) {
    if (!e.coefficient.terms.empty()) return false;
    const double c = e.coefficient.at_rest;
    model.conduction += c * e.matrix;
    model.ambient_load += c * e.to_ambient;
    model.constant_load += c * e.offset;
    return true;
  });
}

}  // namespace

void require_exportable(const Scenario& scenario) {
  const MachineModel& machine = *scenario.machine;
  const auto refuse = [](const effects::Effect& e, const std::string& why) {
    throw InputError(e.where,
                     fmt::format("{} {}; leave it out of what is exported as an FMU (docs/how-to/fmu.md)", e.name(), why));
  };
  for (const effects::Effect& e : machine.effects) {
    if (effects::changes_readings(e)) refuse(e, "acts on what instruments say, and an FMU holds the machine alone");
    if (effects::changes_drive(e))
      refuse(e, e.kind->contribute ? "follows what the drive was before, and an FMU knows it as it is"
                                   : "says that drive or ambient were recorded wrongly, and an FMU is given the true ones");
    if (!e.in.empty() || e.from_s > 0.0 || e.until_s < effects::kNever_s)
      refuse(e, "acts for a time or in one cyclogram alone, and an FMU knows neither");
  }
  for (const Cyclogram& c : scenario.cyclograms) {
    if (const auto columns = scenarios::wanted_columns(machine, c.name); !columns.empty())
      throw InputError(machine.where,
                       fmt::format("an effect follows the recorded column '{}', which is no input of an FMU yet "
                                   "(docs/how-to/fmu.md)",
                                   columns.front()));
  }
}

FmuModel machine_fmu(const Scenario& scenario, const scenarios::ReducedMachine& reduced) {
  const MachineModel& machine = *scenario.machine;
  FmuModel model = model_of(scenario, reduced.system);
  std::erase_if(model.outputs,
                [](const FmuOutput& o) { return effects::is_mean_output(o.name); });  // no instrument reads them
  sum_up_constants(model);
  model.start = reduced.start;
  model.start_ambient_K = scenarios::felt_ambient_at_start_K(machine);
  model.start_follows_ambient = machine.start == scenarios::Start::kAmbient || machine.start == scenarios::Start::kSteady;
  model.description = fmt::format(
      "Thermal drift of a machine tool: reduced model of {} states for {} temperature unknowns, estimated to miss them by "
      "at most "
      "{:.2g} K and {:.2g} um",
      reduced.system.size(), reduced.n_unknowns, reduced.error.temperature_K, 1e6 * reduced.error.displacement_m);
  return model;
}

FmuModel observer_fmu(const Scenario& scenario, const compensation::Observer& observer,
                      const std::optional<probe_process>& probing) {
  compensation::Observer::State state = observer.state();
  FmuModel model = model_of(scenario, state.system);
  model.start = state.start;
  model.start_ambient_K = state.start_ambient_K;
  model.start_follows_ambient = true;
  FmuObserver o{.sensors = state.sensors, .settings = state.settings, .factors = state.factors, .probing = probing};
  const auto index_of = [&](const std::string& name) {
    const auto at =
        std::find_if(model.outputs.begin(), model.outputs.end(), [&](const auto& out) { return out.name == name; });
    return static_cast<int>(at - model.outputs.begin());
  };
  for (const std::string& sensor : state.sensors) o.sensor_output.push_back(index_of(sensor));
  o.drift_output = index_of(state.drift);
  model.description =
      fmt::format("State observer of the drift '{}' of a machine tool by {} thermometers, a sample every {:g} s",
                  state.drift, state.sensors.size(), state.settings.period_s);
  model.observer = std::move(o);
  return model;
}

}  // namespace driftwright::output
