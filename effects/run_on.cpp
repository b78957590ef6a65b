#include "effects/run_on.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace driftwright::effects {
namespace {

constexpr double kSlowing_s = 60.0;  // a spindle takes seconds to stop, which may appear as one or more rows of a record

std::string signal_name(double run_on_s) {
  return fmt::format("turns, or has stopped from within {} s", run_on_s);
}

}  // namespace

std::function<bool(const Drive&)> turns_or_has(double run_on_s) {
  if (!(run_on_s > 0.0)) return [](const Drive& drive) { return drive.speed_rpm > 0.0; };
  return [name = signal_name(run_on_s)](const Drive& drive) {
    return drive.speed_rpm > 0.0 || std::any_of(drive.signals.begin(), drive.signals.end(),
                                                [&](const Signal& s) { return s.name == name && s.value > 0.0; });
  };
}

std::function<double(const Drive&)> stopped_from_rpm(double run_on_s) {
  return [name = signal_name(run_on_s)](const Drive& drive) {
    if (drive.speed_rpm > 0.0) return 0.0;
    const auto signal =
        std::find_if(drive.signals.begin(), drive.signals.end(), [&](const Signal& s) { return s.name == name; });
    return signal == drive.signals.end() ? 0.0 : signal->value;
  };
}

Cyclogram with_run_on(Cyclogram recorded, double run_on_s) {
  if (!(run_on_s > 0.0)) return recorded;
  const std::string name = signal_name(run_on_s);
  for (Cyclogram::Section& section : recorded.sections)  // of a drive that was made of others
    std::erase_if(section.drive.signals, [&](const Signal& s) { return s.name == name; });
  std::vector<double> over_s;
  double end_s = 0.0;
  for (std::size_t i = 0; i < recorded.sections.size(); ++i) {
    end_s += recorded.sections[i].duration_s;
    const bool stops = recorded.sections[i].drive.speed_rpm > 0.0 && i + 1 < recorded.sections.size() &&
                       !(recorded.sections[i + 1].drive.speed_rpm > 0.0);
    if (stops) over_s.push_back(end_s + run_on_s);
  }
  Cyclogram felt = split_at(recorded, over_s);
  double start_s = 0.0, turned_s = -std::numeric_limits<double>::infinity(), from_rpm = 0.0;
  std::vector<std::pair<double, double>> slows;  // ends of the sections of the last minute, and their speeds
  for (Cyclogram::Section& section : felt.sections) {
    const double middle_s = start_s + 0.5 * section.duration_s;
    std::erase_if(slows, [&](const auto& s) { return s.first < start_s - kSlowing_s; });
    start_s += section.duration_s;
    if (section.drive.speed_rpm > 0.0) {
      turned_s = start_s;
      from_rpm = section.drive.speed_rpm;
      for (const auto& [end, rpm] : slows) from_rpm = std::max(from_rpm, rpm);
      slows.emplace_back(start_s, section.drive.speed_rpm);
    }
    section.drive.signals.push_back({name, middle_s - turned_s < run_on_s ? from_rpm : 0.0});
  }
  return felt;
}

void add_run_on(double run_on_s, DriveChange& change) {
  if (!(run_on_s > 0.0)) return;
  change.run_on_s.push_back(run_on_s);
  change.drive.push_back([run_on_s](const Cyclogram& recorded) { return with_run_on(recorded, run_on_s); });
}

DoubtedNumber doubted_run_on(double usual_min) {
  return {.name = "runs_on", .unit = "min", .nominal = usual_min, .prior_sd = 1.0, .step = 0.1, .is_log = true};
}

}  // namespace driftwright::effects
