#include "output/fmu/fmu_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/quantity.hpp"
#include "base/shown_units.hpp"
#include "effects/feed_axis.hpp"
#include "effects/law_steps.hpp"
#include "effects/reading_chain.hpp"
#include "effects/recorded_column.hpp"
#include "output/fmu/learned_states.hpp"
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
    for (const Cyclogram::Section& s : with_places(c, ranges).sections) {
      std::vector<double> x;
      for (const DriveRange& r : ranges) x.push_back(value_of(r.variable, s.drive));
      if (drives.size() < kMost && std::find(drives.begin(), drives.end(), x) == drives.end())
        drives.push_back(std::move(x));
    }
  }
  return drives;
}

/// The drives of the cyclograms, and the places that effects follow: a feed axis' travel, else what the cyclograms reach.
std::vector<DriveRange> inputs_of(const Scenario& scenario) {
  std::vector<DriveRange> ranges = largest_drives(scenario.cyclograms);
  for (std::size_t place = 0; place < effects::kPlaces; ++place) {
    std::optional<DriveRange> range;
    const auto reach = [&](double mm) {
      if (!range) range = {static_cast<DriveVariable>(kDriveVariables + place), mm, mm};
      range->least = std::min(range->least, mm);
      range->most = std::max(range->most, mm);
    };
    bool is_followed = false;
    for (const effects::Effect& e : scenario.machine->effects) {
      if (!effects::follows_positions(e)) continue;
      is_followed = is_followed || effects::place_index(e.words.at("position")) == place;
      if (e.kind->key != "feed_axis") continue;
      if (effects::place_index(e.words.at("position")) == place) reach(e["lowest"]), reach(e["lowest"] + e["travel"]);
      if (effects::place_index(e.words.at("stroke")) == place) reach(0.0), reach(e["travel"]);
    }
    for (const Cyclogram& c : scenario.cyclograms) {
      const Cyclogram::Column* column = is_followed && !range ? c.column(effects::kPlaceNames[place]) : nullptr;
      if (!column) continue;
      const auto [low, high] = std::minmax_element(column->rows.value.begin(), column->rows.value.end());
      reach(*low), reach(*high);
    }
    if (range) ranges.push_back(*range);
  }
  return ranges;
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

/// Checks that the formula of a law is the law: at drives and temperatures at random, and at rest.
void require_same(const solver::BoundLaw& law, const std::string& name, const std::vector<effects::Expression::Step>& steps,
                  const std::vector<DriveRange>& ranges) {
  constexpr int kTrials = 60;
  constexpr double kSame = 1e-9;  // relative; rounding of a difference of temperatures, and of its root
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.05, 1.0), temperature_K(275.0, 335.0);
  for (int trial = 0; trial < kTrials; ++trial) {
    effects::Inputs at;
    for (const DriveRange& r : ranges)
      set_value(r.variable, at.drive, trial == 0 ? r.least : r.least + share(random) * (r.most - r.least));
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

/// A law's formula in the variables of a unit, then its probes.
std::vector<double> formula_of(const solver::BoundLaw& law, const std::string& name, const std::vector<DriveRange>& ranges) {
  const std::vector<effects::Expression::Step> steps = law.law.steps();
  require_same(law, name, steps, ranges);
  std::vector<double> pairs;
  const auto add = [&](effects::Op op, double number) {
    pairs.push_back(static_cast<double>(static_cast<int>(op)));
    pairs.push_back(number);
  };
  for (const effects::Expression::Step& s : steps) {
    if (s.op != effects::Op::kName) {
      add(s.op, s.number);
    } else if (s.name >= effects::kDriveNames && s.name < effects::kFirstPlace) {
      add(s.op, static_cast<double>(ranges.size() + s.name - effects::kDriveNames));
    } else {
      const FormulaDrive drive =
          s.name < effects::kDriveNames
              ? kFormulaDrive[s.name]
              : FormulaDrive{static_cast<DriveVariable>(kDriveVariables + s.name - effects::kFirstPlace), 1.0};
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
  return pairs;
}

FmuLiveLaw live_law_of(const Scenario& scenario, const solver::ReducedSystem& system, const solver::BoundLaw& law,
                       const std::string& name, const std::vector<DriveRange>& ranges) {
  if (!law.law.steps)
    refuse_law(scenario, name, "follows temperatures of the machine, and has no formula that a unit can hold");
  FmuLiveLaw live{.steps = formula_of(law, name, ranges)};
  live.weights.resize(system.size(), static_cast<Eigen::Index>(law.probes.size()));
  for (std::size_t p = 0; p < law.probes.size(); ++p) {
    const solver::Probe& probe = system.probes[static_cast<std::size_t>(law.probes[p])];
    live.weights.col(static_cast<Eigen::Index>(p)) = probe.weights;
    live.ambient_share.push_back(probe.ambient_share);
    live.offset_K.push_back(system.reference_K + probe.offset_K);
  }
  return live;
}

/// A law of the drive as a table, or as a formula where variables act together.
void set_law_of_drive(const Scenario& scenario, const solver::BoundLaw& law, const std::string& name,
                      const std::vector<DriveRange>& ranges, bool takes_formulas, DriveLaw& table, FmuFormula& formula) {
  if (auto found = tabulated([&](const Drive& drive) { return law({.drive = drive}); }, ranges)) {
    table = *std::move(found);
  } else if (takes_formulas && law.law.steps) {
    formula = formula_of(law, name, ranges);
  } else {
    refuse_law(scenario, name, "depends on two variables of the drive together, or jumps about, and has no formula");
  }
}

/// What positions add to outputs. @param system  whose outputs contain mean temperatures  @param kept  those of the unit
std::vector<FmuAlong> along_of(const MachineModel& machine, const solver::Outputs& outputs,
                               const std::vector<FmuOutput>& kept, const std::vector<DriveRange>& ranges) {
  std::vector<FmuAlong> list;
  const Eigen::Index n = outputs.state.rows();
  for (const effects::Effect& e : machine.effects) {
    const std::optional<effects::ErrorAlong> error = effects::error_along(e);
    if (!error) continue;
    Eigen::MatrixXd means = Eigen::MatrixXd::Zero(n + 1, static_cast<Eigen::Index>(error->bodies.size()));
    for (std::size_t b = 0; b < error->bodies.size(); ++b) {
      auto mean = means.col(static_cast<Eigen::Index>(b));
      if (error->bodies[b] == effects::ambient_node()) {
        mean[n] = 1.0;
        continue;
      }
      const auto name = std::find(outputs.name.begin(), outputs.name.end(), effects::mean_output(error->bodies[b].name));
      if (name == outputs.name.end()) throw std::logic_error("a mean temperature is no output of the model");
      const Eigen::Index at = name - outputs.name.begin();
      mean << outputs.state.col(at), outputs.ambient[at];
    }
    const auto weights = [&](double mm) {
      const std::vector<double> w = error->weights_m_K(mm);
      return Eigen::VectorXd(means * Eigen::Map<const Eigen::VectorXd>(w.data(), static_cast<Eigen::Index>(w.size())));
    };
    const auto output =
        std::find_if(kept.begin(), kept.end(), [&](const FmuOutput& o) { return o.name == error->displacement; });
    const auto variable = std::find_if(ranges.begin(), ranges.end(), [&](const DriveRange& r) {
      return is_place(r.variable) && place_of(r.variable) == effects::place_index(error->position);
    });
    FmuAlong along{.output = static_cast<int>(output - kept.begin()), .ends_mm = error->ends_mm};
    if (!error->position.empty()) along.variable = static_cast<int>(variable - ranges.begin());
    if (along.ends_mm.empty() && error->position.empty()) along.ends_mm = {0.0, 1.0};  // the same wherever
    if (along.ends_mm.empty()) along.ends_mm = {variable->least, std::max(variable->most, variable->least + 1.0)};
    for (std::size_t k = 0; k + 1 < along.ends_mm.size(); ++k) {
      const double begin_mm = along.ends_mm[k], third_mm = (along.ends_mm[k + 1] - begin_mm) / 3.0;
      Eigen::MatrixXd at(n + 1, 4);  // at thirds of the piece, then their differences: Newton's cubic
      for (int j = 0; j < 4; ++j) at.col(j) = weights(begin_mm + j * third_mm);
      for (int order = 1; order < 4; ++order) {
        for (int j = 3; j >= order; --j) at.col(j) = (at.col(j) - at.col(j - 1)).eval() / (order * third_mm);
      }
      const double h = third_mm;
      const Eigen::VectorXd power[] = {at.col(0), at.col(1) - h * at.col(2) + 2.0 * h * h * at.col(3),
                                       at.col(2) - 3.0 * h * at.col(3), at.col(3)};
      for (const Eigen::VectorXd& row : power) along.cubics.insert(along.cubics.end(), row.begin(), row.end());
    }
    list.push_back(std::move(along));
  }
  return list;
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
  if (!system.thermostats.empty() && !start)
    throw InputError(machine.where,
                     fmt::format("thermostat '{}' switches, and an observer as an FMU does not (docs/how-to/fmu.md)",
                                 system.thermostats.front().name));
  if (!system.change_times_s.empty())
    throw InputError(machine.where,
                     "a law changes with time on its own; no FMU is made of such a machine yet (docs/how-to/fmu.md)");
  FmuModel model{.name = scenario.name, .drive = inputs_of(scenario), .reference_K = system.reference_K};
  const Eigen::Index n = system.size();
  model.conduction = system.conduction;
  model.constant_load = model.ambient_load = Eigen::VectorXd::Zero(n);
  const auto is_live = [&](const solver::BoundLaw& law, const std::string& name) {
    if (law.looks_at_state() && !start)
      refuse_law(scenario, name,
                 "follows temperatures of the machine, and an observer as an FMU holds laws of the drive alone");
    return law.looks_at_state();
  };
  for (const solver::Thermostat& t : system.thermostats) {
    const solver::Probe& probe = system.probes[static_cast<std::size_t>(t.probe)];
    model.thermostats.push_back(
        {t.name, t.on_above_K, t.off_below_K, probe.weights, probe.ambient_share, system.reference_K + probe.offset_K});
  }
  for (const solver::HeatSource& s : system.sources) {
    if (is_live(s.power_W, s.name)) {
      if (s.power_W.thermostat >= 0) refuse_law(scenario, s.name, "obeys a thermostat, and follows temperatures besides");
      model.sources.push_back({s.load, {}, live_law_of(scenario, system, s.power_W, s.name, model.drive)});
    } else {
      FmuSource source{.load = s.load, .power_W = {}, .thermostat = s.power_W.thermostat};
      set_law_of_drive(scenario, s.power_W, s.name, model.drive, start != nullptr, source.power_W, source.formula);
      model.sources.push_back(std::move(source));
    }
  }
  for (const auto& e : system.exchanges) {
    FmuExchange exchange{.matrix = e.matrix,
                         .to_ambient = e.reaches_ambient() ? e.to_ambient : Eigen::VectorXd(Eigen::VectorXd::Zero(n)),
                         .offset = e.offset.size() > 0 ? e.offset : Eigen::VectorXd(Eigen::VectorXd::Zero(n)),
                         .coefficient = {}};
    if (e.coefficient.thermostat >= 0) refuse_law(scenario, e.name, "is an exchange that obeys a thermostat");
    if (is_live(e.coefficient, e.name)) {
      exchange.live = live_law_of(scenario, system, e.coefficient, e.name, model.drive);
      exchange.coefficient =
          table_at(system, e.coefficient, model.drive, *start, scenarios::felt_ambient_at_start_K(machine));
    } else {
      set_law_of_drive(scenario, e.coefficient, e.name, model.drive, start != nullptr, exchange.coefficient,
                       exchange.formula);
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
    if (!s.power_W.terms.empty() || s.live || !s.formula.empty() || s.thermostat >= 0) return false;
    model.constant_load += s.power_W.at_rest * s.load;
    return true;
  });
  std::erase_if(model.exchanges, [&](const FmuExchange& e) {
    if (!e.coefficient.terms.empty() || e.live || !e.formula.empty()) return false;
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
    const bool is_of_positions = effects::follows_positions(e), is_learned = e.kind->key == "learned";
    if (is_of_positions) {
      try {
        (void)effects::error_along(e);
      } catch (const RangeError& wrong) {
        refuse(e, fmt::format("cannot be read out at the nut: {}", wrong.what()));
      }
    }
    if (effects::changes_readings(e) && !is_of_positions && !is_learned)
      refuse(e, "acts on what instruments say, and an FMU holds the machine alone");
    if (effects::changes_drive(e) && !is_of_positions)
      refuse(e, e.kind->contribute ? "follows what the drive was before, and an FMU knows it as it is"
                                   : "says that drive or ambient were recorded wrongly, and an FMU is given the true ones");
    if (!e.in.empty() || e.from_s > 0.0 || e.until_s < effects::kNever_s)
      refuse(e, "acts for a time or in one cyclogram alone, and an FMU knows neither");
  }
  for (const Cyclogram& c : scenario.cyclograms) {
    for (const std::string& column : scenarios::wanted_columns(machine, c.name)) {
      if (effects::place_index(column) < effects::kPlaces) continue;
      throw InputError(machine.where,
                       fmt::format("an effect follows the recorded column '{}', which is no input of an FMU yet "
                                   "(docs/how-to/fmu.md)",
                                   column));
    }
  }
}

Cyclogram with_places(Cyclogram cyclogram, const std::vector<DriveRange>& drive) {
  for (const DriveRange& r : drive) {
    if (is_place(r.variable)) cyclogram = effects::with_signal(cyclogram, effects::kPlaceNames[place_of(r.variable)], 0.0);
  }
  return cyclogram;
}

FmuModel machine_fmu(const Scenario& scenario, const scenarios::ReducedMachine& reduced) {
  const MachineModel& machine = *scenario.machine;
  FmuModel model = model_of(scenario, reduced.system, &reduced.start);
  std::erase_if(model.outputs,
                [](const FmuOutput& o) { return effects::is_mean_output(o.name); });  // no instrument reads them
  model.along = along_of(machine, reduced.system.outputs, model.outputs, model.drive);
  model.start = reduced.start;
  add_learned(model, machine);
  sum_up_constants(model);
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
  for (const effects::Effect& e : scenario.machine->effects) {
    if (effects::follows_positions(e))
      throw InputError(e.where, fmt::format("{} follows positions, and an observer as an FMU has no such input "
                                            "(docs/how-to/fmu.md)",
                                            e.name()));
    if (e.kind->key == "learned")
      throw InputError(e.where, fmt::format("{} adds to what the physics give, and an observer as an FMU holds the physics "
                                            "alone (docs/how-to/fmu.md)",
                                            e.name()));
  }
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
