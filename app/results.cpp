#include "app/results.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <optional>

#include "app/version.hpp"
#include "base/quantity.hpp"
#include "machine/as_recorded.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "machine/heat_flow_record.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/stress.hpp"

namespace driftwright::app {
namespace {

output::StressField stress_field(const mesh::Mesh& mesh, const solver::RegionMaterials& materials,
                                 const Eigen::Matrix3Xd& displacement_m, const Eigen::VectorXd& theta_K) {
  output::StressField field{1e-6 * solver::nodal_stress_Pa(mesh, materials, displacement_m, theta_K), {}};
  field.von_mises_MPa.resize(field.stress_MPa.cols());
  for (Eigen::Index n = 0; n < field.stress_MPa.cols(); ++n) {
    field.von_mises_MPa[n] = solver::von_mises(field.stress_MPa.col(n));
  }
  return field;
}

}  // namespace

output::ResultsFolder open_results(const CommonOptions& options, const std::string& scenario_name) {
  const std::string target = options.out.empty() ? "results/" + scenario_name : options.out;
  return {target, options.force, output::Provenance{kVersion, options.scenario}};
}

std::vector<std::string> provenance_lines(const output::Provenance& made_by, const std::string& what) {
  return {fmt::format("{}; Driftwright {}, scenario {}", what, made_by.version, made_by.scenario)};
}

std::string heat_flows_csv(const solver::Trajectory& run, const std::string& cyclogram, const output::Provenance& made_by) {
  return record_csv(scenarios::heat_flow_record(run, cyclogram),
                    provenance_lines(made_by,
                                     "mean heat flow since the row before; > 0 into the machine, within_...: > 0 out of "
                                     "the body; cyclogram " +
                                         cyclogram));
}

std::string shown_path(const std::filesystem::path& path) {
  const std::string relative = std::filesystem::relative(path).string();
  return relative.starts_with("..") ? path.string() : relative;
}

const scenarios::MachineModel& require_machine(const scenarios::Scenario& scenario, const std::string& verb) {
  if (scenario.machine) return *scenario.machine;
  throw InputError(
      fmt::format("{}: `{}` needs the key `machine`; this scenario is about measured records alone (select, validate)",
                  scenario.path, verb));
}

const scenarios::Study& require_study(const scenarios::Scenario& scenario, const std::string& verb) {
  if (scenario.study) return *scenario.study;
  throw InputError(
      fmt::format("{}: `{}` needs the key `study`, which says the target and what to fit", scenario.path, verb));
}

std::string fields_note(const output::FieldSeries& fields) {
  constexpr std::size_t kManyTimes = 100;
  if (fields.format() != FieldsFormat::kVtu || fields.n_times() <= kManyTimes) return "";
  return fmt::format(
      "note: fields at {} times, each file with the mesh; `solver: {{fields_format: xdmf}}` would hold the mesh once\n",
      fields.n_times());
}

namespace {

/// Which output times get whole fields.
class FieldTimes {
 public:
  FieldTimes(const scenarios::SolverSettings& settings, double end_s) : settings_(settings), end_s_(end_s) {}
  bool is_due(double time_s) {
    const auto& wanted_s = settings_.fields_at_s;
    const bool listed =
        std::any_of(wanted_s.begin(), wanted_s.end(), [&](double t_s) { return std::abs(t_s - time_s) <= 1e-9 * t_s; });
    const bool due = wanted_s.empty() ? time_s >= next_s_ - 1e-6 : listed || time_s == 0.0;
    if (!due && time_s < end_s_) return false;
    while (next_s_ <= time_s + 1e-6) next_s_ += settings_.fields_every_s;
    return true;
  }

