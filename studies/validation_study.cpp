#include "studies/validation_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/parallel.hpp"
#include "base/quantity.hpp"
#include "base/random.hpp"
#include "base/record_channel.hpp"
#include "compensation/sensors/thermometers.hpp"
#include "effects/feed_axis.hpp"
#include "machine/as_recorded.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/travel_places.hpp"
#include "solver/reduced_transient.hpp"
#include "studies/linear_physics.hpp"

namespace driftwright::studies {
namespace {

using namespace compensation;
using scenarios::Scenario, scenarios::Validation;

constexpr double kRounding = 0.289;  // standard deviation of a rounding error of one step, 1 / sqrt(12)

/// One simulation.
struct Job {
  const Cyclogram* cyclogram;
  const Validation::Season* season;
};

/// Simulates without noise and rounding.
MachineRun simulate(const Scenario& scenario, const scenarios::Model& model, const Job& job) {
  scenarios::MachineModel machine = *scenario.machine;
  machine.ambient = scenarios::ambient_in(*job.season, machine.ambient, job.cyclogram->duration_s());
  const MachineRun felt = scenarios::felt_run(machine, *job.cyclogram);
  const std::vector<double> times_s = scenarios::output_times_s(*job.cyclogram, scenario.solver.output_interval_s);
  const auto run = [&](const auto& system, const Eigen::VectorXd& start) {
    const Eigen::VectorXd shifted = start + job.season->offset_K * system.ones;
    return scenarios::as_recorded(
        machine, solver::simulate(system, felt.cyclogram, felt.ambient, times_s, scenario.solver.transient, shifted),
        model.outputs(), *job.cyclogram);
  };
  MachineRun result{.cyclogram = *job.cyclogram, .ambient = machine.ambient, .readings = {}};
  result.readings = model.reduced() ? run(model.reduced()->system, model.reduced()->start)
                                    : run(model.full()->system, scenarios::start_state(*scenario.machine, *model.full()));
  result.readings.source = job.cyclogram->name;
  return result;
}

Thermometers instrument_of(const Validation& v) {
  return {.noise_K = v.noise_K, .resolution_K = v.resolution_K};
}

/// @param run  index among the training runs followed by the judged ones
std::uint64_t seed_of(const Validation& v, std::size_t run) {
  return 1000 * static_cast<std::uint64_t>(v.seed) + run;
}

/// Whether an effect changes what instruments read, other than a displacement that is not the target.
bool changes_what_is_judged(const effects::Effect& e, const std::string& target) {
  if (!effects::has_reading_effects({e})) return false;
  const std::string own = e.place_kind == effects::Place::kDisplacement ? e.place : effects::read_at_nut(e);
  return own.empty() || own == target;
}

std::string speed_channel(const Record& record) {
  const Channel* speed = record.find("speed");
  if (!speed || speed->unit != "rpm") return {};
  const auto [low, high] = std::minmax_element(speed->values.begin(), speed->values.end());
  return *high > *low || *high > 0.0 ? "speed" : "";
}

/// The ambient among the channels of a simulated record: a sensor on it, or `ambient`.
std::string ambient_channel(const Scenario& scenario, const Record& record) {
  const std::vector<std::string> sensors = ambient_sensors(scenario);
  if (!sensors.empty()) return sensors.front();
  return record.find(scenarios::kAmbient) ? scenarios::kAmbient : "";
}

constexpr double kWarm_K = 4.0;  // largest difference to the ambient at which a model may start from it

/// Why a run does not begin in balance with its ambient, judged by its first readings; "" if it does, and for a machine
/// that is warmer than its ambient at rest.
std::string why_not_in_balance(const scenarios::MachineModel& machine, const MachineRun& run) {
  if (machine.start == scenarios::Start::kSteady) return "";
  const double ambient_C = run.ambient.at(0.0) + machine.reference_K - kZeroCelsius_K;
  for (const scenarios::Sensor& s : machine.sensors) {
    const Channel* c = run.readings.find(s.name);
    if (!c || scenarios::is_on_ambient(s) || !(std::abs(c->values.front() - ambient_C) > kWarm_K)) continue;
    return fmt::format(
        "{} begins with {} at {:.1f} degC at an ambient temperature of {:.1f} degC, and a model starts as warm as the "
        "ambient",
        run.readings.source, s.name, c->values.front(), ambient_C);
  }
  return "";
}

/// For strategies that are judged on records. @param runs  for training and judging; @param training  the former alone
LinearPhysics physics_for_records(const Scenario& scenario, const std::vector<const MachineRun*>& runs,
                                  std::span<const MachineRun> training, const compensation::StrategySettings& how,
                                  const Listener& listener) {
  if (!scenario.machine) return {std::nullopt, "the scenario has no machine"};
  const scenarios::MachineModel& machine = *scenario.machine;
  if (!how.count_from_start)
    return {std::nullopt, "a model knows drift since the start of a run, so `study: {count_from_start: true}` is required"};
  if (effects::has_reading_effects(machine.effects))
    return {std::nullopt, "the scenario's effects change what instruments read, and a model gives what is true"};
  if (machine.start != scenarios::Start::kAmbient && machine.start != scenarios::Start::kSteady)
    return {std::nullopt,
            "every record begins at an ambient temperature of its own, so `start: ambient` is required, or `start: steady` "
            "for a "
            "machine with heat at rest"};
  std::vector<const Cyclogram*> cyclograms;
  for (const MachineRun* run : runs) {
    if (std::string why = why_no_model_follows(machine, *run); !why.empty()) return {std::nullopt, std::move(why)};
    cyclograms.push_back(&run->cyclogram);
  }
  Scenario reduced = scenario;
  for (const MachineRun* run : runs) {  // temperatures that the model must cover: the recorded ambients
    TimeSeries& ambient = reduced.machine->ambient;
    for (double v : run->ambient.value) {
      ambient.time_s.push_back(ambient.time_s.back() + 1.0);
      ambient.value.push_back(v);
    }
  }
  if (std::holds_alternative<scenarios::LumpedMachine>(machine.mesh)) reduced.solver.model = scenarios::ModelKind::kReduced;
  if (reduced.solver.model != scenarios::ModelKind::kReduced)
    return {std::nullopt, "`solver: {model: reduced}` is required"};
  try {
    const scenarios::Model model = scenarios::open_model(reduced, cyclograms, listener, false);
    const auto& outputs = model.outputs().name;
    for (const std::string& name : how.candidates) {
      if (std::find(outputs.begin(), outputs.end(), name) == outputs.end())
        return {std::nullopt, fmt::format("the scenario's machine has no sensor '{}'", name)};
    }
    return linear_physics(scenario, model, training, 0.0, 1);
  } catch (const InputError& e) {  // a machine that cannot be reduced
    return {std::nullopt, e.what()};
  } catch (const SolveError& e) {  // for example heat that cannot leave
    return {std::nullopt, e.what()};
  }
}

}  // namespace

std::string why_no_model_follows(const scenarios::MachineModel& machine, const MachineRun& run) {
  if (run.cyclogram.sections.empty()) return fmt::format("{} does not say what drove the machine", run.readings.source);
  return why_not_in_balance(machine, run);
}

namespace {

std::vector<std::string> thermometers_in(const Record& record, const std::string& target) {
  std::vector<std::string> names;
  for (const Channel& c : record.channels) {
    const bool is_temperature = is_temperature_unit(c.unit) && c.name != scenarios::kAmbient;
    if (is_temperature && &c != record.find(target)) names.push_back(c.name);
  }
  return names;
}

}  // namespace

bool has_thermometers(const scenarios::Study& study, const Record& record) {
  return !study.candidates.empty() || !thermometers_in(record, study.target).empty();
}

std::vector<std::string> candidate_sensors(const scenarios::Study& study, const Record& record) {
  if (!study.candidates.empty()) return study.candidates;
  std::vector<std::string> names = thermometers_in(record, study.target);
  if (names.empty()) throw InputError(fmt::format("{}: no temperature channel (degC or K) to choose from", record.source));
  return names;
}

std::vector<std::string> usable_sensors(const std::vector<Record>& records, const std::vector<std::string>& candidates) {
  std::vector<std::string> usable;
  for (const std::string& name : candidates) {
    const bool is_there = std::all_of(records.begin(), records.end(), [&](const Record& record) {
      const std::vector<double>& x = record.at(name).values;
      const auto n_missing = std::count_if(x.begin(), x.end(), [](double v) { return std::isnan(v); });
      return 2 * static_cast<std::size_t>(n_missing) < x.size();
    });
    if (is_there) usable.push_back(name);
  }
  if (usable.empty())
    throw InputError(
        fmt::format("each of the candidates ({}) is missing in half the rows of a record", fmt::join(candidates, ", ")));
  return usable;
}

std::optional<Record> as_judged(const Validation& v, const std::string& cyclogram, const Record& exact) {
  std::size_t run = v.train.size();
  for (const Validation::Family& family : v.families) {
    for (const Validation::Season& season : v.seasons) {
      for (const Cyclogram& c : family.cyclograms) {
        if (&season == &v.seasons.front() && c.name == cyclogram) return as_read(exact, instrument_of(v), seed_of(v, run));
        ++run;
      }
    }
  }
  return std::nullopt;
}

namespace {

/// For strategies that are judged in simulation. The reduced model of a network costs nothing: it is opened though the
/// scenario asks for the full one.
LinearPhysics physics_for_simulation(const Scenario& scenario, const scenarios::Model& model,
                                     std::span<const MachineRun> training) {
  const Validation& v = *scenario.validation;
  try {
    std::optional<scenarios::Model> own;
    if (!model.reduced() && std::holds_alternative<scenarios::LumpedMachine>(scenario.machine->mesh)) {
      Scenario reduced = scenario;
      reduced.solver.model = scenarios::ModelKind::kReduced;
      std::vector<const Cyclogram*> cyclograms;
      for (const Cyclogram& c : v.train) cyclograms.push_back(&c);
      own.emplace(scenarios::open_model(reduced, cyclograms, {}, false));
    }
    return linear_physics(scenario, own ? *own : model, training, v.model_scatter, v.seed);
  } catch (const InputError& e) {
    return {std::nullopt, e.what()};
  } catch (const SolveError& e) {
    return {std::nullopt, e.what()};
  }
}

}  // namespace

Record read_in_validation(const Validation& v, Record exact, std::size_t run) {
  return as_read(std::move(exact), instrument_of(v), seed_of(v, run));
}

StrategyTraining strategy_training(const Scenario& scenario, const scenarios::Model& model) {
  const Validation& v = *scenario.validation;
  const scenarios::Study& study = *scenario.study;
  for (const effects::Effect& e : scenario.machine->effects) {
    if (changes_what_is_judged(e, study.target))
      throw InputError(
          e.where, fmt::format("strategies are judged by the true drift of '{}' and by what thermometers read; '{}' changes "
                               "that: leave this effect out",
                               study.target, e.name()));
  }
  std::vector<MachineRun> runs(v.train.size());
  parallel_for(runs.size(), [&](std::size_t i) { runs[i] = simulate(scenario, model, {&v.train[i], &v.seasons.front()}); });
  const std::vector<std::string> candidates = candidate_sensors(study, runs.front().readings);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].readings = read_in_validation(v, std::move(runs[i].readings), i);
    Random random(seed_of(v, i), 99);
    for (double& um : changeable_channel(runs[i].readings, study.target).values) um += v.drift_noise_um * random.normal();
  }
  compensation::StrategySettings how;
  how.target = study.target;
  how.candidates = candidates;
  how.n_sensors = study.sensors_to_choose;
  how.count_from_start = true;
  how.limits = scenario.limits.correction;
  how.image = study.image;
  how.speed = speed_channel(runs.front().readings);
  how.ambient = ambient_channel(scenario, runs.front().readings);
  how.reading_K = std::max(1e-3, std::hypot(v.noise_K, kRounding * v.resolution_K));
  how.drift_um = std::max(0.1, v.drift_noise_um);
  LinearPhysics physics = physics_for_simulation(scenario, model, runs);
  how.physics = std::move(physics.physics);
  how.without_physics = std::move(physics.why_none);
  return {std::move(runs), std::move(how)};
}

