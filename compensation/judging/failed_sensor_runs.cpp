#include "compensation/judging/failed_sensor_runs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "base/record_channel.hpp"

namespace driftwright::compensation {
namespace {

struct Failure {
  SensorFailure kind;
  const char* word;
};
constexpr Failure kFailures[] = {{SensorFailure::kStuck, "stuck"},
                                 {SensorFailure::kOpen, "open"},
                                 {SensorFailure::kDetached, "fallen off"},
                                 {SensorFailure::kRising, "drifting up"},
                                 {SensorFailure::kFalling, "drifting down"}};

/// The ambient according to a thermometer that fails at a time. If it gives no new readings, the last one stays; otherwise
/// its reading at the failure is used, plus the later change of its channel. If its value is unknown, it stays unknown.
/// @param readings  after the failure; @param channel  of the ambient thermometer in them
TimeSeries failed_ambient(const TimeSeries& ambient, SensorFailure failure, double from_s, const Record& readings,
                          const std::string& channel) {
  if (ambient.time_s.empty()) return ambient;
  TimeSeries told;
  const auto add = [&](double t_s, double value) {
    told.time_s.push_back(t_s);
    told.value.push_back(value);
  };
  for (std::size_t i = 0; i < ambient.time_s.size() && ambient.time_s[i] < from_s; ++i)
    add(ambient.time_s[i], ambient.value[i]);
  add(from_s, ambient.at(from_s));
  if (failure == SensorFailure::kStuck || failure == SensorFailure::kOpen) return told;
  if (failure == SensorFailure::kRising || failure == SensorFailure::kFalling) {
    const double rate_K_s = (failure == SensorFailure::kRising ? 1.0 : -1.0) * kSensorDrift_K_h / 3600.0;
    for (double t_s : readings.time_s) {
      if (t_s > from_s) add(t_s, ambient.at(t_s) + rate_K_s * (t_s - from_s));
    }
    return told;
  }
  const std::vector<double>& read = readings.at(channel).values;  // from another place
  double first = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < read.size(); ++i) {
    const double t_s = readings.time_s[i];
    if (t_s < from_s) {
      if (std::isfinite(read[i])) first = read[i];
    } else if (t_s > from_s && std::isfinite(read[i] - first)) {
      add(t_s, ambient.at(from_s) + read[i] - first);
    }
  }
  return told;
}

/// The thermometer whose readings differ most from a sensor's over the run; "" if there is no other.
std::string least_alike(const MachineRun& run, const std::string& sensor, const std::vector<std::string>& candidates) {
  const Channel& mine = run.readings.at(sensor);
  std::string worst;
  double most = 0.0;
  for (const std::string& name : candidates) {
    const Channel& other = run.readings.at(name);
    if (name == sensor || other.unit != mine.unit) continue;
    std::vector<double> apart;
    for (std::size_t i = 0; i < mine.values.size(); ++i) apart.push_back(other.values[i] - mine.values[i]);
    if (const double rms = score(apart).rmse; rms > most) {
      most = rms;
      worst = name;
    }
  }
  return worst;
}

}  // namespace

std::vector<std::pair<std::string, MachineRun>> runs_with_failures(const MatrixSettings& settings,
                                                                   const DeployedPredictor& strategy,
                                                                   const JudgedRunOfMachine& judged, double start_s,
                                                                   double end_s) {
  std::vector<std::pair<std::string, MachineRun>> list = {{"", judged.run}};
  if (!settings.fails_at || judged.season != settings.fails_in) return list;
  const double from_s = start_s + *settings.fails_at * (end_s - start_s);
  const auto add = [&](const std::string& words, const std::string& sensor, SensorFailure kind,
                       const std::string& elsewhere) {
    MachineRun run = judged.run;
    run.readings = with_failed_sensor(std::move(run.readings), sensor, kind, from_s, elsewhere);
    for (const std::string& failed : {sensor, kind == SensorFailure::kSwapped ? elsewhere : sensor}) {
      if (failed != settings.strategies.ambient) continue;
      run.ambient = failed_ambient(judged.run.ambient, kind, from_s, run.readings, failed);
      break;
    }
    list.emplace_back(words, std::move(run));
  };
  const std::vector<std::string>& sensors = strategy.sensors;
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    for (const Failure& failure : kFailures) {
      if (failure.kind == SensorFailure::kDetached && (settings.elsewhere.empty() || settings.elsewhere == sensors[s]))
        continue;
      add(fmt::format("{} {}", sensors[s], failure.word), sensors[s], failure.kind, settings.elsewhere);
    }
    if (const std::string other = least_alike(judged.run, sensors[s], settings.strategies.candidates); !other.empty())
      add(fmt::format("{} and {} exchanged", sensors[s], other), sensors[s], SensorFailure::kSwapped, other);
  }
  return list;
}

}  // namespace driftwright::compensation
