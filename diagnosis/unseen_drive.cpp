#include "diagnosis/unseen_drive.hpp"

#include <algorithm>

#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kHalvings = 4;
constexpr double kOpen = 0.5;  // of what the drive can do: one standard deviation

/// Of all that a run shows, each quantity of the drive at its most.
Drive most_of(const Cyclogram& cyclogram) {
  Drive most;
  for (const Cyclogram::Section& s : cyclogram.sections) {
    most.speed_rpm = std::max(most.speed_rpm, s.drive.speed_rpm);
    most.cutting_power_W = std::max(most.cutting_power_W, s.drive.cutting_power_W);
    for (std::size_t a = 0; a < 3; ++a) most.feed_m_s[a] = std::max(most.feed_m_s[a], s.drive.feed_m_s[a]);
  }
  return most;
}

Cyclogram driven_otherwise(const Cyclogram& cyclogram, const Hole& part, bool is_most) {
  const Drive drive = is_most ? most_of(cyclogram) : Drive{};
  Cyclogram other = split_at(cyclogram, {part.begin_s, part.end_s});
  double at_s = 0.0;
  for (Cyclogram::Section& s : other.sections) {
    const double middle_s = at_s + 0.5 * s.duration_s;
    if (middle_s > part.begin_s && middle_s < part.end_s) s.drive = drive;
    at_s += s.duration_s;
  }
  for (Cyclogram::Column& c : other.columns) {
    const auto [least, most] = std::minmax_element(c.rows.value.begin(), c.rows.value.end());
    const double there = is_most ? *most : *least, after = c.at(part.end_s);
    TimeSeries rows;
    const auto add = [&](double time_s, double value) {
      rows.time_s.push_back(time_s);
      rows.value.push_back(value);
    };
    for (std::size_t i = 0; i < c.rows.time_s.size() && c.rows.time_s[i] < part.begin_s; ++i)
      add(c.rows.time_s[i], c.rows.value[i]);
    add(part.begin_s, there);
    add(part.end_s, after);
    for (std::size_t i = 0; i < c.rows.time_s.size(); ++i) {
      if (c.rows.time_s[i] > part.end_s) add(c.rows.time_s[i], c.rows.value[i]);
    }
    c.rows = std::move(rows);
  }
  return other;
}

}  // namespace

std::vector<Prediction> hole_columns(const Twin& twin, const std::vector<MeasuredRun>& runs) {
  std::vector<Prediction> columns;
  Twin::Workspace workspace(twin);
  const auto readings = [&](const MeasuredRun& run, const Hole& part, bool is_most) {
    MeasuredRun other = run;
    other.cyclogram = driven_otherwise(run.cyclogram, part, is_most);
    return twin.read(twin.as_written(), other, twin.respond(twin.as_written(), other, workspace));
  };
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const Hole& hole : runs[r].holes) {
      Hole part = hole;
      for (int halving = 0; halving <= kHalvings; ++halving) {
        part.end_s = halving < kHalvings ? 0.5 * (part.begin_s + hole.end_s) : hole.end_s;
        Prediction column;
        for (const MeasuredRun& run : runs)
          column.push_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(twin.outputs().name.size()),
                                                 static_cast<Eigen::Index>(run.time_s.size())));
        const bool is_solved =
            has_solution([&] { column[r] = kOpen * (readings(runs[r], part, true) - readings(runs[r], part, false)); });
        if (is_solved && !column[r].isZero(0.0)) columns.push_back(std::move(column));
        part.begin_s = part.end_s;
      }
    }
  }
  return columns;
}

}  // namespace driftwright::diagnosis
