#include "studies/programme_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "base/random.hpp"
#include "compensation/judging/correction.hpp"
#include "compensation/judging/model_scatter.hpp"
#include "compensation/predictors/driven_predictor.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/propagator.hpp"
#include "studies/planner.hpp"

namespace driftwright::studies {
namespace {

using namespace compensation;

constexpr int kMostModelModes = 40;
constexpr double kWantedPercent = 1.0;
constexpr double kBalance_K = 0.01;

/// Channels since the start, as rows.
Eigen::MatrixXd rows_of(const Record& record, const TestChannels& channels) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(channels.name.size()), static_cast<Eigen::Index>(record.time_s.size()));
  for (std::size_t c = 0; c < channels.name.size(); ++c) {
    const std::vector<double>& values = record.at(channels.name[c]).values;
    for (std::size_t i = 0; i < values.size(); ++i)
      rows(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(i)) = values[i] - values.front();
  }
  return rows;
}

/// The channels of tests; temperatures help to find the time constants that displacements share.
struct TestBed {
  TestChannels all;                ///< displacements, tilts, temperatures
  std::vector<ThermalTest> tests;  ///< noisy
};

void add_noise(std::vector<ThermalTest>& tests, const TestChannels& channels, const scenarios::Programme& p) {
  for (std::size_t t = 0; t < tests.size(); ++t) {
    for (std::size_t c = 0; c < channels.name.size(); ++c) {
      const double sd = channels.unit[c] == "K" ? p.temperature_noise_K
                                                : p.displacement_noise_um * (channels.unit[c] == "urad" ? 10.0 : 1.0);
      Random random(static_cast<std::uint64_t>(p.seed), 1000 * (t + 1) + c);
      for (Eigen::Index i = 0; i < tests[t].readings.cols(); ++i)
        tests[t].readings(static_cast<Eigen::Index>(c), i) += sd * random.normal();
    }
  }
}

TimeSeries from_start(TimeSeries ambient) {
  const double start_K = ambient.at(0.0);
  for (double& v : ambient.value) v -= start_K;
  return ambient;
}

PredictionError error_of(const Eigen::MatrixXd& truth, const Eigen::MatrixXd& predicted, const TestChannels& channels,
                         Eigen::Index channel) {
  PredictionError e;
  e.peak = truth.row(channel).cwiseAbs().maxCoeff();
  const Eigen::ArrayXd off = (truth.row(channel) - predicted.row(channel)).cwiseAbs();
  e.largest = off.maxCoeff();
  e.mean = off.mean();
  Eigen::ArrayXd square = Eigen::ArrayXd::Zero(truth.cols());
  for (Eigen::Index c = 0; c < truth.rows(); ++c) {
    if (channels.unit[static_cast<std::size_t>(c)] == channels.unit[static_cast<std::size_t>(channel)])
      square += truth.row(c).array().square().transpose();
  }
  e.of = std::max(e.peak, 0.1 * std::sqrt(square.maxCoeff()));
  return e;
}

/// Rows of a trajectory, in um and urad since the start.
Eigen::MatrixXd rows_of(const solver::Trajectory& run, const solver::Outputs& outputs, const TestChannels& channels) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(channels.name.size()), run.outputs.cols());
  for (std::size_t c = 0; c < channels.name.size(); ++c) {
    const auto o = std::find(outputs.name.begin(), outputs.name.end(), channels.name[c]) - outputs.name.begin();
    rows.row(static_cast<Eigen::Index>(c)) = 1e6 * (run.outputs.row(o).array() - run.outputs(o, 0));
  }
  return rows;
}

std::vector<double> row_of(const Eigen::MatrixXd& rows, Eigen::Index channel) {
  const Eigen::VectorXd row = rows.row(channel);
  return {row.begin(), row.end()};
}

/// All channels of a cyclogram since the start, in um and urad, n_channels x n_times. @param ambient  minus the reference
/// temperature [K]
using Courses =
    std::function<Eigen::MatrixXd(const Cyclogram& cyclogram, const TimeSeries& ambient, const std::vector<double>& time_s)>;

/// One predictor per channel, each of which uses its row.
std::vector<compensation::DeployedPredictor> predictors_of(const std::string& name, const TestChannels& channels,
                                                           const Courses& courses) {
  std::vector<compensation::DeployedPredictor> list;
  for (std::size_t c = 0; c < channels.name.size(); ++c) {
    compensation::DeployedPredictor d;
    d.name = name;
    d.target = channels.name[c];
    d.from_start = true;
    d.predictor = std::make_shared<DrivenPredictor>(
        [courses, row = static_cast<Eigen::Index>(c)](const Cyclogram& cyclogram, const TimeSeries& ambient,
                                                      const std::vector<double>& time_s) {
          return row_of(courses(cyclogram, ambient, time_s), row);
        });
    list.push_back(std::move(d));
  }
  return list;
}

