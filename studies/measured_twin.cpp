#include "studies/measured_twin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/mapped_record.hpp"
#include "diagnosis/scatter.hpp"
#include "diagnosis/warm_start.hpp"
#include "machine/simulated_run.hpp"
#include "solver/exponential_run.hpp"
#include "studies/other_mesh.hpp"

namespace driftwright::studies {
namespace {

/// Sizes of the second mesh relative to the machine's own, to determine the error of the mesh. Gmsh cannot make every
/// size: the first that works is used.
constexpr double kOtherSizes[] = {1.4, 1.25, 1.6, 1.15, 0.85};

/// Whether two files contain the same record.
bool same_readings(const diagnosis::MeasuredRun& a, const diagnosis::MeasuredRun& b) {
  if (a.time_s != b.time_s || a.channels.size() != b.channels.size()) return false;
  for (const diagnosis::MeasuredChannel& c : a.channels) {
    const diagnosis::MeasuredChannel* other = b.find(c.name);
    if (!other) return false;
    for (Eigen::Index i = 0; i < c.value.size(); ++i) {
      if (c.value[i] != other->value[i] && !(std::isnan(c.value[i]) && std::isnan(other->value[i]))) return false;
    }
  }
  return true;
}

/// Adds the blunders and the probable names of a record.
void check_beside(const Record& record, diagnosis::MeasuredRun& run, const solver::Outputs& names,
                  const diagnosis::Twin& twin, MeasuredTwin& m) {
  diagnosis::RecordCheck found =
      diagnosis::check_record(run, diagnosis::channels_without_output(record, run, *m.scenario.machine, names), twin);
  for (diagnosis::Blunder& b : found.blunders) {
    run.findings.push_back({"", fmt::format("{}. {}", b.what, b.instead), false});
    m.blunders.push_back(std::move(b));
  }
  for (diagnosis::Renaming& n : found.renamings) {
    const auto is_known = [&](const diagnosis::Renaming& k) { return k.column == n.column && k.header == n.header; };
    if (std::none_of(m.renamings.begin(), m.renamings.end(), is_known)) m.renamings.push_back(std::move(n));
  }
}

}  // namespace

diagnosis::NoiseFloor floor_of(const solver::ReducedSystem& system) {
  diagnosis::NoiseFloor floor;
  const bool is_stepped = !system.is_linear() && system.size() > solver::kMostOfExponentialRun;
  if (is_stepped ||
      !system.thermostats.empty()) {  // integrated in steps, with thermostats that switch slightly early or late
    floor.slow_K = 0.02;
    floor.slow_m = 5e-8;
  }
  if (!system.thermostats.empty()) {  // a chiller's change in a tenth of a second, whichever record it is
    floor.white_K = std::max(floor.white_K, 0.01);
    floor.white_m = std::max(floor.white_m, 1e-8);
  }
  return floor;
}

MeasuredTwin open_measured_twin(const scenarios::Scenario& scenario, const std::string& verb,
                                const std::vector<std::string>& measured, const Listener& listener, bool as_recorded) {
  std::vector<ReadRecord> records;
  for (const std::string& path : measured) records.push_back(read_record(path, scenario.columns));
  return open_measured_twin(scenario, verb, records, listener, as_recorded);
}

MeasuredTwin open_measured_twin(const scenarios::Scenario& scenario, const std::string& verb,
                                const std::vector<ReadRecord>& measured, const Listener& listener, bool as_recorded) {
  const scenarios::MachineModel& model = scenarios::require_machine(scenario, verb);
  MeasuredTwin m;
  m.scenario = scenario;
  listener.begin("meshing");
  const scenarios::PlacedMachine placed = scenarios::place(model);
  m.mesh = placed.mesh;
  const solver::Outputs names = scenarios::output_names(model, placed);
  for (const ReadRecord& read : measured) {
    const std::string& path = read.record.source;
    m.runs.push_back(diagnosis::measured_run(read, model, names));
    for (std::size_t r = 0; r + 1 < m.runs.size(); ++r) {
      if (same_readings(m.runs[r], m.runs.back())) {
        throw InputError(fmt::format("{}: the same readings as {}; a record counts once", path, m.runs[r].path));
      }
      if (m.runs[r].name != m.runs.back().name) continue;
      throw InputError(
          fmt::format("{}: there is a record called '{}' already ({}); what happened in one of them is said by its "
                      "name. Rename one of the files",
                      path, m.runs[r].name, m.runs[r].path));
    }
  }

  const auto open = [&](const scenarios::Scenario& of) {
    auto parts = std::make_unique<TwinParts>(TwinParts{diagnosis::augment(of, m.mesh, m.runs), {}});
    parts->machine = scenarios::open_reduced(parts->augmented.model, parts->augmented.plan, listener);
    return parts;
  };
  m.fine = open(scenario);
  solver::TransientOptions tolerances = scenario.solver.transient;  // a fraction of the noise is accurate enough
  tolerances.relative_tolerance = std::max(tolerances.relative_tolerance, 1e-4);
  tolerances.absolute_tolerance_K = std::max(tolerances.absolute_tolerance_K, 2e-3);
  const diagnosis::Twin whole(m.fine->augmented, m.fine->machine, tolerances);
  listener.begin("looking for blunders in the records");
  for (std::size_t r = 0; r < m.runs.size(); ++r) check_beside(measured[r].record, m.runs[r], names, whole, m);
  if (!m.blunders.empty() && !as_recorded) {
    throw InputError(
        fmt::format("{}\nNothing was fitted. Mend this first; `driftwright import FILE` writes the map of a file "
                    "(`columns`). To go on with "
                    "the records as they are: --as-recorded (in the library as_recorded)",
                    diagnosis::words(m.blunders)));
  }
  diagnosis::find_warm_starts(m.runs, whole);
  listener.begin("computing the states that the measured runs reach");
  m.focus = std::make_unique<diagnosis::Focus>(
      diagnosis::focus(whole, m.runs, diagnosis::scatter(whole), diagnosis::candidates(whole, m.runs, {})));
  m.twin.emplace(m.fine->augmented, m.focus->machine, tolerances);
  for (double size : kOtherSizes) {
    OtherMesh mesh = other_mesh(scenario.machine->mesh, size);
    m.why_one_mesh = mesh.why_none;
    if (!mesh.recipe) break;
    scenarios::Scenario other = scenario;
    other.machine->mesh = std::move(*mesh.recipe);
    other.machine->written += fmt::format("\nmesh size times {}\n", size);
    const auto failed = [&](const std::exception& e) {
      m.why_one_mesh = fmt::format("no other size can be meshed; of the last one tried: {}", e.what());
    };
    try {
      m.other = open(other);
    } catch (const SolveError& e) {
      failed(e);
      continue;
    } catch (const InputError& e) {  // too many cells
      failed(e);
      continue;
    }
    m.on_other_mesh.emplace(m.other->augmented, m.other->machine, tolerances);
    m.how.mesh_error_share = 1.0 / std::abs(size * size - 1.0);
    break;
  }
  m.how.floor = floor_of(m.twin->machine().system);
  m.how.floor.white_K = std::max(m.how.floor.white_K, m.focus->error_K);
  m.how.floor.white_m = std::max(m.how.floor.white_m, m.focus->error_m);
  return m;
}

diagnosis::Prediction read_of(const MeasuredTwin& m, const diagnosis::TwinState& state) {
  diagnosis::Twin::Workspace workspace(*m.twin);
  diagnosis::Prediction read;
  for (const diagnosis::MeasuredRun& run : m.runs) read.push_back(m.twin->readings(state, run, workspace));
  return read;
}

std::string one_mesh_text(const MeasuredTwin& m) {
  if (m.on_other_mesh || m.mesh.n_nodes() == 0) return "";
  return fmt::format("there is no second mesh: {}; an error of the mesh can pass for a cause", m.why_one_mesh);
}

}  // namespace driftwright::studies
