#include "output/twin/twin_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/reader/felt_run.hpp"
#include "solver/reduced_model.hpp"
#include "solver/steady_state.hpp"

namespace driftwright::output {
namespace {

using scenarios::MachineModel;
using scenarios::Scenario;

constexpr std::size_t kMostTimes = 200;  // most times at which laws change
constexpr double kColder_K = 25.0,
                 kWarmer_K =
                     90.0;  // below and above ambient and reference: range in which laws of temperature are tabulated

TemperatureRange temperatures_of(const MachineModel& machine) {
  const auto [low, high] = std::minmax_element(machine.ambient.value.begin(), machine.ambient.value.end());
  return {.low_K = machine.reference_K + std::min(0.0, *low) - kColder_K,
          .high_K = machine.reference_K + std::max(0.0, *high) + kWarmer_K,
          .usual_K = machine.reference_K};
}

bool is_equal(const DriveLaw& a, const DriveLaw& b) {
  return a.at_rest == b.at_rest && a.terms.size() == b.terms.size() &&
         std::equal(a.terms.begin(), a.terms.end(), b.terms.begin(), [](const LawTerm& x, const LawTerm& y) {
           return x.variable == y.variable && x.log_x == y.log_x && x.coefficients == y.coefficients;
         });
}
bool is_equal(const TwinLaw& a, const TwinLaw& b) {
  return is_equal(a.drive, b.drive) && a.tables.size() == b.tables.size() &&
         std::equal(a.tables.begin(), a.tables.end(), b.tables.begin(), [](const TwinTable& x, const TwinTable& y) {
           return x.at.size() == y.at.size() &&
                  std::equal(x.at.begin(), x.at.end(), y.at.begin(),
                             [](const DriveLaw& l, const DriveLaw& r) { return is_equal(l, r); });
         });
}

/// A time within each stretch between the times of change.
std::vector<double> middles_of(const std::vector<double>& change_times_s) {
  std::vector<double> middles_s = {change_times_s.empty() ? 0.0 : 0.5 * change_times_s.front()};
  for (std::size_t i = 0; i < change_times_s.size(); ++i)
    middles_s.push_back(i + 1 < change_times_s.size() ? 0.5 * (change_times_s[i] + change_times_s[i + 1])
                                                      : change_times_s[i] + 1.0);
  return middles_s;
}

TwinTimedLaw timed_law(const Scenario& scenario, const solver::BoundLaw& bound, const std::string& name,
                       const TwinModel& model, const std::vector<double>& change_times_s) {
  TwinTimedLaw timed{.probes = bound.probes, .thermostat = bound.thermostat};
  for (double time_s : middles_of(change_times_s)) {
    const auto law = [&](const Drive& drive, const std::vector<double>& probe_K) {
      effects::Inputs at{.drive = drive, .time_s = time_s, .probe_K = probe_K};
      if (bound.probes.empty()) at.probe_K = bound.frozen_K;
      return bound.law(at);
    };
    std::optional<TwinLaw> table =
        twin_law(law, static_cast<int>(bound.probes.size()), model.drive, temperatures_of(*scenario.machine));
    if (!table)
      throw InputError(
          scenario.machine->where,
          fmt::format(
              "'{}' depends on temperatures, or on variables of the drive, together in a way that no "
              "table of two of them holds, or jumps about; no page is made of such a machine yet (docs/how-to/view.md)",
              name));
    auto known = std::find_if(timed.laws.begin(), timed.laws.end(), [&](const TwinLaw& l) { return is_equal(l, *table); });
    timed.of_stretch.push_back(static_cast<int>(known - timed.laws.begin()));
    if (known == timed.laws.end()) timed.laws.push_back(std::move(*table));
  }
  return timed;
}

std::vector<std::string> notes_of(const MachineModel& machine) {
  std::vector<std::string> notes;
  for (const effects::Effect& e : machine.effects) {
    if (effects::changes_readings(e))
      notes.push_back(fmt::format(
          "{} {}", e.name(),
          e.kind->key == "learned" ? "adds what was learned from records; here the physics are alone, and so is their band."
                                   : "acts on what instruments say; here they say what is."));
    if (effects::changes_drive(e))
      notes.push_back(fmt::format(
          "{} {}", e.name(),
          e.kind->key == "heat_source" && e.has("lasts") ? "comes after each stop of the spindle; here it never comes."
          : e.kind->contribute                           ? "follows what the drive was before; here it is as it is set."
                               : "changes the recorded drive or ambient; here both are as they are set."));
    if (!e.in.empty())
      notes.push_back(fmt::format("{} acts in the cyclogram '{}' alone, and here not at all.", e.name(), e.in));
  }
  return notes;
}

}  // namespace

Scenario as_the_page_has_it(Scenario scenario) {
  std::erase_if(scenario.machine->effects, [](const effects::Effect& e) {
    return !e.kind->contribute && (effects::changes_readings(e) || effects::changes_drive(e));
  });
  return scenario;
}

TwinModel twin_model(const Scenario& scenario, const solver::ReducedSystem& system, const Eigen::VectorXd& start) {
  const MachineModel& machine = *scenario.machine;
  if (!system.mass.isIdentity(1e-8)) throw std::logic_error("twin_model: the mass matrix must be the unit matrix");
  for (const Cyclogram& c : scenario.cyclograms) {
    scenarios::require_resting(machine.axes, c);
    if (const auto columns = scenarios::wanted_columns(machine, c.name); !columns.empty())
      throw InputError(machine.where,
                       fmt::format("an effect follows the recorded column '{}', which is no input of the page "
                                   "yet (docs/how-to/view.md)",
                                   columns.front()));
  }
  if (system.change_times_s.size() > kMostTimes)
    throw InputError(machine.where,
                     fmt::format("laws change {} times on their own; the page holds up to {} (docs/how-to/view.md)",
                                 system.change_times_s.size(), kMostTimes));
  TwinModel model{.drive = largest_drives(scenario.cyclograms),
                  .system = system,
                  .start = start,
                  .ambient = machine.ambient,
                  .notes = notes_of(machine)};
  for (const solver::HeatSource& s : system.sources)
    model.powers_W.push_back(timed_law(scenario, s.power_W, s.name, model, system.change_times_s));
  for (const auto& e : system.exchanges)
    model.coefficients.push_back(timed_law(scenario, e.coefficient, e.name, model, system.change_times_s));
  return model;
}

LumpedSystem lumped_system(const MachineModel& model) {
  const scenarios::Machine machine = scenarios::build(model, scenarios::place(model), false);
  for (const solver::FixedUnknowns& f : machine.system.fixed) {
    if (!f.follows_ambient && f.theta.value.size() > 1)
      throw InputError(
          model.where,
          fmt::format("{} is prescribed over time; no page is made of such a machine yet (docs/how-to/view.md)", f.name));
  }
  solver::FullSystem system = machine.system;
  solver::hold_by_exchanges(system);
  const Eigen::Index n = system.size();
  const Eigen::MatrixXd basis = solver::orthonormalise(system.mass, Eigen::MatrixXd::Identity(n, n));
  Eigen::VectorXd start = scenarios::start_state(model, machine);
  for (const solver::FixedUnknowns& f : machine.system.fixed) {  // prescribed values jump at once, as in simulate()
    for (int i : f.unknowns) start[i] = f.follows_ambient ? scenarios::felt_ambient_at_start_K(model) : f.theta.at(0.0);
  }
  return {.system = solver::project(system, basis),
          .start = basis.transpose() * (system.mass * start),
          .node_temperature = basis};
}

}  // namespace driftwright::output
