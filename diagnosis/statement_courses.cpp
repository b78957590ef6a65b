#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/statement_builder.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kExponents[] = {0.5, 1.0, 1.5, 2.0, 3.0};
constexpr double kBurst_s = 600.0;

}  // namespace

double StatementBuilder::value_at(const TimeSeries& series, double t_s) {
  const auto next = std::upper_bound(series.time_s.begin(), series.time_s.end(), t_s + 1e-6);
  return next == series.time_s.begin() ? series.value.front()
                                       : series.value[static_cast<std::size_t>(next - series.time_s.begin() - 1)];
}

TimedCourse StatementBuilder::of_drive(std::string follows, std::string law,
                                       const std::function<double(const Drive&)>& u) const {
  TimedCourse c{.follows = std::move(follows), .law = std::move(law), .at_row = {}, .in_interval = {}, .rests = true};
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const auto& drive = machine_[r].drive();
    Row in(static_cast<Eigen::Index>(drive.size())), at(in.size() + 1);
    for (std::size_t k = 0; k < drive.size(); ++k) in[static_cast<Eigen::Index>(k)] = u(drive[k]);
    at << in, in[in.size() - 1];
    c.in_interval.push_back(in);
    c.at_row.push_back(at);
  }
  return c;
}

void StatementBuilder::make_courses() {
  TimedCourse c = of_drive("constant", "constant", [](const Drive&) { return 1.0; });
  c.rests = false;
  courses_.push_back(c);
  const double top = std::max(1.0, scene_.top_rpm);
  if (scene_.turns) {
    if (scene_.starts_and_stops)
      courses_.push_back(of_drive("running", "running", [](const Drive& d) { return d.speed_rpm > 0.0 ? 1.0 : 0.0; }));
    for (double p : kExponents)
      courses_.push_back(of_drive("power of speed", fmt::format("speed^{:g}", p),
                                  [top, p](const Drive& d) { return std::pow(d.speed_rpm / top, p); }));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double feed = scene_.top_feed_m_s[axis];
    if (!(feed > 0.0)) continue;
    const char name = "xyz"[axis];
    for (double p : {1.0, 2.0})
      courses_.push_back(of_drive(fmt::format("power of feed_{}", name), fmt::format("feed_{}^{:g}", name, p),
                                  [axis, feed, p](const Drive& d) { return std::pow(d.feed_m_s[axis] / feed, p); }));
  }
  for (const auto& column : scene_.columns) {
    const std::string name = column.header.substr(0, column.header.rfind('_'));
    if (column.header == "cutting_power_W") {
      courses_.push_back(of_drive("power of cutting_power", "cutting_power^1",
                                  [&](const Drive& d) { return d.cutting_power_W / column.top; }));
      continue;
    }
    TimedCourse of{.follows = "power of " + name, .law = name + "^1", .at_row = {}, .in_interval = {}, .rests = false};
    for (const MeasuredRun& run : runs_) {
      const Cyclogram::Column* rows = run.cyclogram.column(column.header);
      const auto n = static_cast<Eigen::Index>(run.time_s.size());
      Row at = Row::Zero(n), in = Row::Zero(n - 1);
      for (Eigen::Index i = 0; rows && i < n; ++i) at[i] = value_at(rows->rows, run.time_s[static_cast<std::size_t>(i)]);
      at = (at.array() - (column.is_temperature() ? at[0] : 0.0)) / column.span;
      in = at.head(n - 1);
      of.at_row.push_back(at);
      of.in_interval.push_back(in);
    }
    courses_.push_back(of);
  }
  n_drives_ = courses_.size();
  if (scene_.starts_and_stops) {
    for (const bool on : {true, false}) {
      TimedCourse of{.follows = on ? "since start" : "since stop",
                     .law = fmt::format("{} s after it", kBurst_s),
                     .at_row = {},
                     .in_interval = {},
                     .rests = true};
      for (std::size_t r = 0; r < runs_.size(); ++r) {
        const auto& drive = machine_[r].drive();
        const auto& time_s = machine_[r].time_s();
        Row in = Row::Zero(static_cast<Eigen::Index>(drive.size()));
        double since = -1.0;
        bool was = on ? false : drive.front().speed_rpm > 0.0;
        for (std::size_t k = 0; k < drive.size(); ++k) {
          const bool turns = drive[k].speed_rpm > 0.0;
          if (turns != was) since = turns == on ? time_s[k] : -1.0;
          was = turns;
          if (since >= 0.0) in[static_cast<Eigen::Index>(k)] = std::exp(-(time_s[k] - since) / kBurst_s);
        }
        Row at(in.size() + 1);
        at << in, in[in.size() - 1];
        of.in_interval.push_back(in);
        of.at_row.push_back(at);
      }
      courses_.push_back(of);
    }
  }
  TimedCourse ramp{.follows = "ramp", .law = "growing with time", .at_row = {}, .in_interval = {}, .rests = true};
  double longest = 0.0;
  for (const MeasuredRun& run : runs_) longest = std::max(longest, run.time_s.back());
  for (const MeasuredRun& run : runs_) {
    Row at = Eigen::Map<const Row>(run.time_s.data(), static_cast<Eigen::Index>(run.time_s.size())) / longest;
    ramp.in_interval.push_back(at.head(at.size() - 1));
    ramp.at_row.push_back(at);
  }
  courses_.push_back(ramp);
}

}  // namespace driftwright::diagnosis
