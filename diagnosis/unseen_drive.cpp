#include "diagnosis/unseen_drive.hpp"

#include <algorithm>
#include <cmath>

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

/// A column that has another value in a part of a run.
void set_column(Cyclogram::Column& c, const Hole& part, double value) {
  TimeSeries rows;
  const auto add = [&](double time_s, double v) {
    rows.time_s.push_back(time_s);
    rows.value.push_back(v);
  };
  const auto copy = [&](const auto& where) {
    for (std::size_t i = 0; i < c.rows.time_s.size(); ++i) {
      if (where(c.rows.time_s[i])) add(c.rows.time_s[i], c.rows.value[i]);
    }
  };
  copy([&](double t_s) { return t_s < part.begin_s; });
  add(part.begin_s, value);
  add(part.end_s, c.at(part.end_s));
  copy([&](double t_s) { return t_s > part.end_s; });
  c.rows = std::move(rows);
}

/// The cyclogram with what nobody saw in a part of a hole at its most, or at its least.
Cyclogram driven_otherwise(const MeasuredRun& run, const Hole& part, bool is_most) {
  const Cyclogram& cyclogram = run.cyclogram;
  // where rows go on without a speed, they say all else
  const bool speed_alone =
      std::any_of(run.time_s.begin(), run.time_s.end(), [&](double t_s) { return t_s > part.begin_s && t_s < part.end_s; });
  const Drive drive = is_most ? most_of(cyclogram) : Drive{};
  Cyclogram other = split_at(cyclogram, {part.begin_s, part.end_s});
  double at_s = 0.0;
  for (Cyclogram::Section& s : other.sections) {
    const double middle_s = at_s + 0.5 * s.duration_s;
    at_s += s.duration_s;
    if (!(middle_s > part.begin_s && middle_s < part.end_s)) continue;
    if (speed_alone)
      s.drive.speed_rpm = drive.speed_rpm;
    else
      s.drive = drive;
  }
  for (Cyclogram::Column& c : other.columns) {
    if (speed_alone) break;
    const auto [least, most] = std::minmax_element(c.rows.value.begin(), c.rows.value.end());
    set_column(c, part, is_most ? *most : *least);
  }
  return other;
}

}  // namespace

std::vector<Prediction> hole_columns(const Twin& twin, const std::vector<MeasuredRun>& runs) {
  std::vector<Prediction> columns;
  Twin::Workspace workspace(twin);
  const auto readings = [&](const MeasuredRun& run, const Hole& part, bool is_most) {
    MeasuredRun other = run;
    other.cyclogram = driven_otherwise(run, part, is_most);
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

void leave_out_what_is_open(const Twin& twin, const std::map<std::string, NoiseModel>& noise,
                            std::vector<MeasuredRun>& runs) {
  const std::vector<Prediction> columns = hole_columns(twin, runs);
  for (std::size_t r = 0; r < runs.size() && !columns.empty(); ++r) {
    for (MeasuredChannel& c : runs[r].channels) {
      for (Eigen::Index i = 0; i < c.value.size(); ++i) {
        double variance = 0.0;
        for (const Prediction& column : columns) variance += std::pow(column[r](c.output, i), 2);
        if (variance > std::pow(noise.at(c.name).total(), 2)) c.value[i] = std::nan("");
      }
    }
  }
}

}  // namespace driftwright::diagnosis
