#include "studies/sweep_member.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/quantity.hpp"
#include "machine/as_recorded.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/bind_laws.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_transient.hpp"

namespace driftwright::studies {

double scalar_of(const Record& record, const Channel& channel, scenarios::Scalar scalar, double neutral) {
  const std::vector<double>& values = channel.values;
  const auto peak = std::max_element(values.begin(), values.end(),
                                     [&](double a, double b) { return std::abs(a - neutral) < std::abs(b - neutral); });
  switch (scalar) {
    case scenarios::Scalar::kPeak:
      return *peak;
    case scenarios::Scalar::kTimeOfPeak:
      return record.time_s[static_cast<std::size_t>(peak - values.begin())];
    case scenarios::Scalar::kEnd:
      return values.back();
    case scenarios::Scalar::kMin:
      return *std::min_element(values.begin(), values.end());
    case scenarios::Scalar::kMax:
      return *std::max_element(values.begin(), values.end());
  }
  throw std::logic_error("scalar_of: no such scalar");
}

namespace {

/// The scalars of the named cyclograms, each run once by `run(felt run, output times)`.
template <class Run>
std::vector<double> collected(const scenarios::Scenario& scenario, const solver::Outputs& outputs,
                              const std::vector<scenarios::CollectedScalar>& collect, const Run& run) {
  const scenarios::MachineModel& model = *scenario.machine;
  std::map<std::string, Record> records;
  std::vector<double> results;
  for (const scenarios::CollectedScalar& c : collect) {
    auto found = records.find(c.cyclogram);
    if (found == records.end()) {
      const Cyclogram& cyclogram = scenario.cyclogram(c.cyclogram);
      try {
        const solver::Trajectory trajectory = run(scenarios::felt_run(model, cyclogram),
                                                  scenarios::output_times_s(cyclogram, scenario.solver.output_interval_s));
        found = records.emplace(c.cyclogram, scenarios::as_recorded(model, trajectory, outputs, cyclogram)).first;
      } catch (const SolveError& e) {
        throw SolveError(fmt::format("cyclogram '{}': {}", cyclogram.name, e.what()));
      }
    }
    const double neutral = c.unit == "degC" ? model.reference_K - kZeroCelsius_K : 0.0;
    results.push_back(scalar_of(found->second, found->second.at(c.channel), c.scalar, neutral));
  }
  return results;
}

}  // namespace

std::vector<double> simulate_member(const scenarios::Scenario& scenario, const scenarios::Machine& machine,
                                    const std::vector<scenarios::CollectedScalar>& collect) {
  const Eigen::VectorXd start = scenarios::start_state(*scenario.machine, machine);
  return collected(
      scenario, machine.system.outputs, collect, [&](const MachineRun& felt, const std::vector<double>& times_s) {
        return solver::simulate(machine.system, felt.cyclogram, felt.ambient, times_s, scenario.solver.transient, start);
      });
}

std::vector<double> simulate_member(const scenarios::Scenario& scenario, const scenarios::ReducedMachine& machine,
                                    const std::vector<scenarios::CollectedScalar>& collect) {
  solver::ReducedSystem system = machine.system;
  solver::bind_laws(system, effects::with_radiation_as_films(effects::heat_balance(scenario.machine->effects)));
  std::optional<solver::Propagator> propagator;  // keeps its decompositions between cyclograms
  if (system.is_linear()) propagator.emplace(system);
  return collected(scenario, system.outputs, collect, [&](const MachineRun& felt, const std::vector<double>& times_s) {
    if (propagator) return propagator->run(felt.cyclogram, felt.ambient, times_s, machine.start);
    return solver::simulate(system, felt.cyclogram, felt.ambient, times_s, scenario.solver.transient, machine.start);
  });
}

}  // namespace driftwright::studies
