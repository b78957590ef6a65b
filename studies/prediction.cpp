#include "studies/prediction.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>

#include "base/mapped_record.hpp"
#include "base/option_quantity.hpp"
#include "base/quantity.hpp"
#include "compensation/sensors/interpolate.hpp"
#include "machine/machine_key.hpp"
#include "machine/moving_run.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/read_cyclogram.hpp"
#include "studies/known_band.hpp"

namespace driftwright::studies {
namespace {

double duration_s(const std::string& option, const std::string& text) {
  if (text.empty()) return 0.0;
  constexpr double kMost_s = 1e7;
  const double value_s = option_quantity(option, text, "s");
  if (value_s >= 0.0 && value_s <= kMost_s) return value_s;
  throw InputError(fmt::format("{} '{}' must be a time from 0 s to {:g} s", option, text, kMost_s));
}

std::vector<std::string> sensors_on_ambient(const scenarios::MachineModel& machine) {
  std::vector<std::string> names;
  for (const scenarios::Sensor& sensor : machine.sensors) {
    if (scenarios::is_on_ambient(sensor)) names.push_back(sensor.name);
  }
  return names;
}

/// An effect that holds only in the run before would have to end with it, but effects are limited by the name of one run.
void require_no_effect_in(const scenarios::MachineModel& machine, const std::string& run, const std::string& job) {
  for (const effects::Effect& effect : machine.effects) {
    if (effect.in == run && run != job) {
      throw InputError(effect.where,
                       fmt::format("{} holds in '{}' alone, and a prediction that starts from that record goes on as "
                                   "'{}', where it does not hold. Leave the effect out, or rename the record",
                                   effect.name(), run, job));
    }
  }
}

/// The job and the run before it, as given on the command line.
scenarios::JobOrder read_order(const scenarios::Scenario& scenario, const PredictionOptions& options,
                               const std::string& job) {
  const scenarios::MachineModel& machine = *scenario.machine;
  scenarios::JobOrder order;
  order.pause_s = duration_s("--after-pause", options.after_pause);
  order.n_parts = options.parts;
  order.between_s = duration_s("--between", options.between);
  if (options.start.empty()) return order;
  if (options.start.ends_with(".csv")) {
    ReadRecord read = read_record(options.start, scenario.columns);
    order.start =
        scenarios::run_of(std::move(read.record), &machine, sensors_on_ambient(machine), scenarios::Reading::kStrict);
    for (const std::string& note : read.notes) fmt::print(stderr, "note: {}\n", note);
    for (const DataFinding& f : order.start->findings) fmt::print(stderr, "note: {}\n", f.what);
  } else {
    order.start.emplace();
    order.start->cyclogram = scenario.cyclogram(options.start);
  }
  require_no_effect_in(machine, order.start->cyclogram.name, job);
  return order;
}

std::string start_words(const scenarios::JobOrder& order, const PredictionOptions& options) {
  if (!order.start) return "";
  const bool is_recorded = order.start->readings.n_samples() > 0;
  const bool lacks_ambient = is_recorded && !order.start->has_recorded_ambient();
  return fmt::format("{}{} ({:.4g} min{}){}", is_recorded ? "" : "cyclogram ", options.start,
                     order.start->cyclogram.duration_s() / 60.0,
                     lacks_ambient ? ", without an ambient temperature: the scenario's" : "",
                     order.pause_s > 0.0 ? fmt::format(" and {:.4g} min at rest", order.pause_s / 60.0) : "");
}

/// @param recorded  the run before
/// @param modelled  begins with the same run
std::vector<StartCheck> start_checks(const Record& recorded, const Record& modelled) {
  std::vector<StartCheck> checks;
  for (const Channel& channel : recorded.channels) {
    const Channel* model = modelled.find(channel.name);
    if ((channel.unit != "um" && channel.unit != "urad") || !model || model->unit != channel.unit) continue;
    const auto is_reading = [](double v) { return !std::isnan(v); };
    const auto first = std::find_if(channel.values.begin(), channel.values.end(), is_reading);
    const auto last = std::find_if(channel.values.rbegin(), channel.values.rend(), is_reading);
    if (first == channel.values.end()) continue;
    const auto modelled_at = [&](std::ptrdiff_t row) {
      return compensation::interpolate(modelled.time_s, model->values,
                                       recorded.time_s[static_cast<std::size_t>(row)] - recorded.time_s.front());
    };
    checks.push_back(
        {.channel = channel.name,
         .unit = channel.unit,
         .recorded = *last - *first,
         .modelled = modelled_at(last.base() - channel.values.begin() - 1) - modelled_at(first - channel.values.begin())});
  }
  return checks;
}

/// The rows from the first part on, with the time from there.
Record from_row(const Record& record, std::size_t first) {
  Record rest{.source = record.source, .time_s = {}, .channels = {}};
  for (std::size_t i = first; i < record.n_samples(); ++i) rest.time_s.push_back(record.time_s[i] - record.time_s[first]);
  for (const Channel& channel : record.channels) {
    rest.channels.push_back(
        {channel.name, channel.unit, {channel.values.begin() + static_cast<std::ptrdiff_t>(first), channel.values.end()}});
  }
  return rest;
}

}  // namespace

bool can_be_reduced(const scenarios::MachineModel& machine) {
  const effects::HeatBalance balance = effects::heat_balance(machine.effects);
  return std::none_of(balance.fixed.begin(), balance.fixed.end(),
                      [](const auto& fixed) { return !fixed.follows_ambient && fixed.temperature_K.value.size() > 1; });
}

scenarios::ModelKind predicting_model(const scenarios::Scenario& scenario) {
  const scenarios::MachineModel& machine = *scenario.machine;
  if (scenario.solver.model == scenarios::ModelKind::kReduced) return scenarios::ModelKind::kReduced;
  if (std::holds_alternative<scenarios::LumpedMachine>(machine.mesh)) return scenarios::ModelKind::kFull;
  return can_be_reduced(machine) ? scenarios::ModelKind::kReduced : scenarios::ModelKind::kFull;
}

struct PredictingModels::Known {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<const scenarios::Model>>
      by_plan;  ///< key: "full", or what determines the reduced model
};

PredictingModels::PredictingModels() : known_(std::make_unique<Known>()) {}
PredictingModels::~PredictingModels() = default;

std::shared_ptr<const scenarios::Model> PredictingModels::of(const scenarios::Scenario& scenario, const Cyclogram& cyclogram,
                                                             const Listener& listener) {
  std::string plan = "full";
  if (scenario.solver.model == scenarios::ModelKind::kReduced) {
    std::vector<const Cyclogram*> asked = {&cyclogram};
    for (const Cyclogram& c : scenario.cyclograms) asked.push_back(&c);
    plan = scenarios::machine_key(*scenario.machine, scenarios::reduction_plan(scenario, asked), "");
  }
  if (scenarios::moves_axes(scenario.machine->axes, cyclogram)) {  // its model has these poses alone
    for (const scenarios::Pose& pose : scenarios::further_poses(scenario.machine->axes, {&cyclogram}))
      plan += scenarios::pose_words(scenario.machine->axes, pose) + "\n";
  }
  const std::lock_guard lock(known_->mutex);
  std::shared_ptr<const scenarios::Model>& model = known_->by_plan[plan];
  if (!model)
    model = std::make_shared<const scenarios::Model>(
        scenarios::open_model(scenario, {&cyclogram}, listener, false, nullptr, nullptr, scenarios::Follows::kMoves));
  return model;
}

Prediction predict_drift(const scenarios::Scenario& scenario, const Cyclogram& job, const PredictionOptions& options,
                         const Listener& listener, const std::string& verb) {
  PredictingModels models;
  return predict_drift(scenario, job, options, listener, verb, models);
}

Outlook outlook_of(const scenarios::Scenario& scenario, const Cyclogram& job, const PredictionOptions& options,
                   const Listener& listener, const std::string& verb, PredictingModels& models) {
  const scenarios::MachineModel& own = scenarios::require_machine(scenario, verb);
  scenarios::JobOrder order = read_order(scenario, options, job.name);
  scenarios::JobSeries series = scenarios::job_series(job, order, own.ambient, scenario.solver.output_interval_s);
  scenarios::check_cyclogram(scenario, series.cyclogram);
  scenarios::Scenario asked = scenario;
  asked.solver.model = options.model.empty()     ? predicting_model(scenario)
                       : options.model == "full" ? scenarios::ModelKind::kFull
                                                 : scenarios::ModelKind::kReduced;
  TimeSeries& ambient =
      asked.machine->ambient;  // temperatures that the model must cover: those of the series, after the scenario's own
  for (double value_K : series.ambient.value) {
    ambient.time_s.push_back(ambient.time_s.back() + 1.0);
    ambient.value.push_back(value_K);
  }
  Outlook ahead{.machine = own,
                .model = models.of(asked, series.cyclogram, listener),
                .start = {},
                .series = std::move(series),
                .before = {},
                .started_from = start_words(order, options)};
  if (order.start) ahead.before = std::move(order.start->readings);
  ahead.machine.ambient = ahead.series.ambient;
  // The model's start is that of the scenario's ambient; a run in another ambient starts warmer by the difference.
  const double warmer_K = scenarios::warmer_start_K(ahead.machine, ahead.series.cyclogram) +
                          scenarios::warmer_start_K(own, ahead.series.ambient);
  ahead.start = scenarios::start_of(own, *ahead.model) + warmer_K * scenarios::ones_of(*ahead.model);
  if (options.start.empty())  // otherwise the run before is given
    ahead.start = scenarios::after_what_was_before(ahead.machine, scenario.solver.transient, *ahead.model, ahead.start,
                                                   ahead.series.cyclogram);
  return ahead;
}

Prediction predict_drift(const scenarios::Scenario& scenario, const Cyclogram& job, const PredictionOptions& options,
                         const Listener& listener, const std::string& verb, PredictingModels& models) {
  Outlook ahead = outlook_of(scenario, job, options, listener, verb, models);
  scenarios::JobSeries& series = ahead.series;
  const double total_s = series.cyclogram.duration_s();
  listener.begin(fmt::format("simulating {:.0f} min", total_s / 60.0));
  const scenarios::SimulatedRun run = scenarios::simulate_run(
      ahead.machine, scenario.solver.transient, *ahead.model, ahead.start, series.cyclogram, series.time_s,
      [&](double time_s, const Eigen::VectorXd&) { listener.share(time_s / total_s); });
  const std::size_t first = series.parts.front().first;
  for (scenarios::PartRows& rows : series.parts) {
    rows.first -= first;
    rows.last -= first;
  }
  Prediction prediction{.record = from_row(run.record, first),
                        .parts = std::move(series.parts),
                        .predicted_by = ahead.model->words(),
                        .started_from = std::move(ahead.started_from),
                        .start_checks = start_checks(ahead.before, run.record)};
  if (options.with_band) {
    scenarios::Scenario in_series = scenario;
    in_series.machine = ahead.machine;
    prediction.band = known_band(
        in_series, {*ahead.model, series.cyclogram, ahead.machine.ambient, prediction.record, run.record.time_s[first]},
        listener);
  }
  return prediction;
}

compensation::Iso230Figures iso_figures(const Prediction& prediction) {
  compensation::Iso230Figures figures = compensation::iso230_3_figures(prediction.record);
  if (prediction.started_from.empty()) return figures;
  figures.channels.clear();
  figures.not_available = "the machine was at work before; the test starts from a machine in balance with its ambient";
  return figures;
}

namespace {

/// Notes that a record was made in another ambient than the scenario's, which is the one used.
void note_other_ambient(const scenarios::MachineModel& machine, const MachineRun& run) {
  constexpr double kNoticed_K = 0.5;  // thermometers of a workshop differ by less
  if (!run.has_recorded_ambient()) return;
  const std::vector<double>& recorded_C = run.readings.at(run.ambient_channel).values;
  const auto stated_C = [&](std::size_t i) {
    return machine.ambient.at(run.readings.time_s[i]) + machine.reference_K - kZeroCelsius_K;
  };
  double farthest_K = 0.0;
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < recorded_C.size(); ++i) {
    const double apart_K = std::abs(recorded_C[i] - stated_C(i));
    if (apart_K > farthest_K) farthest_K = apart_K, farthest = i;
  }
  if (!(farthest_K > kNoticed_K)) return;
  fmt::print(stderr,
             "note: {}: {} is {:g} degC at {:g} min; the machine is run in the scenario's ambient, {:g} degC then. "
             "`ambient: {{csv: FILE}}` in the scenario takes that of a record\n",
             run.readings.source, run.ambient_channel, recorded_C[farthest], run.readings.time_s[farthest] / 60.0,
             stated_C(farthest));
}

}  // namespace

