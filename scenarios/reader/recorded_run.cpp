#include "scenarios/reader/recorded_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/errors.hpp"
#include "base/foreign_temperature.hpp"
#include "base/usual_ranges.hpp"
#include "base/usual_step.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::scenarios {
namespace {

constexpr std::size_t kStays = 3;     // rows with exactly the same value; a jittering tachometer never shows that many
constexpr double kRoom_K = 293.15;    // reference temperature without a machine
constexpr double kManyMissing = 0.1;  // share of missing readings of speed or ambient that is reported

std::ptrdiff_t n_readings(const Channel& channel) {
  return std::count_if(channel.values.begin(), channel.values.end(), [](double v) { return !std::isnan(v); });
}

/// A channel of the drive and its allowed values.
struct DriveKind {
  const char* name;
  const char* unit;
  double most;         ///< in `unit`
  bool may_be_signed;  ///< the sign is ignored
};
constexpr DriveKind kSpeed{"speed", "rpm", 1e6, false}, kCutting{"cutting_power", "W", 1e9, false},
    kFeeds[] = {{"feed_x", "mm_min", 6e6, true}, {"feed_y", "mm_min", 6e6, true}, {"feed_z", "mm_min", 6e6, true}};

/// A channel of the drive, if there is one. The last row of a plan is only its end; its values are not checked.
/// @throws InputError  for another unit than required, and for an impossible value
const Channel* drive_channel(const Record& record, const DriveKind& kind, bool is_plan) {
  const Channel* channel = record.find(kind.name);
  if (!channel) return nullptr;
  if (channel->unit != kind.unit)
    throw InputError(
        fmt::format("{}: channel {} is in {}; it must be in {}", record.source, kind.name, channel->unit, kind.unit));
  for (std::size_t i = 0; i + (is_plan ? 1 : 0) < channel->values.size(); ++i) {
    const double v = channel->values[i];
    const auto refuse = [&](const std::string& why) {
      throw InputError(
          fmt::format("{}: {} {:g} {} at {:g} s; {}", record.source, kind.name, v, kind.unit, record.time_s[i], why));
    };
    if (is_plan && std::isnan(v))
      throw InputError(
          fmt::format("{}: {} is missing at {:g} s; a plan says what is driven in every row. `measured: true` beside `csv` "
                      "holds the value before",
                      record.source, channel->header(), record.time_s[i]));
    if (v < 0.0 && !kind.may_be_signed)
      refuse(fmt::format("{} must be positive, whatever the direction", channel->unit == "W" ? "powers" : "speeds"));
    if (std::abs(v) > kind.most) refuse(fmt::format("{:g} {} at most is allowed", kind.most, kind.unit));
  }
  return channel;
}

/// Whether a channel has the same value in a row and those after it; then it was commanded, however small the change.
bool stays(const Channel& channel, std::size_t row) {
  if (row + kStays > channel.values.size()) return false;
  const auto first = channel.values.begin() + static_cast<std::ptrdiff_t>(row);
  return std::all_of(first, first + kStays, [&](double v) { return v == *first; });
}

/// Sections of constant drive: each row's value holds from its time on, and gaps are held.
/// @throws InputError  if the record contains no drive
Cyclogram drive_of(const Record& record, const std::vector<double>& time_s, bool is_plan) {
  const std::string& path = record.source;
  if (is_plan && record.time_s.front() != 0.0)
    throw InputError(fmt::format(
        "{}: a cyclogram starts at time 0, this one at {:g} s; `measured: true` beside `csv` takes it from its first row on",
        path, record.time_s.front()));
  const Channel* speed = drive_channel(record, kSpeed, is_plan);
  if (!speed) {
    std::vector<std::string> names;
    for (const Channel& c : record.channels) names.push_back(c.header());
    throw InputError(fmt::format("{}: no channel speed_rpm, which says what drove the machine. Channels: {}", path,
                                 fmt::join(names, ", ")));
  }
  if (n_readings(*speed) == 0) throw InputError(fmt::format("{}: channel speed_rpm is empty", path));
  const Channel* feeds[] = {drive_channel(record, kFeeds[0], is_plan), drive_channel(record, kFeeds[1], is_plan),
                            drive_channel(record, kFeeds[2], is_plan)};
  const Channel* cutting = drive_channel(record, kCutting, is_plan);
  Cyclogram cyclogram;
  double top_rpm = 0.0;
  for (double rpm : speed->values) top_rpm = std::isnan(rpm) ? top_rpm : std::max(top_rpm, rpm);
  // Before its first reading the speed has the value of that reading.
  double last_rpm = *std::find_if(speed->values.begin(), speed->values.end(), [](double rpm) { return !std::isnan(rpm); });
  Drive drive;
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) {
    if (!std::isnan(speed->values[i])) last_rpm = speed->values[i];
    const double held_rpm = cyclogram.sections.empty() ? last_rpm : cyclogram.sections.back().drive.speed_rpm;
    const bool is_jitter = !is_plan && held_rpm > 0.0 && last_rpm > 0.0 &&
                           std::abs(last_rpm - held_rpm) <= kJitter * top_rpm && !stays(*speed, i);
    drive.speed_rpm = is_jitter ? held_rpm : last_rpm;
    for (std::size_t a = 0; a < 3; ++a) {
      if (feeds[a] && !std::isnan(feeds[a]->values[i])) drive.feed_m_s[a] = std::abs(feeds[a]->values[i]) / 60e3;
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

/// The recorded channels besides drive, ambient and readings.
std::vector<Cyclogram::Column> columns_of(const Record& record, const std::vector<double>& time_s,
                                          const MachineModel* machine, const std::vector<std::string>& on_ambient) {
  std::vector<std::string> known = {kSpeed.name, kCutting.name, kAmbient};
  for (const DriveKind& feed : kFeeds) known.emplace_back(feed.name);
  known.insert(known.end(), on_ambient.begin(), on_ambient.end());
  if (machine) {
    for (const Sensor& s : machine->sensors) known.push_back(s.name);
    for (const DisplacementOutput& d : machine->displacements) known.push_back(d.name);
    for (const TiltOutput& t : machine->tilts) known.push_back(t.name);
  }
  std::vector<Cyclogram::Column> columns;
  for (const Channel& c : record.channels) {
    const bool is_known = std::find(known.begin(), known.end(), c.name) != known.end();
    if (is_known || !is_of_column(c.name, c.unit) || n_readings(c) == 0) continue;
    columns.push_back({c.name, c.unit, {.time_s = time_s, .value = {}}});
    double last = *std::find_if(c.values.begin(), c.values.end(), [](double v) { return !std::isnan(v); });
    for (double v : c.values) {
      if (!std::isnan(v)) last = v;
      columns.back().rows.value.push_back(last);
    }
  }
  return columns;
}

/// The recorded ambient over the reference, with gaps held.
/// @throws InputError  for a unit that is no temperature, in the header or by the size of the numbers
TimeSeries ambient_of(const Record& record, const Channel& channel, const std::vector<double>& time_s, double reference_C,
                      const TimeSeries* expected) {
  if (channel.unit != "degC") {
    throw InputError(fmt::format("{}: channel {} is in {}; it must be in degC", record.source, channel.name, channel.unit));
  }
  const double first_C =
      *std::find_if(channel.values.begin(), channel.values.end(), [](double v) { return !std::isnan(v); });
  if (expected && !expected->value.empty()) {  // the ambient drives the machine: a wrong unit would spoil every channel
    const auto [low, high] = std::minmax_element(expected->value.begin(), expected->value.end());
    if (const auto unit = foreign_temperature(channel.values, reference_C + *low, reference_C + *high)) {
      throw InputError(fmt::format(
          "{}: {} looks like {}: it begins with {:g}, and the scenario's ambient is {:g} to {:g} degC; write it in degC",
          record.source, channel.header(), *unit, first_C, reference_C + *low, reference_C + *high));
    }
  }
  TimeSeries ambient{.time_s = time_s, .value = {}};
  double last_C = first_C;
  for (double v : channel.values) {
    if (!std::isnan(v)) last_C = v;
    ambient.value.push_back(last_C - reference_C);
  }
  return ambient;
}

/// Notes rows that are too far apart to know the drive between them.
void note_coarse_rows(MachineRun& run) {
  if (const auto what = beyond_usual(Usual::kRowInterval, usual_step_s(run.readings.time_s)))
    run.findings.push_back(
        {"speed",
         fmt::format(
             "the time from row to row is {}: the speed is held over it, and what the spindle did meanwhile is not known",
             *what),
         false});
}

/// The source's name in a form that a cyclogram may have.
std::string name_of(const std::string& source) {
  std::string name = std::filesystem::path(source).stem().string();
  for (char& c : name) {
    if (!is_name(std::string(1, c))) c = '_';
  }
  return name;
}

}  // namespace

bool is_of_column(const std::string& name, const std::string& unit) {
  if (unit == "mm" && (name.starts_with("position_") || name.starts_with("stroke_"))) return true;
  if (unit == "deg" && name.starts_with("position_")) return true;
  constexpr const char* kOther[] = {"um", "mm", "urad", "deg", "s", "min", "h"};
  return std::find(std::begin(kOther), std::end(kOther), unit) == std::end(kOther);
}

MachineRun run_of(Record record, const MachineModel* machine, const std::vector<std::string>& on_ambient, Reading reading) {
  MachineRun run;
  std::vector<double>& time_s = run.readings.time_s;
  for (double t_s : record.time_s) time_s.push_back(t_s - record.time_s.front());
  const auto attempt = [&](const std::string& channel, const auto& read) {
    try {
      read();
    } catch (const InputError& e) {
      if (reading != Reading::kLenient) throw;
      run.findings.push_back({channel, e.what(), true});
    }
  };
  const auto note_gaps = [&](const Channel& channel) {
    const double missing = 1.0 - static_cast<double>(n_readings(channel)) / static_cast<double>(record.n_samples());
    if (missing > kManyMissing)
      run.findings.push_back(
          {channel.name,
           fmt::format("{} has no reading in {:.0f} % of the rows; its last one is held", channel.name, 100.0 * missing),
           false});
  };
  attempt("speed", [&] { run.cyclogram = drive_of(record, time_s, reading == Reading::kPlan); });
  if (!run.cyclogram.sections.empty()) {
    note_gaps(record.at("speed"));
    if (reading != Reading::kPlan) note_coarse_rows(run);
  }
  run.cyclogram.name = name_of(record.source);
  run.cyclogram.columns = columns_of(record, time_s, machine, on_ambient);
  if (machine) run.ambient = machine->ambient;
  std::vector<std::string> names = {kAmbient};
  names.insert(names.end(), on_ambient.begin(), on_ambient.end());
  for (const std::string& name : names) {
    const Channel* channel = record.find(name);
    if (!channel || n_readings(*channel) == 0) continue;
    attempt(name, [&] {
      run.ambient = ambient_of(record, *channel, time_s, (machine ? machine->reference_K : kRoom_K) - kZeroCelsius_K,
                               machine ? &machine->ambient : nullptr);
      run.ambient_channel = name;
    });
    if (run.has_recorded_ambient()) note_gaps(*channel);
    break;
  }
  if (!run.has_recorded_ambient()) {
    run.findings.push_back(
        {kAmbient,
         fmt::format("the record has no ambient temperature (ambient_degC){}", machine ? "; the scenario's is taken" : ""),
         false});
  }
  run.readings.source = std::move(record.source);
  run.readings.channels = std::move(record.channels);
  return run;
}

}  // namespace driftwright::scenarios
