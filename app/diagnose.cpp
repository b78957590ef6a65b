#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/diagnosis_json.hpp"
#include "app/results.hpp"
#include "app/verbs.hpp"
#include "diagnosis/focus.hpp"
#include "diagnosis/scatter.hpp"
#include "output/json_text.hpp"

namespace driftwright::app {
namespace {

/// Sizes, over the machine's own, of the mesh that tells what the mesh itself does. Not every size can be meshed: the first that can.
constexpr double kOtherSizes[] = {1.4, 1.25, 1.6, 1.15, 0.85};

/// The machine on another mesh, or none where there is no mesh of ours to change.
std::optional<scenarios::Scenario> remeshed(const scenarios::Scenario& scenario, double size) {
  scenarios::Scenario other = scenario;
  if (auto* mill = std::get_if<mesh::KneeMill>(&other.machine->mesh)) {
    mill->coarse_m *= size;
    mill->fine_m *= size;
  } else if (auto* imported = std::get_if<mesh::ImportedMesh>(&other.machine->mesh);
             imported && imported->mesh_size_m > 0.0) {
    imported->mesh_size_m *= size;  // a drawing
    for (auto& [region, size_m] : imported->mesh_size_of_region_m) size_m *= size;
  } else {
    return std::nullopt;
  }
  other.machine->written += fmt::format("\nmesh size times {}\n", size);
  return other;
}

struct TwinParts {
  diagnosis::AugmentedModel augmented;
  scenarios::ReducedMachine machine;
};

}  // namespace

void diagnose(const DiagnoseOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  const scenarios::MachineModel& model = require_machine(scenario, "diagnose");
  std::set<std::string> keys;
  for (const std::string& key : options.without) keys.insert(key);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  progress.begin("meshing");
  const scenarios::PlacedMachine placed = scenarios::place(model);
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
  std::vector<diagnosis::MeasuredRun> runs;
  for (const std::string& path : options.measured) runs.push_back(diagnosis::read_measured(path, model, names));

  const auto open = [&](const scenarios::Scenario& of, const mesh::Mesh& mesh) {
    TwinParts parts{diagnosis::augment(of, mesh, runs), {}};
    parts.machine = open_reduced(parts.augmented.model, parts.augmented.plan, progress);
    return parts;
  };
  const TwinParts fine = open(scenario, placed.mesh);
  solver::TransientOptions tolerances = scenario.solver.transient;
  const diagnosis::Twin whole(fine.augmented, fine.machine, tolerances);
  progress.begin("looking what states the measured runs come to");
  const diagnosis::Focus focused =
      diagnosis::focus(whole, runs, diagnosis::scatter(whole), diagnosis::candidates(whole, runs, keys));
  const diagnosis::Twin twin(fine.augmented, focused.machine, tolerances);
  std::optional<TwinParts> coarse_parts;
  std::optional<diagnosis::Twin> coarse;
  diagnosis::DiagnosisOptions how;
  for (double size : kOtherSizes) {
    const auto other = remeshed(scenario, size);
    if (!other) break;
    try {
      coarse_parts = open(*other, placed.mesh);
    } catch (const SolveError&) {  // no mesh of that size
      continue;
    }
    coarse.emplace(coarse_parts->augmented, coarse_parts->machine, tolerances);
    how.mesh_error_share = 1.0 / std::abs(size * size - 1.0);
    break;
  }
  how.without = keys;
  how.floor_K = std::max(how.floor_K, focused.error_K);
  how.floor_m = std::max(how.floor_m, focused.error_m);
  const diagnosis::Diagnosis d = diagnosis::diagnose(twin, coarse ? &*coarse : nullptr, runs, how,
                                                     [&](const std::string& work) { progress.begin(work); });
  folder.write_text("diagnosis.json", output::json_text(diagnosis_json(d)));
  folder.commit();
  progress.end();
  fmt::print("{}: {}\n", diagnosis::word(d.verdict), d.reason);
  for (const auto& g : d.gain) {
    fmt::print("{:<16} rmse {:.3g} -> {:.3g} {} (scatter alone {:.3g}, noise {:.3g})\n", g.name, g.rmse_before, g.rmse_after,
               g.unit, g.rmse_calibrated, g.noise_floor);
  }
  fmt::print("results in {}\n", shown_path(folder.target()));
}

}  // namespace driftwright::app
