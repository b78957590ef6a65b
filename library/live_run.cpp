// Runs the machine row by row: each step continues from the state of the last one; it is exact if the machine is linear.

#include <fmt/format.h>

#include "base/quantity.hpp"
#include "effects/reading_chain.hpp"
#include "library/parts.hpp"
#include "machine/as_recorded.hpp"
#include "machine/simulated_run.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/reduced_transient.hpp"

namespace driftwright {

struct Run::State {
  scenarios::MachineModel machine;  ///< its ambient grows row by row
  solver::TransientOptions tolerances;
  std::shared_ptr<const scenarios::Model> model;
  Cyclogram cyclogram;  ///< so far
  Eigen::VectorXd state;
  solver::Trajectory so_far;  ///< outputs of all rows if instruments depend on earlier ones, else of the last one
  bool remembers = false;     ///< true if instruments depend on earlier rows
  std::vector<Channel> channels;

  void take(double time_s, const Eigen::VectorXd& outputs) {
    if (!remembers) so_far = {};
    so_far.time_s.push_back(time_s);
    so_far.outputs.conservativeResize(outputs.size(), static_cast<Eigen::Index>(so_far.time_s.size()));
    so_far.outputs.rightCols<1>() = outputs;
  }
  [[nodiscard]] std::vector<double> readings() const {
    const Record record = scenarios::as_recorded(machine, so_far, model->outputs(), cyclogram);
    std::vector<double> values;
    for (const Channel& channel : channels) values.push_back(record.at(channel.name).values.back());
    return values;
  }
};

Run::Run(std::unique_ptr<State> state) : state_(std::move(state)) {}
Run::Run(Run&&) noexcept = default;
Run& Run::operator=(Run&&) noexcept = default;
Run::~Run() = default;

const std::vector<Channel>& Run::channels() const {
  return state_->channels;
}

std::vector<double> Run::step(const Row& row) {
  State& s = *state_;
  const double before_s = s.cyclogram.duration_s();
  if (!(row.time_s > before_s))
    throw InputError(fmt::format("a row at {:g} s comes after one at {:g} s: time must increase", row.time_s, before_s));
  s.cyclogram.sections.push_back({row.time_s - before_s, row.drive});
  const double end_s = s.cyclogram.duration_s();
  if (row.ambient_degC) {
    s.machine.ambient.time_s.push_back(end_s);
    s.machine.ambient.value.push_back(*row.ambient_degC + kZeroCelsius_K - s.machine.reference_K);
  }
  solver::TransientOptions from_here = s.tolerances;
  from_here.from_s = before_s;
  const MachineRun felt = scenarios::felt_run(s.machine, s.cyclogram);
  const auto keep = [&](double, const Eigen::VectorXd& state) { s.state = state; };
  const auto run = [&](const auto& system) {
    const Eigen::VectorXd start = s.state;
    return solver::simulate(system, felt.cyclogram, felt.ambient, {end_s}, from_here, start, keep);
  };
  const solver::Trajectory step = s.model->reduced() ? run(s.model->reduced()->system) : run(s.model->full()->system);
  s.take(end_s, step.outputs.col(0));
  return s.readings();
}

Run Machine::start(std::optional<double> ambient_degC, const std::string& run_name) const {
  auto s = std::make_unique<Run::State>();
  const scenarios::Scenario asked = as_predicted(parts_->scenario);
  const scenarios::MachineModel& own = *asked.machine;
  scenarios::require_nothing_before(own, "start");
  s->machine = own;
  s->tolerances = asked.solver.transient;
  s->cyclogram.name = run_name;
  // The model for the scenario's own cyclograms, which `predict` also uses for them.
  const Cyclogram own_job = asked.cyclograms.empty() ? Cyclogram{} : asked.cyclograms.front();
  s->model = parts_->predicting.of(asked, own_job, parts_->listener);
  const auto has_thermostats = [](const auto& system) { return !system.thermostats.empty(); };
  if (s->model->reduced() ? has_thermostats(s->model->reduced()->system) : has_thermostats(s->model->full()->system)) {
    throw InputError(own.where,
                     "a machine with thermostats cannot be run row by row: no row says whether they are on. `simulate` can");
  }
  if (ambient_degC) s->machine.ambient = {{0.0}, {*ambient_degC + kZeroCelsius_K - own.reference_K}};
  s->state = scenarios::start_of(own, *s->model) +
             scenarios::warmer_start_K(own, s->machine.ambient) * scenarios::ones_of(*s->model);
  s->remembers = !effects::reading_chain(own.effects, run_name).empty();
  for (const auto& sensor : own.sensors) s->channels.push_back({sensor.name, "degC", {}});
  for (const auto& d : own.displacements) s->channels.push_back({d.name, "um", {}});
  for (const auto& t : own.tilts) s->channels.push_back({t.name, "urad", {}});
  return Run(std::move(s));
}

}  // namespace driftwright
