#include "studies/warm_up_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/reading_chain.hpp"
#include "machine/machine.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::studies {

WarmUpTrials::WarmUpTrials(const scenarios::Scenario& scenario, const Cyclogram& job, const WarmUpOptions& options,
                           double most_rpm, const Listener& listener)
    : job_(job), transient_(scenario.solver.transient), interval_s_(scenario.solver.output_interval_s) {
  Cyclogram horizon = job;  // as long and as fast as any programme
  horizon.sections.insert(horizon.sections.begin(), {options.most_s, Drive{.speed_rpm = most_rpm}});
  PredictingModels models;
  ahead_ = outlook_of(scenario, horizon, options.from, listener, "warmup", models);
  now_s_ = ahead_.series.start_s();
  for (const auto& d : ahead_.machine.displacements) {
    const auto& wanted = options.channels;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), d.name) != wanted.end()) channels_.push_back(d.name);
  }
  for (const std::string& name : options.channels) {
    if (std::find(channels_.begin(), channels_.end(), name) != channels_.end()) continue;
    std::string there;
    for (const auto& d : ahead_.machine.displacements) there += (there.empty() ? "" : ", ") + d.name;
    throw InputError(fmt::format("--channel '{}': no displacement of the machine; there are {}", name, there));
  }
  if (channels_.empty())
    throw InputError(ahead_.machine.where, "`warmup` needs a displacement that drifts: add one to `displacements`");
  whole_before_.name = job.name;
  reads_back_ = !effects::reading_chain(ahead_.machine.effects, job.name).empty();
  for (const Cyclogram::Section& section : ahead_.series.cyclogram.sections) {
    if (whole_before_.duration_s() >= now_s_) break;
    whole_before_.sections.push_back(section);
  }
  go_to_now();
}

WarmUpTrials::WarmUpTrials(const WarmUpTrials& same, std::shared_ptr<const scenarios::Model> other)
    : job_(same.job_),
      transient_(same.transient_),
      interval_s_(same.interval_s_),
      ahead_(same.ahead_),
      now_s_(same.now_s_),
      whole_before_(same.whole_before_),
      reads_back_(same.reads_back_),
      channels_(same.channels_) {
  ahead_.model = std::move(other);
  transient_.from_s = 0.0;
  go_to_now();
}

void WarmUpTrials::go_to_now() {
  const auto has_thermostats = [](const auto& system) { return !system.thermostats.empty(); };
  const scenarios::Model& model = *ahead_.model;
  const bool switches = model.reduced() ? has_thermostats(model.reduced()->system) : has_thermostats(model.full()->system);
  is_linear_ = !reads_back_ && model.reduced() && model.reduced()->system.is_linear();
  for (const std::string& name : channels_) {
    const std::vector<std::string>& names = model.outputs().name;
    outputs_.push_back(std::find(names.begin(), names.end(), name) - names.begin());
  }
  before_ = whole_before_;
  if (!reads_back_ && !switches && now_s_ > 0.0) {  // the run before is fully described by the state
    (void)scenarios::simulate_run(ahead_.machine, transient_, model, ahead_.start, before_, {now_s_},
                                  [&](double, const Eigen::VectorXd& state) { now_ = state; });
    transient_.from_s = now_s_;
    before_.sections = {{now_s_, Drive{}}};
  } else {
    now_ = ahead_.start;
  }
}

Cyclogram WarmUpTrials::joined(const Cyclogram& before, const std::vector<Cyclogram::Section>& sections,
                               double& start_s) const {
  Cyclogram all = before;
  all.sections.insert(all.sections.end(), sections.begin(), sections.end());
  start_s = all.duration_s();
  all.sections.insert(all.sections.end(), job_.sections.begin(), job_.sections.end());
  return all;
}

