#include "output/fmu/fmu_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/quantity.hpp"
#include "base/shown_units.hpp"
#include "effects/law_steps.hpp"
#include "effects/reading_chain.hpp"
#include "output/fmu/sources/formula.h"
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

static_assert(static_cast<int>(effects::Op::kName) == kFormulaName && static_cast<int>(effects::Op::kMax) == kFormulaMax &&
                  static_cast<int>(effects::Op::kIf) == kFormulaIf && static_cast<int>(effects::Op::kTanh) == kFormulaTanh &&
                  static_cast<int>(effects::Op::kCelsius) == kFormulaCelsius,
              "units have the operations of formulas in the same order");

/// The drive of a law's formula: in its own order (effects::law_names()), and the factor to the units of an importer.
struct FormulaDrive {
  DriveVariable variable;
  double per_importer_unit;
};
constexpr FormulaDrive kFormulaDrive[effects::kDriveNames] = {{DriveVariable::kSpeed, 1.0},
                                                              {DriveVariable::kFeedX, 1.0 / 60e3},
                                                              {DriveVariable::kFeedY, 1.0 / 60e3},
                                                              {DriveVariable::kFeedZ, 1.0 / 60e3},
                                                              {DriveVariable::kCuttingPower, 1.0}};

[[noreturn]] void refuse_law(const Scenario& scenario, const std::string& name, const std::string& why) {
  throw InputError(scenario.machine->where,
                   fmt::format("'{}' {}; no FMU is made of such a machine yet (docs/how-to/fmu.md)", name, why));
}

DriveLaw table_of(const Scenario& scenario, const solver::BoundLaw& law, const std::string& name,
                  const std::vector<DriveRange>& ranges) {
  if (law.thermostat >= 0) refuse_law(scenario, name, "obeys a thermostat");
  std::optional<DriveLaw> table = tabulated([&](const Drive& drive) { return law({.drive = drive}); }, ranges);
  if (!table) refuse_law(scenario, name, "depends on two variables of the drive together, or jumps about");
  return *table;
}

/// Checks that the formula of a law is the law: at drives and temperatures at random, and at rest.
void require_same(const solver::BoundLaw& law, const std::string& name, const std::vector<effects::Expression::Step>& steps,
                  const std::vector<DriveRange>& ranges) {
  constexpr int kTrials = 60;
  constexpr double kSame = 1e-9;  // relative; rounding of a difference of temperatures, and of its root
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.05, 1.0), temperature_K(275.0, 335.0);
  for (int trial = 0; trial < kTrials; ++trial) {
    effects::Inputs at;
    for (const DriveRange& r : ranges) set_value(r.variable, at.drive, trial == 0 ? 0.0 : share(random) * r.most);
    for (std::size_t p = 0; p < law.probes.size(); ++p) at.probe_K.push_back(temperature_K(random));
    double value = 0.0;
    try {
      value = law.law.value(at);
    } catch (const RangeError&) {
      continue;
    }
    const double by_steps = effects::value_of_law_steps(steps, at);
    if (!(std::abs(value - by_steps) <= kSame * (1e-3 + std::abs(value))))
      throw std::logic_error(fmt::format("the formula of '{}' gives {}, not {}", name, by_steps, value));
  }
}

