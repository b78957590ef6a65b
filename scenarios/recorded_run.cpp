#include "scenarios/recorded_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors.hpp"
#include "base/foreign_temperature.hpp"
#include "scenarios/as_recorded.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kHallKnots_s = 600.0;  // films pass on nothing faster
constexpr double kJitter = 0.01;        // of the top speed: no change of the drive
constexpr double kRoom_K = 293.15;      // the reference where there is no machine

/// Piecewise linear least squares on knots; keeps a recorded hall's slow course and drops its noise. One reading at least.
TimeSeries smoothed(const std::vector<double>& time_s, const std::vector<double>& value) {
  std::vector<double> t, v;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!std::isnan(value[i])) {
      t.push_back(time_s[i]);
      v.push_back(value[i]);
    }
  }
  const double length_s = t.back() - t.front();
  const int n_pieces = std::max(1, std::min(static_cast<int>(length_s / kHallKnots_s), static_cast<int>(t.size()) / 3));
  const double width_s = length_s / n_pieces;
  Eigen::MatrixXd hats = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(t.size()) + n_pieces - 1, n_pieces + 1);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(hats.rows());
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double x = width_s > 0.0 ? (t[i] - t.front()) / width_s : 0.0;
    const int k = std::clamp(static_cast<int>(x), 0, n_pieces - 1);
    hats(static_cast<Eigen::Index>(i), k) = 1.0 - (x - k);
    hats(static_cast<Eigen::Index>(i), k + 1) = x - k;
    rhs[static_cast<Eigen::Index>(i)] = v[i];
  }
  for (int k = 1; k < n_pieces; ++k) {  // a light hand on curvature bridges gaps
    const auto row = static_cast<Eigen::Index>(t.size()) + k - 1;
    hats(row, k - 1) = hats(row, k + 1) = 0.05;
    hats(row, k) = -0.1;
  }
  const Eigen::VectorXd knots = hats.colPivHouseholderQr().solve(rhs);
  TimeSeries series;
  for (int k = 0; k <= n_pieces; ++k) {
    series.time_s.push_back(t.front() + k * width_s);
    series.value.push_back(knots[k]);
  }
  if (series.time_s.size() > 1 && !(series.time_s[1] > series.time_s[0])) return {{t.front()}, {knots[0]}};
  return series;
}

std::ptrdiff_t n_readings(const Channel& channel) {
  return std::count_if(channel.values.begin(), channel.values.end(), [](double v) { return !std::isnan(v); });
}

/// Sections of constant drive, each row's from its time on.
/// @throws InputError  where the record does not say one
Cyclogram drive_of(const Record& record, const std::vector<double>& time_s) {
  const std::string& path = record.source;
  const Channel* speed = record.find("speed");
  if (!speed) {
    std::vector<std::string> names;
    for (const Channel& c : record.channels) names.push_back(c.header());
    throw InputError(fmt::format("{}: no channel speed_rpm, which says what drove the machine. Channels: {}", path,
                                 fmt::join(names, ", ")));
  }
  if (speed->unit != "rpm") throw InputError(fmt::format("{}: channel speed is in {}; rpm is wanted", path, speed->unit));
  if (n_readings(*speed) == 0) throw InputError(fmt::format("{}: channel speed_rpm is empty", path));
  const Channel* feeds[] = {record.find("feed_x"), record.find("feed_y"), record.find("feed_z")};
  const Channel* cutting = record.find("cutting_power");
  Cyclogram cyclogram;
  double top_rpm = 0.0;
  for (double rpm : speed->values) top_rpm = std::isnan(rpm) ? top_rpm : std::max(top_rpm, rpm);
  // before its first reading as at it
  double last_rpm = *std::find_if(speed->values.begin(), speed->values.end(), [](double rpm) { return !std::isnan(rpm); });
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) {
    Drive drive;
    if (!std::isnan(speed->values[i])) last_rpm = speed->values[i];
    if (!(last_rpm >= 0.0)) {
      throw InputError(fmt::format("{}: speed {:g} rpm at {:g} s; speeds are positive, whatever the direction", path,
                                   last_rpm, time_s[i]));
    }
    const double held_rpm = cyclogram.sections.empty() ? last_rpm : cyclogram.sections.back().drive.speed_rpm;
    const bool is_jitter = held_rpm > 0.0 && last_rpm > 0.0 && std::abs(last_rpm - held_rpm) <= kJitter * top_rpm;
    drive.speed_rpm = is_jitter ? held_rpm : last_rpm;
    for (std::size_t a = 0; a < 3; ++a) {
      if (feeds[a] && !std::isnan(feeds[a]->values[i])) drive.feed_m_s[a] = feeds[a]->values[i] / 60e3;
    }
    if (cutting && !std::isnan(cutting->values[i])) drive.cutting_power_W = cutting->values[i];
    const double length_s = time_s[i + 1] - time_s[i];
    if (!cyclogram.sections.empty() && cyclogram.sections.back().drive == drive) {
      cyclogram.sections.back().duration_s += length_s;
    } else {
      cyclogram.sections.push_back({length_s, drive});
    }
  }
  return cyclogram;
}