/// Courses by a linear model from its state at the start, from the real drive and ambient of the machine.
Courses by_model(const scenarios::MachineModel& machine, const TestChannels& channels, const solver::ReducedSystem& system,
                 const Eigen::VectorXd& start) {
  struct Owned {
    explicit Owned(const solver::ReducedSystem& s) : system(s), propagator(system) {}
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;
    solver::ReducedSystem system;
    solver::Propagator propagator;  // refers to the system beside it, which must not move
  };
  // Shared, since the function is copied for each channel; all copies then use the same decompositions.
  return [machine, channels, start, owned = std::make_shared<Owned>(system)](
             const Cyclogram& cyclogram, const TimeSeries& ambient, const std::vector<double>& time_s) {
    scenarios::MachineModel there = machine;
    there.ambient = ambient;
    const MachineRun felt = scenarios::felt_run(there, cyclogram);
    return rows_of(owned->propagator.run(felt.cyclogram, felt.ambient, time_s, start), owned->system.outputs, channels);
  };
}

/// Predictions of all channels for all judged cyclograms, before they run. @param ambient  minus the reference
/// temperature [K]
JudgedPredictor judged(const ProgrammeStudy& study, const TimeSeries& ambient, const std::string& name,
                       const Courses& courses) {
  JudgedPredictor p{predictors_of(name, study.channels, courses), {}, {}, 0.0};
  const auto start = std::chrono::steady_clock::now();
  for (const JudgedCyclogram& j : study.judged) {
    const MachineRun known{j.cyclogram, ambient, {.source = {}, .time_s = j.time_s, .channels = {}}};
    Eigen::MatrixXd predicted(j.truth.rows(), j.truth.cols());
    for (std::size_t c = 0; c < p.channels.size(); ++c) {
      const std::vector<double> row = ahead(*p.channels[c].predictor, known);
      predicted.row(static_cast<Eigen::Index>(c)) =
          Eigen::Map<const Eigen::RowVectorXd>(row.data(), static_cast<Eigen::Index>(row.size()));
    }
    p.predicted.push_back(std::move(predicted));
  }
  p.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() /
              static_cast<double>(study.judged.size() * p.channels.size());
  for (std::size_t i = 0; i < study.judged.size(); ++i) {
    p.errors.emplace_back();
    for (Eigen::Index c = 0; c < p.predicted[i].rows(); ++c)
      p.errors.back().push_back(error_of(study.judged[i].truth, p.predicted[i], study.channels, c));
  }
  return p;
}

double largest_percent(const JudgedPredictor& p) {
  double largest = 0.0;
  for (const auto& cyclogram : p.errors) {
    for (const PredictionError& e : cyclogram) largest = std::max(largest, e.largest_percent());
  }
  return largest;
}

/// Plans corrections on each prediction of a random cyclogram, and computes what the true drift leaves.
ProgrammeStudy::Scheduled schedule_with(const ProgrammeStudy& study, const JudgedPredictor& p, std::size_t channel,
                                        double tolerance_um, SchedulePolicy policy, const CorrectionLimits& limits) {
  ProgrammeStudy::Scheduled s{p.name(), study.channels.name[channel]};
  const auto c = static_cast<Eigen::Index>(channel);
  for (std::size_t i = 0; i < study.judged.size(); ++i) {
    const JudgedCyclogram& j = study.judged[i];
    if (!j.is_random) continue;
    std::vector<double> durations_s;
    for (const auto& section : j.cyclogram.sections) durations_s.push_back(section.duration_s);
    std::vector<double> boundaries_s = operation_boundaries_s(durations_s);
    boundaries_s.back() = std::min(boundaries_s.back(), j.time_s.back());
    const std::vector<double> drift_um = row_of(j.truth, c);
    // Half of the tolerance is reserved for the predictor's error.
    const CorrectedDrift corrected = correct_by_schedule({j.time_s, drift_um, boundaries_s, tolerance_um},
                                                         row_of(p.predicted[i], c), 0.5 * tolerance_um, policy, limits);
    int changes = 0;
    for (const Operation& o : corrected.schedule->operations)
      changes += static_cast<int>(std::count_if(o.corrections.begin(), o.corrections.end(),
                                                [](const Correction& change) { return change.delta_um != 0.0; }));
    ++s.n_cyclograms;
    s.n_inside += corrected.inside_tolerance;
    s.worst_um = std::max(s.worst_um, corrected.after.peak_abs);
    s.mean_changes += changes;
    s.most_changes = std::max(s.most_changes, changes);
  }
  if (s.n_cyclograms > 0) s.mean_changes /= s.n_cyclograms;
  return s;
}

