#include "studies/mesh_convergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "machine/simulated_run.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::studies {
namespace {

/// Error of the model itself in the unit of a channel [K, um, urad]: 0 for the finite elements.
double resolution_of(const scenarios::SolverSettings& solver, const std::string& unit) {
  if (solver.model == scenarios::ModelKind::kFull) return 0.0;
  // per kelvin, as in the meaning of reduction_tolerance_K
  const double per_K = unit == "um" ? 2.0 : unit == "urad" ? 20.0 : 1.0;
  return per_K * solver.reduction_tolerance_K;
}

bool is_thermometer(const scenarios::MachineModel& machine, const Channel& channel) {
  return std::any_of(machine.sensors.begin(), machine.sensors.end(), [&](const scenarios::Sensor& sensor) {
    return sensor.name == channel.name && !scenarios::is_on_ambient(sensor);
  });
}

/// Values of a channel above `zero`, at the end and at the peak in each direction.
struct Extremes {
  double end, lowest, highest;
};
Extremes extremes_of(const Channel& channel, double zero) {
  const auto [low, high] = std::minmax_element(channel.values.begin(), channel.values.end());
  return {channel.values.back() - zero, *low - zero, *high - zero};
}

void add_values(MeshConvergence& found, const scenarios::SolverSettings& solver, const std::array<Record, 3>& records,
                const Channel& of_finest, bool is_temperature) {
  const std::string unit = is_temperature ? "K" : of_finest.unit;
  std::array<Extremes, 3> extremes{};
  std::array<double, 3> sizes{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Channel& channel = records[k].at(of_finest.name);
    extremes[k] = extremes_of(channel, is_temperature ? channel.values.front() : 0.0);
    sizes[k] = found.levels[k].size_m;
  }
  const bool is_high = std::abs(extremes[2].highest) >= std::abs(extremes[2].lowest);
  for (bool is_peak : {false, true}) {
    ConvergedValue value{.channel = of_finest.name, .unit = unit, .is_peak = is_peak, .values = {}, .convergence = {}};
    for (std::size_t k = 0; k < 3; ++k)
      value.values[k] = !is_peak ? extremes[k].end : is_high ? extremes[k].highest : extremes[k].lowest;
    value.convergence = grid_convergence(value.values, sizes, found.highest_order, resolution_of(solver, unit));
    found.values.push_back(std::move(value));
  }
}

}  // namespace

MeshConvergence mesh_convergence(const scenarios::Scenario& scenario, const Cyclogram& cyclogram, int most_elements,
                                 const Listener& listener) {
  using Clock = std::chrono::steady_clock;
  const scenarios::MachineModel& machine = scenarios::require_machine(scenario, "mesh --convergence");
  const MeshLadder ladder = mesh_ladder(machine.mesh, most_elements, listener);
  MeshConvergence found{.cyclogram = cyclogram.name,
                        .model = scenario.solver.model == scenarios::ModelKind::kFull ? "full" : "reduced",
                        .highest_order = element_order(machine.mesh) + 1.0,
                        .levels = {},
                        .own = ladder.own,
                        .values = {}};
  std::array<Record, 3> records;
  for (std::size_t k = 0; k < 3; ++k) {
    const MeshRung& rung = ladder.rungs[k];
    Listener of_mesh = listener;
    of_mesh.on_begin = [&](const std::string& work) {
      listener.begin(fmt::format("mesh {} of 3, {} elements: {}", k + 1, rung.n_elements, work));
    };
    scenarios::Scenario meshed = scenario;
    if (k != ladder.own) {
      meshed.machine->mesh = rung.recipe;
      meshed.machine->written += fmt::format("\nmesh size times {}\n", rung.factor);  // the key of the reduced model on disk
    }
    const Clock::time_point began = Clock::now();
    const scenarios::Model model = scenarios::open_model(meshed, {&cyclogram}, of_mesh, false);
    records[k] = std::move(scenarios::simulate_cyclograms(meshed, model, {&cyclogram}, of_mesh).front().record);
    found.levels[k] = {.factor = rung.factor,
                       .size_m = rung.size_m,
                       .n_elements = rung.n_elements,
                       .n_unknowns = model.n_unknowns(),
                       .seconds = std::chrono::duration<double>(Clock::now() - began).count(),
                       .was_known = model.was_known};
  }
  for (const Channel& channel : records[2].channels) {
    const bool is_temperature = channel.unit == "degC" && is_thermometer(machine, channel);
    if (is_temperature || channel.unit == "um" || channel.unit == "urad")
      add_values(found, scenario.solver, records, channel, is_temperature);
  }
  return found;
}

const ConvergedValue* worst_displacement(const MeshConvergence& found) {
  const ConvergedValue* worst = nullptr;
  double worst_share = -1.0;
  for (std::size_t i = 0; i + 1 < found.values.size(); i += 2) {  // the end of a channel, then its peak
    const double largest = std::max(std::abs(found.values[i].values[2]), std::abs(found.values[i + 1].values[2]));
    for (std::size_t j : {i + 1, i}) {
      const ConvergedValue& value = found.values[j];
      if (value.unit == "K" || largest == 0.0 || value.convergence.kind == Convergence::kUnresolved) continue;
      const double share = value.convergence.error[found.own] / largest;
      if (share > worst_share) {
        worst_share = share;
        worst = &value;
      }
    }
  }
  return worst;
}

}  // namespace driftwright::studies