Record WarmUpTrials::job_rows(const std::vector<Cyclogram::Section>& sections) const {
  double start_s = 0.0;
  const Cyclogram all = joined(before_, sections, start_s);
  std::vector<double> time_s;
  const double end_s = all.duration_s();
  if (reads_back_) {  // instruments depend on earlier rows, from the first one on
    for (double t_s : scenarios::output_times_s(all, interval_s_)) {
      if (t_s < start_s - 1e-6) time_s.push_back(t_s);
    }
  }
  const auto n_before = static_cast<std::ptrdiff_t>(time_s.size());
  for (double t_s : scenarios::output_times_s(job_, interval_s_)) time_s.push_back(std::min(start_s + t_s, end_s));
  time_s.back() = end_s;
  ++n_tried_;
  Record rows = scenarios::simulate_run(ahead_.machine, transient_, *ahead_.model, now_, all, time_s).record;
  rows.time_s.erase(rows.time_s.begin(), rows.time_s.begin() + n_before);
  for (double& t_s : rows.time_s) t_s -= start_s;
  for (Channel& channel : rows.channels) channel.values.erase(channel.values.begin(), channel.values.begin() + n_before);
  for (Channel& channel : rows.channels) {
    if (channel.unit != "um" && channel.unit != "urad") continue;
    const double zero = channel.values.front();
    for (double& value : channel.values) value -= zero;
  }
  return rows;
}

MachineRun WarmUpTrials::whole_run(const std::vector<Cyclogram::Section>& sections, std::size_t& n_before) const {
  double start_s = 0.0;
  MachineRun run{.cyclogram = joined(whole_before_, sections, start_s), .ambient = ahead_.machine.ambient, .readings = {}};
  Cyclogram until = run.cyclogram;
  until.sections.resize(until.sections.size() - job_.sections.size());
  std::vector<double> time_s;
  if (start_s > 0.0) time_s = scenarios::output_times_s(until, interval_s_);
  if (!time_s.empty()) time_s.pop_back();  // it is the job's first row
  n_before = time_s.size();
  const double end_s = run.cyclogram.duration_s();
  for (double t_s : scenarios::output_times_s(job_, interval_s_)) time_s.push_back(std::min(start_s + t_s, end_s));
  solver::TransientOptions from_the_start = transient_;
  from_the_start.from_s = 0.0;
  run.readings =
      scenarios::simulate_run(ahead_.machine, from_the_start, *ahead_.model, ahead_.start, run.cyclogram, time_s).record;
  run.readings.source = job_.name;
  return run;
}

std::vector<double> WarmUpTrials::linear_peaks_um(const std::vector<Cyclogram::Section>& sections) const {
  const solver::ReducedSystem& system = ahead_.model->reduced()->system;
  double start_s = 0.0;
  const Cyclogram all = joined(before_, sections, start_s);
  const double end_s = all.duration_s();
  std::vector<double> time_s;
  for (double t_s : scenarios::output_times_s(job_, interval_s_)) time_s.push_back(std::min(start_s + t_s, end_s));
  time_s.back() = end_s;
  ++n_tried_;
  std::unique_ptr<solver::Propagator> propagator;
  {
    const std::lock_guard lock(idle_mutex_);
    if (!idle_.empty()) {
      propagator = std::move(idle_.back());
      idle_.pop_back();
    }
  }
  if (!propagator) propagator = std::make_unique<solver::Propagator>(system);
  const MachineRun felt = scenarios::felt_run(ahead_.machine, all);
  const Eigen::MatrixXd rows =
      propagator->run(felt.cyclogram, felt.ambient, time_s, now_, false, nullptr, transient_.from_s).outputs;
  {
    const std::lock_guard lock(idle_mutex_);
    idle_.push_back(std::move(propagator));
  }
  std::vector<double> peaks_um;
  for (Eigen::Index output : outputs_)
    peaks_um.push_back(1e6 * (rows.row(output).array() - rows(output, 0)).abs().maxCoeff());
  return peaks_um;
}

WarmUp WarmUpTrials::tried(std::vector<Cyclogram::Section> sections, double tolerance_um) const {
  WarmUp result{.way = {}, .sections = std::move(sections)};
  std::vector<double> peaks_um(channels_.size(), 0.0);
  try {
    if (is_linear_) {
      peaks_um = linear_peaks_um(result.sections);
    } else {
      const Record rows = job_rows(result.sections);
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        for (double value_um : rows.at(channels_[c]).values) peaks_um[c] = std::max(peaks_um[c], std::abs(value_um));
      }
    }
  } catch (const SolveError&) {
    if (result.sections.empty()) throw;
    result.peak_um = std::numeric_limits<double>::max();
    return result;
  }
  const auto largest = std::max_element(peaks_um.begin(), peaks_um.end());
  result.peak_um = *largest;
  result.peak_channel = channels_[static_cast<std::size_t>(largest - peaks_um.begin())];
  result.is_enough = result.peak_um <= tolerance_um;
  return result;
}

}  // namespace driftwright::studies
