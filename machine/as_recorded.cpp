#include "machine/as_recorded.hpp"

#include <algorithm>

#include "base/quantity.hpp"
#include "effects/recorded_column.hpp"
#include "machine/machine.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::scenarios {

Record as_recorded(const MachineModel& model, const solver::Trajectory& run, const solver::Outputs& outputs,
                   const Cyclogram& recorded) {
  solver::Trajectory told;
  told.time_s = run.time_s;
  told.outputs = run.outputs;
  Eigen::RowVectorXd ambient(static_cast<Eigen::Index>(run.time_s.size()));
  for (Eigen::Index i = 0; i < ambient.size(); ++i) ambient[i] = model.ambient.at(run.time_s[static_cast<std::size_t>(i)]);
  for (std::size_t i = 0; i < model.sensors.size(); ++i) {  // outputs begin with the sensors
    if (is_on_ambient(model.sensors[i])) told.outputs.row(static_cast<Eigen::Index>(i)) = ambient;
  }
  if (const effects::ReadingChain chain = effects::reading_chain(model.effects, recorded.name); !chain.empty()) {
    const MachineRun felt = felt_run_as_far_as_known(model, recorded);
    told.outputs =
        chain.apply(outputs.name, outputs.unit, run.time_s, felt.cyclogram, felt.ambient, std::move(told.outputs));
  }
  Record record = to_record(told, outputs, recorded, model.reference_K);
  std::vector<Channel> further;  // columns that drive the machine; the ambient
  std::vector<std::string> told_columns = wanted_columns(model, recorded.name);
  for (const MovingAxis& axis : model.axes) told_columns.push_back(axis.column);
  for (const std::string& name : told_columns) {
    const Cyclogram::Column* column = recorded.column(name);
    const auto is_it = [&](const Channel& c) { return c.name == column->name; };
    if (!column || std::any_of(record.channels.begin(), record.channels.end(), is_it) ||
        std::any_of(further.begin(), further.end(), is_it))
      continue;
    further.push_back({column->name, column->unit, {}});
    for (double t_s : record.time_s) further.back().values.push_back(column->at(t_s));
  }
  if (has_ambient_channel(model)) {
    further.push_back({kAmbient, "degC", {}});
    for (double ambient_K : ambient) further.back().values.push_back(ambient_K + (model.reference_K - kZeroCelsius_K));
  }
  const std::ptrdiff_t n_read = std::count_if(outputs.name.begin(), outputs.name.end(),
                                              [](const std::string& name) { return !effects::is_mean_output(name); });
  record.channels.insert(record.channels.end() - n_read, further.begin(), further.end());
  return record;
}

}  // namespace driftwright::scenarios