compensation::StrategyMatrix validate_strategies(const Scenario& scenario, const scenarios::Model& model,
                                                 const std::optional<compensation::Probing>& probing,
                                                 const Listener& listener) {
  const Validation& v = *scenario.validation;
  StrategyTraining training = strategy_training(scenario, model);
  std::vector<Job> jobs;
  std::vector<compensation::JudgedRunOfMachine> judged;
  for (const Validation::Family& family : v.families) {
    for (const Validation::Season& season : v.seasons) {
      for (const Cyclogram& c : family.cyclograms) {
        jobs.push_back({&c, &season});
        judged.push_back({family.name, season.name, c.name, {}});
      }
    }
  }
  listener.begin(fmt::format("simulating {} runs", jobs.size()));
  parallel_for(jobs.size(),
               [&](std::size_t i) {
                 judged[i].run = simulate(scenario, model, jobs[i]);
                 judged[i].run.readings = read_in_validation(v, std::move(judged[i].run.readings), v.train.size() + i);
               },
               {.on_begin = {}, .on_share = listener.on_share, .wants_end_now = {}});
  compensation::MatrixSettings settings;
  settings.strategies = std::move(training.settings);
  settings.strategies.probing = probing;
  settings.tolerance_um = v.tolerance_um;
  settings.fails_at = v.fails_at;
  settings.fails_in = v.seasons.front().name;
  settings.elsewhere = settings.strategies.ambient;
  listener.begin(fmt::format("fitting and judging strategies on {} runs", judged.size()));
  return compensation::judge_strategies(settings, std::move(training.runs), std::move(judged));
}

