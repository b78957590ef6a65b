#include "scenarios/recorded_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/errors.hpp"
#include "base/foreign_temperature.hpp"
#include "scenarios/as_recorded.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kJitter = 0.01;      // of the top speed: no change of the drive
constexpr double kRoom_K = 293.15;    // the reference where there is no machine
constexpr double kManyMissing = 0.1;  // of a hall's readings

std::ptrdiff_t n_readings(const Channel& channel) {
  return std::count_if(channel.values.begin(), channel.values.end(), [](double v) { return !std::isnan(v); });
}

/// A channel of the drive, if it is there. @throws InputError  for another unit than it has to have, and for a value below 0
const Channel* drive_channel(const Record& record, const std::string& name, const std::string& unit) {
  const Channel* channel = record.find(name);
  if (!channel) return nullptr;
  if (channel->unit != unit)
    throw InputError(fmt::format("{}: channel {} is in {}; {} is wanted", record.source, name, channel->unit, unit));
  for (std::size_t i = 0; i < channel->values.size(); ++i) {
    if (channel->values[i] < 0.0) {
      throw InputError(fmt::format("{}: {} {:g} {} at {:g} s; {} are positive, whatever the direction", record.source, name,
                                   channel->values[i], unit, record.time_s[i], unit == "W" ? "powers" : "speeds"));
    }
  }
  return channel;
}

/// Sections of constant drive, each row's from its time on; what is missing is held.
/// @throws InputError  where the record does not say one
Cyclogram drive_of(const Record& record, const std::vector<double>& time_s) {
  const std::string& path = record.source;
  const Channel* speed = drive_channel(record, "speed", "rpm");
  if (!speed) {
    std::vector<std::string> names;
    for (const Channel& c : record.channels) names.push_back(c.header());
    throw InputError(fmt::format("{}: no channel speed_rpm, which says what drove the machine. Channels: {}", path,
                                 fmt::join(names, ", ")));
  }
  if (n_readings(*speed) == 0) throw InputError(fmt::format("{}: channel speed_rpm is empty", path));
  const Channel* feeds[] = {drive_channel(record, "feed_x", "mm_min"), drive_channel(record, "feed_y", "mm_min"),
                            drive_channel(record, "feed_z", "mm_min")};
  const Channel* cutting = drive_channel(record, "cutting_power", "W");
  Cyclogram cyclogram;
  double top_rpm = 0.0;
  for (double rpm : speed->values) top_rpm = std::isnan(rpm) ? top_rpm : std::max(top_rpm, rpm);
  // before its first reading as at it
  double last_rpm = *std::find_if(speed->values.begin(), speed->values.end(), [](double rpm) { return !std::isnan(rpm); });
  Drive drive;
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) {
    if (!std::isnan(speed->values[i])) last_rpm = speed->values[i];
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

/// The recorded hall, held where a reading is missing, over the reference.
/// @throws InputError  for a unit that is none of a hall, in the header or by the numbers
TimeSeries hall_of(const Record& record, const Channel& ambient, const std::vector<double>& time_s, double reference_C,
                   const TimeSeries* expected) {
  if (ambient.unit != "degC") {
    throw InputError(fmt::format("{}: channel {} is in {}; degC is wanted", record.source, ambient.name, ambient.unit));
  }
  const double first_C =
      *std::find_if(ambient.values.begin(), ambient.values.end(), [](double v) { return !std::isnan(v); });
  if (expected && !expected->value.empty()) {  // the hall drives the machine: in the wrong unit it spoils every channel
    const auto [low, high] = std::minmax_element(expected->value.begin(), expected->value.end());
    if (const auto unit = foreign_temperature(ambient.values, reference_C + *low, reference_C + *high)) {
      throw InputError(fmt::format(
          "{}: {} looks like {}: it begins with {:g}, and the scenario's hall is {:g} to {:g} degC; write it in degC",
          record.source, ambient.header(), *unit, first_C, reference_C + *low, reference_C + *high));
    }
  }
  TimeSeries hall{.time_s = time_s, .value = {}};
  double last_C = first_C;
  for (double v : ambient.values) {
    if (!std::isnan(v)) last_C = v;
    hall.value.push_back(last_C - reference_C);
  }
  return hall;
}

/// As it may become the name of a cyclogram.
std::string name_of(const std::string& source) {
  std::string name = std::filesystem::path(source).stem().string();
  for (char& c : name) {
    if (!is_name(std::string(1, c))) c = '_';
  }
  return name;
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
  run.cyclogram.name = name_of(record.source);
  if (machine) run.hall = machine->hall;
  std::vector<std::string> names = {kAmbient};
  names.insert(names.end(), on_hall.begin(), on_hall.end());
  for (const std::string& name : names) {
    const Channel* channel = record.find(name);
    if (!channel || n_readings(*channel) == 0) continue;
    attempt(name, [&] {
      run.hall = hall_of(record, *channel, run.time_s, (machine ? machine->reference_K : kRoom_K) - kZeroCelsius_K,
                         machine ? &machine->hall : nullptr);
      run.hall_channel = name;
    });
    const double missing = 1.0 - static_cast<double>(n_readings(*channel)) / static_cast<double>(record.n_samples());
    if (run.has_ambient() && missing > kManyMissing)
      run.findings.push_back(
          {name, fmt::format("{} has no reading in {:.0f} % of the rows; its last one is held", name, 100.0 * missing),
           false});
    break;
  }
  if (!run.has_ambient()) {
    run.findings.push_back(
        {kAmbient,
         fmt::format("the record has no hall temperature (ambient_degC){}", machine ? "; the scenario's is taken" : ""),
         false});
  }
  return run;
}

}  // namespace driftwright::scenarios