Cyclogram cyclogram_of(const scenarios::Scenario& scenario, const Record& record) {
  MachineRun run = scenarios::run_of(record, nullptr, {}, scenarios::Reading::kStrict);
  for (const DataFinding& f : run.findings) {
    if (f.channel == "speed") fmt::print(stderr, "note: {}\n", f.what);  // the ambient is the scenario's
  }
  if (scenario.machine) note_other_ambient(*scenario.machine, run);
  scenarios::check_cyclogram(scenario, run.cyclogram);
  return std::move(run.cyclogram);
}

Cyclogram named_cyclogram(const scenarios::Scenario& scenario, const std::string& name_or_file) {
  const bool is_known = std::any_of(scenario.cyclograms.begin(), scenario.cyclograms.end(),
                                    [&](const Cyclogram& c) { return c.name == name_or_file; });
  if (!is_known && (name_or_file.ends_with(".csv") || std::filesystem::exists(name_or_file))) {
    const ReadRecord read = read_record(name_or_file, scenario.columns);
    for (const std::string& note : read.notes) fmt::print(stderr, "note: {}\n", note);
    return cyclogram_of(scenario, read.record);
  }
  const std::filesystem::path path(name_or_file);
  if (!is_known && (path.has_extension() || path.has_parent_path())) {
    std::vector<std::string> known;
    for (const Cyclogram& c : scenario.cyclograms) known.push_back(c.name);
    throw InputError(fmt::format("{}: there is no such file, and {} has no cyclogram of that name; it has {}", name_or_file,
                                 scenario.path, fmt::join(known, ", ")));
  }
  const Cyclogram& cyclogram = scenario.cyclogram(name_or_file);
  scenarios::check_cyclogram(scenario, cyclogram);
  return cyclogram;
}

}  // namespace driftwright::studies