compensation::StrategyMatrix validate_on_records(const Scenario& scenario, StudyRecords records,
                                                 const std::optional<compensation::Probing>& probing,
                                                 const Listener& listener) {
  const scenarios::Study& study = *scenario.study;
  const std::vector<Record> training = own_records(records.train);
  compensation::MatrixSettings settings;
  compensation::StrategySettings& how = settings.strategies;
  how.target = study.target;
  const bool has_drive = !records.ambient.empty() || !speed_channel(training.front()).empty();
  if (!has_drive || has_thermometers(study, training.front()))
    how.candidates = usable_sensors(training, candidate_sensors(study, training.front()));
  how.n_sensors = study.sensors_to_choose;
  how.count_from_start = study.count_from_start;
  how.limits = scenario.limits.correction;
  how.probing = probing;
  how.image = study.image;
  how.speed = speed_channel(training.front());
  how.ambient = records.ambient;
  std::vector<const MachineRun*> all;
  for (const std::vector<MachineRun>* list : {&records.train, &records.test}) {
    for (const MachineRun& run : *list) all.push_back(&run);
  }
  LinearPhysics physics = physics_for_records(scenario, all, records.train, how, listener);
  how.physics = std::move(physics.physics);
  how.without_physics = std::move(physics.why_none);
  const Channel* elsewhere = how.ambient.empty() ? nullptr : records.train.front().readings.find(how.ambient);
  if (elsewhere && !how.candidates.empty() && elsewhere->unit == training.front().at(how.candidates.front()).unit)
    settings.elsewhere = how.ambient;
  std::vector<compensation::JudgedRunOfMachine> judged;
  for (MachineRun& run : records.test) {
    const std::string name = std::filesystem::path(run.readings.source).filename().string();
    judged.push_back({"measured", "", name, std::move(run)});
  }
  settings.tolerance_um = study.tolerance_um;
  settings.fails_at = 0.5;
  listener.begin(fmt::format("fitting and judging strategies on {} records", judged.size()));
  compensation::StrategyMatrix matrix =
      compensation::judge_strategies(settings, std::move(records.train), std::move(judged));
  matrix.findings.insert(matrix.findings.begin(), records.findings.begin(), records.findings.end());
  return matrix;
}

JudgedTravel judge_places(Scenario scenario, const std::vector<scenarios::DisplacementOutput>& places,
                          const std::function<compensation::StrategyMatrix(const Scenario&)>& judge) {
  JudgedTravel judged;
  std::vector<double> at_m;
  for (const scenarios::DisplacementOutput& place : places) {
    scenario.study->target = place.name;
    judged.places.push_back(judge(scenario));
    judged.places.back().settings.strategies.place = ScrewPlace{place.on_screw->screw, *place.on_screw->at_m};
    at_m.push_back(*place.on_screw->at_m);
  }
  std::vector<TravelPlace> read;
  const std::vector<JudgedRunOfMachine>& runs = judged.places.front().runs;
  for (const scenarios::DisplacementOutput& d : scenarios::places_along(*scenario.machine, places.front().name)) {
    if (std::all_of(runs.begin(), runs.end(), [&](const auto& r) { return r.run.readings.find(d.name) != nullptr; }))
      read.push_back({d.name, *d.on_screw->at_m});
  }
  judged.travel = judge_travel(judged.places, at_m, std::move(read));
  return judged;
}

}  // namespace driftwright::studies