/// @throws InputError  for a machine that does not start in balance with the ambient, and for effects on readings
void require_true_drift_from_balance(const scenarios::Programme& programme, const scenarios::MachineModel& machine) {
  const bool starts_with_the_ambient =
      machine.start == scenarios::Start::kAmbient || machine.start == scenarios::Start::kSteady ||
      std::abs((machine.start == scenarios::Start::kUniform ? machine.start_K - machine.reference_K : 0.0) -
               scenarios::felt_ambient_at_start_K(machine)) < kBalance_K;
  if (!starts_with_the_ambient) {
    throw InputError(
        programme.where,
        "tests and cyclograms of a programme start in balance with the ambient; write `start: ambient` or `start: steady`");
  }
  if (effects::has_reading_effects(machine.effects)) {
    throw InputError(
        programme.where,
        "a programme judges true drift; leave out the effects that change what instruments read and nothing else");
  }
}

/// The displacements and tilts.
TestChannels channels_of_programme(const scenarios::MachineModel& machine) {
  TestChannels channels;
  for (const auto& d : machine.displacements) {
    channels.name.push_back(d.name);
    channels.unit.emplace_back("um");
  }
  for (const auto& t : machine.tilts) {
    channels.name.push_back(t.name);
    channels.unit.emplace_back("urad");
  }
  return channels;
}

/// Predictors from the reduced model: as few of its modes as are enough, the same with fixed rates, with wrong numbers, and
/// these scaled to the tests.
void add_by_model(ProgrammeStudy& study, const scenarios::Scenario& scenario, const scenarios::Model& model,
                  const std::vector<Cyclogram>& tests, const TestBed& bed, const Listener& listener) {
  const scenarios::Programme& programme = *scenario.programme;
  const scenarios::MachineModel& machine = *scenario.machine;
  const double ambient_K = scenarios::felt_ambient_at_start_K(machine);
  const auto add = [&](const std::string& name, const Courses& courses) {
    study.predictors.push_back(judged(study, machine.ambient, name, courses));
  };
  const scenarios::ReducedMachine* reduced = model.reduced();
  if (!reduced) {
    study.without_model =
        "they come from a reduced model, and this machine was run in full (a lumped one, or `model: full`)";
  } else if (!reduced->system.is_linear()) {
    study.without_model = "they come from a linear model, and in this one films, heat or thermostats follow temperatures";
  } else {
    listener.begin("modes of the model");
    const solver::ReducedSystem& system = reduced->system;
    std::vector<const Cyclogram*> pointers;
    for (const Cyclogram& c : tests) pointers.push_back(&c);
    const effects::Inputs standstill{.drive = {}, .ambient_K = ambient_K},
        typical{.drive = mean_drive(pointers), .ambient_K = ambient_K};
    for (int n = 1; n <= std::min(kMostModelModes, system.size()); ++n) {
      const ModalPredictor p = make_ritz_predictor(system, reduced->start, n, standstill);
      JudgedPredictor trial = judged(study, machine.ambient, fmt::format("{} modes of the model", n),
                                     by_model(machine, study.channels, p.system, p.start));
      study.error_by_modes.emplace_back(n, largest_percent(trial));
      const bool is_enough = study.error_by_modes.back().second <= kWantedPercent;
      if (!is_enough && n < std::min(kMostModelModes, system.size())) continue;
      study.n_modes_wanted = is_enough ? n : 0;
      study.time_constant_s = p.time_constant_s;
      study.predictors.push_back(std::move(trial));
      const solver::ReducedSystem frozen = with_fixed_exchanges(p.system, typical);
      add(fmt::format("{} modes of the model, fixed rates", n), by_model(machine, study.channels, frozen, p.start));
      const solver::ReducedSystem wrong = scattered(p.system, programme.model_scatter, programme.seed);
      add("modes of a model that is off", by_model(machine, study.channels, wrong, p.start));
      listener.begin("scaling the model's modes to tests");
      std::vector<ThermalTest> felt_tests = bed.tests;
      for (ThermalTest& t : felt_tests) {
        MachineRun felt = scenarios::felt_run(machine, t.cyclogram);
        t.cyclogram = std::move(felt.cyclogram);
        t.ambient = from_start(std::move(felt.ambient));
      }
      const ScaledModes scaled = fit_scaled_modes(wrong, p.start, ambient_K, felt_tests, bed.all);
      study.factors = scaled.factors;
      add("hybrid: those, scaled to tests", by_model(machine, study.channels, scaled.system, p.start));
      break;
    }
  }
}

}  // namespace

