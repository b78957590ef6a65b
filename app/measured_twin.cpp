#include "app/measured_twin.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/results.hpp"
#include "base/errors.hpp"

namespace driftwright::app {
namespace {

/// Sizes, over the machine's own, of the mesh that tells what the mesh itself does. Not every size can be meshed: the first that can.
constexpr double kOtherSizes[] = {1.4, 1.25, 1.6, 1.15, 0.85};

/// The machine on another mesh, or none where there is no mesh of ours to change.
std::optional<scenarios::Scenario> remeshed(const scenarios::Scenario& scenario, double size) {
  const auto* mill = std::get_if<mesh::KneeMill>(&scenario.machine->mesh);
  if (!mill) return std::nullopt;
  scenarios::Scenario coarse = scenario;
  auto& own = std::get<mesh::KneeMill>(coarse.machine->mesh);
  own.coarse_m *= size;
  own.fine_m *= size;
  coarse.machine->written += fmt::format("\nmesh size times {}\n", size);
  return coarse;
}

/// Names of what the scenario's instruments tell, before there is a model.
solver::Outputs output_names(const scenarios::MachineModel& model, const scenarios::PlacedMachine& placed) {
  solver::Outputs names;
  for (const auto& s : model.sensors) {
    names.name.push_back(s.name);
    names.unit.emplace_back("K");
  }
  for (const auto& d : model.displacements) {
    names.name.push_back(d.name);
    names.unit.emplace_back("m");
  }
  for (const auto& t : model.tilts) {
    names.name.push_back(t.name);
    names.unit.emplace_back("rad");
  }
  names.hall = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.name.size()));
  for (std::size_t i = 0; i < placed.sensor_weights.size(); ++i) {
    if (placed.sensor_weights[i].empty()) names.hall[static_cast<Eigen::Index>(i)] = 1.0;
  }
  return names;
}

}  // namespace

MeasuredTwin open_measured_twin(const scenarios::Scenario& scenario, const std::string& verb,
                                const std::vector<std::string>& measured, Progress& progress) {
  const scenarios::MachineModel& model = require_machine(scenario, verb);
  MeasuredTwin m;
  m.scenario = scenario;
  progress.begin("meshing");
  const scenarios::PlacedMachine placed = scenarios::place(model);
  m.mesh = placed.mesh;
  const solver::Outputs names = output_names(model, placed);
  for (const std::string& path : measured) m.runs.push_back(diagnosis::read_measured(path, model, names));

  const auto open = [&](const scenarios::Scenario& of) {
    auto parts = std::make_unique<TwinParts>(TwinParts{diagnosis::augment(of, m.mesh, m.runs), {}});
    parts->machine = open_reduced(parts->augmented.model, parts->augmented.plan, progress);
    return parts;
  };
  m.fine = open(scenario);
  const solver::TransientOptions tolerances = scenario.solver.transient;
  m.twin.emplace(m.fine->augmented, m.fine->machine, tolerances);
  for (double size : kOtherSizes) {
    const auto other = remeshed(scenario, size);
    if (!other) break;
    try {
      m.other = open(*other);
    } catch (const SolveError&) {  // no mesh of that size
      continue;
    }
    m.on_other_mesh.emplace(m.other->augmented, m.other->machine, tolerances);
    m.how.mesh_error_share = 1.0 / std::abs(size * size - 1.0);
    break;
  }
  const auto& error = m.fine->machine.error;
  m.how.floor_K = std::max(m.how.floor_K, 0.3 * error.temperature_K);
  m.how.floor_m = std::max(m.how.floor_m, 0.3 * error.displacement_m);
  m.how.floor_rad = std::max(m.how.floor_rad, 0.3 * error.angle_rad);
  return m;
}

}  // namespace driftwright::app