 private:
  const scenarios::SolverSettings& settings_;
  double end_s_, next_s_ = 0.0;
};

void write_fields(const scenarios::Scenario& scenario, const Model& model, const solver::RegionMaterials& materials,
                  double time_s, const Eigen::VectorXd& state, output::FieldSeries& fields) {
  const scenarios::ReducedMachine* reduced = model.reduced();
  const Eigen::VectorXd nodes =
      reduced ? reduced->node_temperature_K(state) : Eigen::VectorXd(state.head(model.mesh().n_nodes()));
  const Eigen::Matrix3Xd displacement_m =
      reduced ? reduced->node_displacement_m(state) : model.full()->elasticity->displacement(nodes);
  const std::optional<output::StressField> stress =
      scenario.solver.stresses ? std::optional(stress_field(model.mesh(), materials, displacement_m, nodes)) : std::nullopt;
  fields.write(time_s, (nodes.array() + (scenario.machine->reference_K - kZeroCelsius_K)).matrix(), 1e6 * displacement_m,
               stress ? &*stress : nullptr);
}

}  // namespace

SimulatedRun simulate_run(const scenarios::MachineModel& machine, const solver::TransientOptions& options,
                          const Model& model, const Eigen::VectorXd& from, const Cyclogram& cyclogram,
                          const std::vector<double>& times_s, const solver::OutputCallback& at_output) {
  const scenarios::FeltRun felt = scenarios::felt_run(machine, cyclogram);
  const auto run = [&](const auto& system) {
    return solver::simulate(system, felt.cyclogram, felt.hall, times_s, options, from, at_output);
  };
  SimulatedRun simulated{.record = {},
                         .trajectory = model.reduced() ? run(model.reduced()->system) : run(model.full()->system)};
  simulated.record = scenarios::as_recorded(machine, simulated.trajectory, model.outputs(), cyclogram);
  return simulated;
}

Eigen::VectorXd start_of(const scenarios::MachineModel& machine, const Model& model) {
  return model.reduced() ? model.reduced()->start : scenarios::start_state(machine, *model.full());
}

const Eigen::VectorXd& ones_of(const Model& model) {
  return model.reduced() ? model.reduced()->system.ones : model.full()->system.ones;
}

std::vector<SimulatedRun> simulate_cyclograms(const scenarios::Scenario& scenario, const Model& model,
                                              const std::vector<const Cyclogram*>& cyclograms, Progress& progress,
                                              std::size_t with_fields, output::FieldSeries* fields) {
  const scenarios::MachineModel& machine = *scenario.machine;
  const scenarios::SolverSettings& settings = scenario.solver;
  double total_s = 0.0;
  for (const Cyclogram* c : cyclograms) total_s += c->duration_s();
  progress.begin(fmt::format("simulating {} cyclogram{}, {:.0f} min in all", cyclograms.size(),
                             cyclograms.size() == 1 ? "" : "s", total_s / 60.0));

  solver::RegionMaterials materials;
  if (fields && settings.stresses) materials = scenarios::region_materials(machine, model.mesh());
  const Eigen::VectorXd start = start_of(machine, model);
  std::vector<SimulatedRun> runs(cyclograms.size());
  std::vector<std::exception_ptr> failures(cyclograms.size());
  double done_s = 0.0;
  // Runs are independent, so each has a core of its own and the loops inside it stay on that core: no thread waits for
  // another, which matters on a busy machine. A single run has all cores.
#pragma omp parallel for schedule(dynamic, 1) if (cyclograms.size() > 1)
  for (std::size_t i = 0; i < cyclograms.size(); ++i) {
    const Cyclogram& cyclogram = *cyclograms[i];
    FieldTimes field_times(settings, cyclogram.duration_s());
    double last_s = 0.0;
    const auto at_output = [&](double time_s, const Eigen::VectorXd& state) {
#pragma omp critical(progress)
      progress.update((done_s += time_s - last_s) / total_s);
      last_s = time_s;
      if (fields && i == with_fields && field_times.is_due(time_s)) {
        write_fields(scenario, model, materials, time_s, state, *fields);
      }
    };
    const std::vector<double> times_s =
        scenarios::output_times_s(cyclogram, settings.output_interval_s, settings.fields_at_s);
    try {
      const Eigen::VectorXd from = start + scenarios::warmer_start_K(machine, cyclogram) * ones_of(model);
      runs[i] = simulate_run(machine, settings.transient, model, from, cyclogram, times_s, at_output);
    } catch (...) {
      failures[i] = std::current_exception();  // none may leave the parallel loop
    }
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
  return runs;
}

}  // namespace driftwright::app