Summary summary(const ProgrammeStudy& study, const JudgedPredictor& predictor, std::size_t channel,
                const std::function<bool(const JudgedCyclogram&)>& counts) {
  Summary s;
  for (std::size_t i = 0; i < study.judged.size(); ++i) {
    if (!counts(study.judged[i])) continue;
    const PredictionError& e = predictor.errors[i][channel];
    s.largest = std::max(s.largest, e.largest);
    s.largest_percent = std::max(s.largest_percent, e.largest_percent());
    s.mean += e.mean;
    s.mean_percent += e.mean_percent();
    ++s.n;
  }
  if (s.n > 0) {
    s.mean /= s.n;
    s.mean_percent /= s.n;
  }
  return s;
}

ProgrammeStudy study_programme(const scenarios::Scenario& scenario, const scenarios::Model& model,
                               const Listener& listener) {
  const scenarios::Programme& programme = *scenario.programme;
  const scenarios::MachineModel& machine = *scenario.machine;
  require_true_drift_from_balance(programme, machine);
  ProgrammeStudy study;
  study.channels = channels_of_programme(machine);

  // --- the truth
  const std::vector<Cyclogram> tests = scenarios::test_cyclograms(programme),
                               random = scenarios::random_cyclograms(programme);
  std::vector<Cyclogram> asked = programme.cyclograms;
  asked.insert(asked.end(), random.begin(), random.end());
  std::vector<const Cyclogram*> all;
  for (const Cyclogram& c : tests) all.push_back(&c);
  for (const Cyclogram& c : asked) all.push_back(&c);
  const std::vector<scenarios::SimulatedRun> runs = scenarios::simulate_cyclograms(scenario, model, all, listener);
  TestBed bed{study.channels, {}};
  for (const scenarios::Sensor& s : machine.sensors) {
    if (scenarios::is_on_ambient(s)) continue;
    bed.all.name.push_back(s.name);
    bed.all.unit.emplace_back("K");
  }
  const TimeSeries ambient = from_start(machine.ambient);
  for (std::size_t t = 0; t < tests.size(); ++t) {
    bed.tests.push_back({tests[t], ambient, runs[t].record.time_s, rows_of(runs[t].record, bed.all)});
  }
  add_noise(bed.tests, bed.all, programme);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Record& record = runs[tests.size() + i].record;
    study.judged.push_back(
        {asked[i], type_of(asked[i]), i >= programme.cyclograms.size(), record.time_s, rows_of(record, study.channels)});
  }
  const std::size_t n_channels = study.channels.name.size();
  const auto displacements = [&](const Eigen::MatrixXd& rows) -> Eigen::MatrixXd {
    return rows.topRows(static_cast<Eigen::Index>(n_channels));
  };

  // --- from tests alone
  listener.begin("identifying modes from tests");
  study.identified = identify_modes(bed.tests, bed.all, {.most_modes = programme.most_modes});
  const auto by_tests = [&](const IdentifiedModes& modes) -> Courses {
    return
        [modes, n = static_cast<Eigen::Index>(n_channels), extrapolate = programme.extrapolate](
            const Cyclogram& cyclogram, const TimeSeries& absolute, const std::vector<double>& time_s) -> Eigen::MatrixXd {
          return modes.predict(cyclogram, from_start(absolute), time_s, extrapolate).topRows(n);
        };
  };
  const auto add = [&](const std::string& name, const Courses& courses) {
    study.predictors.push_back(judged(study, machine.ambient, name, courses));
  };
  add("modes from tests", by_tests(study.identified));
  const IdentifiedModes fixed =
      identify_modes(bed.tests, bed.all, {.most_modes = programme.most_modes, .with_growth = false});
  add("modes from tests, fixed rates", by_tests(fixed));
  listener.begin("cutting curves");
  std::vector<ThermalTest> of_displacements = bed.tests;
  for (ThermalTest& t : of_displacements) t.readings = displacements(t.readings);
  const AssembledCurves curves(of_displacements, study.channels);
  add("assembled curves", [curves, extrapolate = programme.extrapolate](const Cyclogram& cyclogram, const TimeSeries&,
                                                                        const std::vector<double>& time_s) {
    return curves.predict(cyclogram, time_s, extrapolate);
  });

  add_by_model(study, scenario, model, tests, bed, listener);

  // --- schedules along the axis of the study
  const std::string target = scenario.study ? scenario.study->target : study.channels.name.front();
  const auto channel = static_cast<std::size_t>(std::find(study.channels.name.begin(), study.channels.name.end(), target) -
                                                study.channels.name.begin());
  for (const auto& p : study.predictors)
    study.scheduled.push_back(
        schedule_with(study, p, channel, programme.tolerance_um, planner_of(scenario), scenario.limits.correction));
  return study;
}

}  // namespace driftwright::studies
