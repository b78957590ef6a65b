#include "driftwright/machine.hpp"

#include <fmt/format.h>

#include "base/lists.hpp"
#include "base/parallel.hpp"
#include "library/parts.hpp"
#include "machine/machine.hpp"
#include "machine/simulated_run.hpp"
#include "output/vtk_fields.hpp"

namespace driftwright {

scenarios::Scenario as_predicted(const scenarios::Scenario& scenario) {
  scenarios::Scenario asked = scenario;
  asked.solver.model = studies::predicting_model(scenario);
  return asked;
}

Machine::Machine(const std::string& scenario_file, Listener listener)
    : parts_(new Parts{scenarios::read_scenario(scenario_file), std::move(listener), {}, {}}) {
  (void)scenarios::require_machine(parts_->scenario, "Machine");
}
Machine::Machine(Machine&&) noexcept = default;
Machine& Machine::operator=(Machine&&) noexcept = default;
Machine::~Machine() = default;

const std::string& Machine::name() const {
  return parts_->scenario.name;
}
const std::string& Machine::scenario_file() const {
  return parts_->scenario.path;
}

std::vector<std::string> Machine::cyclograms() const {
  return names_of(parts_->scenario.cyclograms);
}
std::vector<std::string> Machine::sensors() const {
  return names_of(parts_->scenario.machine->sensors);
}
std::vector<std::string> Machine::displacements() const {
  return names_of(parts_->scenario.machine->displacements);
}
std::vector<std::string> Machine::tilts() const {
  return names_of(parts_->scenario.machine->tilts);
}

Cyclogram Machine::cyclogram(const std::string& name_or_csv) const {
  return studies::named_cyclogram(parts_->scenario, name_or_csv);
}

Cyclogram Machine::cyclogram(const Record& record) const {
  return studies::cyclogram_of(parts_->scenario, record);
}

Record Machine::predict(const Cyclogram& cyclogram, const PredictOptions& options) const {
  return studies::predict_drift(parts_->scenario, cyclogram,
                                {.start = options.start, .after_pause = options.after_pause, .model = options.model},
                                parts_->listener, "Machine::predict", parts_->predicting)
      .record;
}

std::vector<Record> Machine::predict(const std::vector<Cyclogram>& cyclograms, const PredictOptions& options) const {
  std::vector<Record> records(cyclograms.size());
  if (cyclograms.empty()) return records;
  records[0] = predict(cyclograms[0], options);  // opens the model, with all cores
  const studies::PredictionOptions how{.start = options.start, .after_pause = options.after_pause, .model = options.model};
  const auto no_space = [] { return 0; };
  const auto one = [&](std::size_t i, int) {
    records[i + 1] = studies::predict_drift(parts_->scenario, cyclograms[i + 1], how, parts_->listener.within(),
                                            "Machine::predict", parts_->predicting)
                         .record;
  };
  for_each_index(cyclograms.size() - 1, no_space, one);
  return records;
}

Record Machine::simulate(const Cyclogram& cyclogram) const {
  scenarios::check_cyclogram(parts_->scenario, cyclogram);
  const auto model = parts_->simulating.of(parts_->scenario, cyclogram, parts_->listener);
  return scenarios::simulate_cyclograms(parts_->scenario, *model, {&cyclogram}, parts_->listener).front().record;
}

std::vector<Field> Machine::fields(const Cyclogram& cyclogram, const std::vector<double>& times_s) const {
  scenarios::Scenario asked = parts_->scenario;
  for (double t_s : times_s) {
    if (!(t_s >= 0.0 && t_s <= cyclogram.duration_s()))
      throw InputError(
          fmt::format("fields at {:g} s: the cyclogram '{}' ends at {:g} s", t_s, cyclogram.name, cyclogram.duration_s()));
  }
  asked.solver.fields_at_s = times_s.empty() ? std::vector<double>{cyclogram.duration_s()} : times_s;
  scenarios::check_cyclogram(asked, cyclogram);
  const scenarios::Model model = scenarios::open_model(asked, {&cyclogram}, parts_->listener, true);
  if (model.mesh().n_nodes() == 0) throw InputError(asked.machine->where, "a machine of lumped nodes alone has no fields");
  std::vector<Field> fields;
  const auto take = [&](const scenarios::WholeFields& whole) {
    const double* u = whole.displacement_um.data();
    fields.push_back({.time_s = whole.time_s,
                      .temperature_degC = {whole.temperature_degC.begin(), whole.temperature_degC.end()},
                      .displacement_um = {u, u + whole.displacement_um.size()}});
  };
  (void)scenarios::simulate_cyclograms(asked, model, {&cyclogram}, parts_->listener, {.cyclogram = 0, .take = take});
  return fields;
}

Mesh Machine::mesh() const {
  const mesh::Mesh own = scenarios::place(*parts_->scenario.machine).mesh;
  Mesh mesh;
  mesh.points_m.assign(own.coords.data(), own.coords.data() + own.coords.size());
  mesh.offset = own.cells.offset;
  mesh.node = own.cells.node;
  for (mesh::CellShape shape : own.cells.shape) mesh.vtk_type.push_back(output::vtk_cell_type(shape));
  mesh.region = own.cells.group;
  mesh.region_name = own.regions;
  return mesh;
}

}  // namespace driftwright
