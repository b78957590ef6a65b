#include "effects/recorded_column.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace driftwright::effects {
namespace {

constexpr double kMmMin_per_m_s = 60e3;
constexpr double kPiece = 0.25, kSettled = 8.0;  // in lags
constexpr double kRounding = 1e-9;               // of a row's interval

struct DriveChannel {
  const char *name, *header;
  double (*value)(const Drive&);
};
constexpr DriveChannel kDriveChannels[] = {
    {"cutting_power", "cutting_power_W", [](const Drive& d) { return d.cutting_power_W; }},
    {"feed_x", "feed_x_mm_min", [](const Drive& d) { return kMmMin_per_m_s * d.feed_m_s[0]; }},
    {"feed_y", "feed_y_mm_min", [](const Drive& d) { return kMmMin_per_m_s * d.feed_m_s[1]; }},
    {"feed_z", "feed_z_mm_min", [](const Drive& d) { return kMmMin_per_m_s * d.feed_m_s[2]; }}};

const DriveChannel* drive_channel(const std::string& column) {
  for (const DriveChannel& c : kDriveChannels) {
    if (column == c.name || column == c.header) return &c;
  }
  return nullptr;
}

std::string signal_name(const std::string& column, double lag_s) {
  return lag_s > 0.0 ? fmt::format("{} with a lag of {} s", column, lag_s) : column;
}

/// The rows whose value differs from the previous one.
TimeSeries without_repeats(const TimeSeries& rows) {
  TimeSeries steps;
  for (std::size_t i = 0; i < rows.time_s.size(); ++i) {
    if (i > 0 && rows.value[i] == steps.value.back()) continue;
    steps.time_s.push_back(rows.time_s[i]);
    steps.value.push_back(rows.value[i]);
  }
  return steps;
}

/// Steps of y with lag y' = c - y for rows c that are held, y = c at the first: its mean over pieces of at most a quarter of
/// the lag, while it changes.
TimeSeries behind(const TimeSeries& rows, double lag_s, double end_s) {
  TimeSeries steps;
  double y = rows.value.front();
  for (std::size_t i = 0; i < rows.time_s.size(); ++i) {
    const double c = rows.value[i], begin_s = rows.time_s[i],
                 length_s = (i + 1 < rows.time_s.size() ? rows.time_s[i + 1] : std::max(end_s, begin_s)) - begin_s;
    for (double passed_s = 0.0; passed_s == 0.0 || passed_s < length_s * (1.0 - kRounding);) {
      const bool is_settled = y == c || passed_s >= kSettled * lag_s || length_s <= 0.0;
      const double piece_s = is_settled ? length_s - passed_s : std::min(kPiece * lag_s, length_s - passed_s);
      const double left = std::exp(-std::max(piece_s, 0.0) / lag_s);
      steps.time_s.push_back(begin_s + passed_s);
      steps.value.push_back(piece_s > 0.0 ? c + (y - c) * (1.0 - left) * lag_s / piece_s : y);
      y = c + (y - c) * left;
      if (!(piece_s > 0.0)) break;
      passed_s += piece_s;
    }
  }
  return without_repeats(steps);
}

}  // namespace

bool is_drive_channel(const std::string& column) {
  return drive_channel(column) != nullptr;
}

std::function<std::optional<double>(const Drive&)> signal_of(const std::string& column, double lag_s) {
  if (const DriveChannel* c = drive_channel(column)) return [value = c->value](const Drive& drive) { return value(drive); };
  return [name = signal_name(column, lag_s)](const Drive& drive) -> std::optional<double> {
    for (const Signal& s : drive.signals) {
      if (s.name == name) return s.value;
    }
    return std::nullopt;
  };
}

Cyclogram with_signal(const Cyclogram& recorded, const std::string& column, double lag_s) {
  const Cyclogram::Column* c = recorded.column(column);
  if (!c || recorded.sections.empty()) return recorded;
  const std::string name = signal_name(column, lag_s);
  const auto& signals = recorded.sections.front().drive.signals;
  if (std::any_of(signals.begin(), signals.end(), [&](const Signal& s) { return s.name == name; })) return recorded;

  const TimeSeries steps = lag_s > 0.0 ? behind(c->rows, lag_s, recorded.duration_s()) : without_repeats(c->rows);
  Cyclogram felt = split_at(recorded, steps.time_s);
  double start_s = 0.0;
  std::size_t step = 0;
  for (Cyclogram::Section& section : felt.sections) {
    const double middle_s = start_s + 0.5 * section.duration_s;
    while (step + 1 < steps.time_s.size() && steps.time_s[step + 1] <= middle_s) ++step;
    section.drive.signals.push_back({name, steps.value[step]});
    start_s += section.duration_s;
  }
  return felt;
}

}  // namespace driftwright::effects
