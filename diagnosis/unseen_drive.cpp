#include "diagnosis/unseen_drive.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kHalvings = 4;
constexpr double kOpenDrive = 0.5;        // standard deviation, as a share of the drive's whole range
constexpr double kKnownAmbient_K = 0.01;  // a smaller deviation of the ambient is ignored

/// Each quantity of the drive at its maximum in the run.
Drive most_of(const Cyclogram& cyclogram) {
  Drive most;
  for (const Cyclogram::Section& s : cyclogram.sections) {
    most.speed_rpm = std::max(most.speed_rpm, s.drive.speed_rpm);
    most.cutting_power_W = std::max(most.cutting_power_W, s.drive.cutting_power_W);
    for (std::size_t a = 0; a < 3; ++a) most.feed_m_s[a] = std::max(most.feed_m_s[a], s.drive.feed_m_s[a]);
  }
  return most;
}

/// Sets a column to another value in a part of a run.
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

/// Whether a part of a hole has rows, in which only the speed is missing.
bool has_rows(const MeasuredRun& run, const Hole& part) {
  return std::any_of(run.time_s.begin(), run.time_s.end(),
                     [&](double t_s) { return t_s > part.begin_s && t_s < part.end_s; });
}

/// The cyclogram with the unknown quantities of a part of a hole at their maximum, or at their minimum.
Cyclogram driven_otherwise(const MeasuredRun& run, const Hole& part, bool is_most) {
  const Cyclogram& cyclogram = run.cyclogram;
  const bool speed_alone = has_rows(run, part);  // the rows contain all else
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

/// The uncertainty of the ambient in a hole [K]: root mean square deviation of the recorded one, in stretches as long as
/// the hole, from the line between their ends; if no stretch is as long, its standard deviation. Stretches that touch a
/// hole do not count.
double unseen_ambient_K(const MeasuredRun& run, const Hole& hole) {
  constexpr int kLooks = 16;  // points within a stretch
  const TimeSeries& ambient = run.ambient;
  const double length_s = hole.end_s - hole.begin_s, last_s = run.time_s.back();
  if (!(length_s > 0.0)) return 0.0;
  const auto touches_hole = [&](double from_s, double to_s) {
    return std::any_of(run.holes.begin(), run.holes.end(),
                       [&](const Hole& h) { return from_s < h.end_s && to_s > h.begin_s; });
  };
  double squares = 0.0, n = 0.0;
  for (double from_s = 0.0; from_s + length_s <= last_s; from_s += length_s / kLooks) {
    if (touches_hole(from_s, from_s + length_s)) continue;
    for (int i = 1; i < kLooks; ++i) {
      const double share = static_cast<double>(i) / kLooks;
      const double line_K = (1.0 - share) * ambient.at(from_s) + share * ambient.at(from_s + length_s);
      squares += std::pow(ambient.at(from_s + share * length_s) - line_K, 2);
      n += 1.0;
    }
  }
  if (n > 0.0) return std::sqrt(squares / n);
  double sum = 0.0;
  for (double t_s : run.time_s) {
    if (touches_hole(t_s, t_s)) continue;
    sum += ambient.at(t_s);
    squares += std::pow(ambient.at(t_s), 2);
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(std::max(0.0, squares / n - std::pow(sum / n, 2))) : 0.0;
}

/// The ambient, warmer by this amount in a part of a hole.
TimeSeries warmer_in(const TimeSeries& ambient, const Hole& part, double by_K) {
  const double edge_s = 0.01 * (part.end_s - part.begin_s);
  TimeSeries other;
  const auto add = [&](double t_s, double value) {
    other.time_s.push_back(t_s);
    other.value.push_back(value);
  };
  const auto copy = [&](double from_s, double to_s, double more_K) {
    for (std::size_t i = 0; i < ambient.time_s.size(); ++i) {
      if (ambient.time_s[i] > from_s && ambient.time_s[i] < to_s) add(ambient.time_s[i], ambient.value[i] + more_K);
    }
  };
  copy(-1e300, part.begin_s, 0.0);
  add(part.begin_s, ambient.at(part.begin_s));
  add(part.begin_s + edge_s, ambient.at(part.begin_s + edge_s) + by_K);
  copy(part.begin_s + edge_s, part.end_s - edge_s, by_K);
  add(part.end_s - edge_s, ambient.at(part.end_s - edge_s) + by_K);
  add(part.end_s, ambient.at(part.end_s));
  copy(part.end_s, 1e300, 0.0);
  return other;
}

}  // namespace

std::vector<Prediction> hole_columns(const Twin& twin, const std::vector<MeasuredRun>& runs) {
  std::vector<Prediction> columns;
  Twin::Workspace workspace(twin);
  const auto readings = [&](const MeasuredRun& run) { return twin.readings(twin.as_written(), run, workspace); };
  const auto driven = [&](const MeasuredRun& run, const Hole& part, bool is_most) {
    MeasuredRun other = run;
    other.cyclogram = driven_otherwise(run, part, is_most);
    return readings(other);
  };
  const auto add = [&](std::size_t r, const auto& of_run) {
    Prediction column;
    for (const MeasuredRun& run : runs)
      column.push_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(twin.outputs().name.size()),
                                             static_cast<Eigen::Index>(run.time_s.size())));
    const bool is_solved = has_solution([&] { column[r] = of_run(); });
    if (is_solved && !column[r].isZero(0.0)) columns.push_back(std::move(column));
  };
  for (std::size_t r = 0; r < runs.size(); ++r) {
    Eigen::MatrixXd as_it_is;
    for (const Hole& hole : runs[r].holes) {
      Hole part = hole;
      const double ambient_K = runs[r].has_ambient ? unseen_ambient_K(runs[r], hole) : 0.0;
      for (int halving = 0; halving <= kHalvings; ++halving) {
        part.end_s = halving < kHalvings ? 0.5 * (part.begin_s + hole.end_s) : hole.end_s;
        add(r, [&] { return Eigen::MatrixXd(kOpenDrive * (driven(runs[r], part, true) - driven(runs[r], part, false))); });
        if (ambient_K > kKnownAmbient_K && !has_rows(runs[r], part)) {
          add(r, [&] {
            if (as_it_is.size() == 0) as_it_is = readings(runs[r]);
            MeasuredRun warmer = runs[r];
            warmer.ambient = warmer_in(warmer.ambient, part, ambient_K);
            return Eigen::MatrixXd(readings(warmer) - as_it_is);
          });
        }
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
