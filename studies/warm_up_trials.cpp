#include "studies/warm_up_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/reading_chain.hpp"
#include "machine/machine.hpp"

namespace driftwright::studies {

WarmUpTrials::WarmUpTrials(const scenarios::Scenario& scenario, const Cyclogram& job, const WarmUpOptions& options, double most_rpm,
                           const Listener& listener)
    : job_(job), transient_(scenario.solver.transient), interval_s_(scenario.solver.output_interval_s) {
  Cyclogram horizon = job;  // as far ahead as any programme looks, and as fast
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
  if (channels_.empty()) throw InputError(ahead_.machine.where, "`warmup` needs a displacement that drifts: add one to `displacements`");
  before_.name = job.name;
  reads_back_ = !effects::reading_chain(ahead_.machine.effects, job.name).empty();
  for (const Cyclogram::Section& section : ahead_.series.cyclogram.sections) {
    if (before_.duration_s() >= now_s_) break;
    before_.sections.push_back(section);
  }
  const auto has_thermostats = [](const auto& system) { return !system.thermostats.empty(); };
  const scenarios::Model& model = *ahead_.model;
  const bool switches = model.reduced() ? has_thermostats(model.reduced()->system) : has_thermostats(model.full()->system);
  if (!reads_back_ && !switches && now_s_ > 0.0) {  // what was before is in the state alone
    (void)scenarios::simulate_run(ahead_.machine, transient_, model, ahead_.start, before_, {now_s_},
                                  [&](double, const Eigen::VectorXd& state) { now_ = state; });
    transient_.from_s = now_s_;
    before_.sections = {{now_s_, Drive{}}};
  } else {
    now_ = ahead_.start;
  }
}

Record WarmUpTrials::job_rows(const std::vector<Cyclogram::Section>& sections) const {
  Cyclogram all = before_;
  all.sections.insert(all.sections.end(), sections.begin(), sections.end());
  const double start_s = all.duration_s();
  all.sections.insert(all.sections.end(), job_.sections.begin(), job_.sections.end());
  std::vector<double> time_s;
  const double end_s = all.duration_s();
  if (reads_back_) {  // instruments remember what was before, from the first row on
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

WarmUp WarmUpTrials::tried(std::vector<Cyclogram::Section> sections, double tolerance_um) const {
  WarmUp result{.way = {}, .sections = std::move(sections)};
  Record rows;
  try {
    rows = job_rows(result.sections);
  } catch (const SolveError&) {
    if (result.sections.empty()) throw;
    result.peak_um = std::numeric_limits<double>::max();
    return result;
  }
  for (const std::string& name : channels_) {
    for (double value_um : rows.at(name).values) {
      if (std::abs(value_um) < result.peak_um) continue;
      result.peak_um = std::abs(value_um);
      result.peak_channel = name;
    }
  }
  result.is_enough = result.peak_um <= tolerance_um;
  return result;
}

}  // namespace driftwright::studies