FmuLiveLaw live_law_of(const Scenario& scenario, const solver::ReducedSystem& system, const solver::BoundLaw& law,
                       const std::string& name, const std::vector<DriveRange>& ranges) {
  if (law.thermostat >= 0) refuse_law(scenario, name, "obeys a thermostat");
  if (!law.law.steps)
    refuse_law(scenario, name, "follows temperatures of the machine, and has no formula that a unit can hold");
  const std::vector<effects::Expression::Step> steps = law.law.steps();
  require_same(law, name, steps, ranges);
  FmuLiveLaw live;
  const auto add = [&](effects::Op op, double number) {
    live.steps.push_back(static_cast<double>(static_cast<int>(op)));
    live.steps.push_back(number);
  };
  for (const effects::Expression::Step& s : steps) {
    if (s.op != effects::Op::kName) {
      add(s.op, s.number);
    } else if (s.name >= effects::kDriveNames) {
      add(s.op, static_cast<double>(ranges.size() + s.name - effects::kDriveNames));
    } else {
      const FormulaDrive& drive = kFormulaDrive[s.name];
      const auto at =
          std::find_if(ranges.begin(), ranges.end(), [&](const auto& r) { return r.variable == drive.variable; });
      if (at == ranges.end()) {
        add(effects::Op::kNumber, 0.0);
        continue;
      }
      add(s.op, static_cast<double>(at - ranges.begin()));
      if (drive.per_importer_unit == 1.0) continue;
      add(effects::Op::kNumber, drive.per_importer_unit);
      add(effects::Op::kMultiply, 0.0);
    }
  }
  live.weights.resize(system.size(), static_cast<Eigen::Index>(law.probes.size()));
  for (std::size_t p = 0; p < law.probes.size(); ++p) {
    const solver::Probe& probe = system.probes[static_cast<std::size_t>(law.probes[p])];
    live.weights.col(static_cast<Eigen::Index>(p)) = probe.weights;
    live.ambient_share.push_back(probe.ambient_share);
    live.offset_K.push_back(system.reference_K + probe.offset_K);
  }
  return live;
}

/// A law over the drive at the temperatures of a state; where two variables of the drive act together, at rest.
DriveLaw table_at(const solver::ReducedSystem& system, const solver::BoundLaw& law, const std::vector<DriveRange>& ranges,
                  const Eigen::VectorXd& state, double ambient_K) {
  effects::Inputs at;
  for (int p : law.probes)
    at.probe_K.push_back(system.reference_K + system.probes[static_cast<std::size_t>(p)].theta_K(state, ambient_K));
  const auto value = [&](const Drive& drive) {
    at.drive = drive;
    return law.law.value(at);
  };
  std::optional<DriveLaw> table = tabulated(value, ranges);
  return table ? *std::move(table) : DriveLaw{.at_rest = value({})};
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
/// @param start  of a machine, from which laws that follow temperatures start; null: they are refused
FmuModel model_of(const Scenario& scenario, const solver::ReducedSystem& system, const Eigen::VectorXd* start) {
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
  const auto is_live = [&](const solver::BoundLaw& law, const std::string& name) {
    if (law.looks_at_state() && !start)
      refuse_law(scenario, name,
                 "follows temperatures of the machine, and an observer as an FMU holds laws of the drive alone");
    return law.looks_at_state();
  };
  for (const solver::HeatSource& s : system.sources) {
    if (is_live(s.power_W, s.name)) {
      model.sources.push_back({s.load, {}, live_law_of(scenario, system, s.power_W, s.name, model.drive)});
    } else {
      model.sources.push_back({s.load, table_of(scenario, s.power_W, s.name, model.drive)});
    }
  }
  for (const auto& e : system.exchanges) {
    FmuExchange exchange{.matrix = e.matrix,
                         .to_ambient = e.reaches_ambient() ? e.to_ambient : Eigen::VectorXd(Eigen::VectorXd::Zero(n)),
                         .offset = e.offset.size() > 0 ? e.offset : Eigen::VectorXd(Eigen::VectorXd::Zero(n)),
                         .coefficient = {}};
    if (is_live(e.coefficient, e.name)) {
      exchange.live = live_law_of(scenario, system, e.coefficient, e.name, model.drive);
      exchange.coefficient =
          table_at(system, e.coefficient, model.drive, *start, scenarios::felt_ambient_at_start_K(machine));
    } else {
      exchange.coefficient = table_of(scenario, e.coefficient, e.name, model.drive);
    }
    model.exchanges.push_back(std::move(exchange));
  }
  model.outputs = outputs_of(system.outputs, system.reference_K);
  model.ones = system.ones;
  model.ambient = machine.ambient;
  model.known_drives = drives_of(scenario, model.drive);
  return model;
}

void sum_up_constants(FmuModel& model) {
  std::erase_if(model.sources, [&](const FmuSource& s) {
    if (!s.power_W.terms.empty() || s.live) return false;
    model.constant_load += s.power_W.at_rest * s.load;
    return true;
  });
  std::erase_if(model.exchanges, [&](const FmuExchange& e) {
    if (!e.coefficient.terms.empty() || e.live) return false;
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
  FmuModel model = model_of(scenario, reduced.system, &reduced.start);
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
  FmuModel model = model_of(scenario, state.system, nullptr);
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