/// The recorded hall; nothing where the channel is empty.
/// @throws InputError  for a unit that is none of a hall, in the header or by the numbers
std::optional<TimeSeries> hall_of(const Record& record, const Channel& ambient, const std::vector<double>& time_s,
                                  double reference_C, const TimeSeries* expected) {
  if (ambient.unit != "degC") {
    throw InputError(fmt::format("{}: channel {} is in {}; degC is wanted", record.source, ambient.name, ambient.unit));
  }
  if (n_readings(ambient) == 0) return std::nullopt;
  if (expected && !expected->value.empty()) {  // the hall drives the machine: in the wrong unit it spoils every channel
    const auto [low, high] = std::minmax_element(expected->value.begin(), expected->value.end());
    if (const auto unit = foreign_temperature(ambient.values, reference_C + *low, reference_C + *high)) {
      const auto first =
          std::find_if(ambient.values.begin(), ambient.values.end(), [](double v) { return !std::isnan(v); });
      throw InputError(fmt::format(
          "{}: {} looks like {}: it begins with {:g}, and the scenario's hall is {:g} to {:g} degC; write it in degC",
          record.source, ambient.header(), *unit, *first, reference_C + *low, reference_C + *high));
    }
  }
  std::vector<double> hall_K;
  for (double v : ambient.values) hall_K.push_back(v - reference_C);
  return smoothed(time_s, hall_K);
}

}  // namespace

RecordedRun run_of(const Record& record, const MachineModel* machine, const std::vector<std::string>& on_hall,
                   Reading reading) {
  RecordedRun run;
  for (double t_s : record.time_s) run.time_s.push_back(t_s - record.time_s.front());
  const auto attempt = [&](const std::string& channel, const auto& read) {
    try {
      read();
    } catch (const InputError& e) {
      if (reading == Reading::kStrict) throw;
      run.findings.push_back({channel, e.what(), true});
    }
  };
  attempt("speed", [&] { run.cyclogram = drive_of(record, run.time_s); });
  const Channel* ambient = record.find(kAmbient);
  for (std::size_t i = 0; !ambient && i < on_hall.size(); ++i) ambient = record.find(on_hall[i]);
  if (machine) run.hall = machine->hall;
  if (ambient) {
    attempt(ambient->name, [&] {
      auto recorded = hall_of(record, *ambient, run.time_s, (machine ? machine->reference_K : kRoom_K) - kZeroCelsius_K,
                              machine ? &machine->hall : nullptr);
      if (!recorded) return;
      run.hall = *std::move(recorded);
      run.has_ambient = true;
    });
  }
  if (!run.has_ambient) {
    run.findings.push_back({kAmbient,
                            fmt::format("the record has no hall temperature (ambient_degC){}",
                                        machine ? "; the scenario's is taken" : ""),
                            false});
  }
  return run;
}

}  // namespace driftwright::scenarios
