#include "findings/volume_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "findings/columns.hpp"
#include "findings/machine_section.hpp"
#include "findings/named_value.hpp"
#include "findings/run_section.hpp"
#include "findings/volume_measurements.hpp"

namespace driftwright::findings {
namespace {

using output::Column, output::Plot, output::Section, output::Series, output::Table;
using scenarios::MovingAxis, scenarios::VolumeSettings;

constexpr const char* kErrorTitles[] = {"EX", "EY", "EZ", "EA", "EB", "EC"};

double error_of(const studies::VolumePoint& point, std::size_t time, std::size_t which) {
  const auto axis = static_cast<Eigen::Index>(which % 3);
  return 1e6 * (which < 3 ? point.error_m : point.turn_rad)[time][axis];  // um, urad
}

Table volume_table(const studies::WorkVolume& volume, const std::vector<MovingAxis>& axes) {
  Table table{.key = "points",
              .title = "Error of the tool against the work at each pose and time",
              .caption = "Actual - commanded. The place is that of the tool in the frame of the work, as it was drawn.",
              .columns = {{.key = "time_min", .title = "time", .unit = "min", .digits = output::decimals(0)}},
              .detail = true,
              .file = "volume.csv"};
  for (const MovingAxis& axis : axes)
    table.columns.push_back({.key = fmt::format("position_{}_{}", axis.name, axis.unit()),
                             .title = axis.name,
                             .unit = axis.unit(),
                             .digits = output::decimals(1)});
  for (const char* name : {"x", "y", "z"})
    table.columns.push_back({.key = fmt::format("place_{}_mm", name),
                             .title = fmt::format("place {}", name),
                             .unit = "mm",
                             .digits = output::decimals(1)});
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string name = kErrorTitles[i];
    table.columns.push_back(i < 3 ? um_column(name + "_um", name, 2) : urad_column(name + "_urad", name));
  }
  for (std::size_t t = 0; t < volume.time_s.size(); ++t) {
    for (const studies::VolumePoint& p : volume.points) {
      std::vector<output::Datum> row = {volume.time_s[t] / 60.0};
      for (std::size_t i = 0; i < axes.size(); ++i) row.emplace_back(p.pose[i] / axes[i].unit_SI());
      for (Eigen::Index i = 0; i < 3; ++i) row.emplace_back(1e3 * p.place_m[i]);
      for (std::size_t i = 0; i < 6; ++i) row.emplace_back(error_of(p, t, i));
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

/// The points along one axis, the others at the positions of the grid nearest to the scenario's pose.
std::vector<const studies::VolumePoint*> line_along(const studies::WorkVolume& volume, const VolumeSettings& settings,
                                                    const std::vector<MovingAxis>& axes, std::size_t axis) {
  scenarios::Pose middle;
  for (std::size_t i = 0; i < settings.positions_SI.size(); ++i) {
    const auto apart_SI = [&](double at_SI) { return axes[i].apart_SI(at_SI, volume.own.pose[i]); };
    middle.push_back(*std::min_element(settings.positions_SI[i].begin(), settings.positions_SI[i].end(),
                                       [&](double a, double b) { return apart_SI(a) < apart_SI(b); }));
  }
  std::vector<const studies::VolumePoint*> line;
  for (const studies::VolumePoint& p : volume.points) {
    bool is_on_line = true;
    for (std::size_t i = 0; i < middle.size(); ++i) is_on_line = is_on_line && (i == axis || p.pose[i] == middle[i]);
    if (is_on_line) line.push_back(&p);
  }
  return line;
}

/// Errors of one axis as ISO 230-1 names them, EXX, EYX, ... ECX, from the first position of the axis on. Those of an axis
/// that turns are at its axis of rotation, where an angle makes no shift.
void add_axis(Section& body, const studies::WorkVolume& volume, const VolumeSettings& settings,
              const std::vector<MovingAxis>& axes, std::size_t axis) {
  const std::vector<const studies::VolumePoint*> line = line_along(volume, settings, axes, axis);
  if (line.size() < 2) return;
  const std::string letter = axis_letter(axes[axis]), unit = axes[axis].unit();
  Section section{.key = "axes", .title = "Axis " + letter, .item = output::Item{"axis", axes[axis].name}};
  Table table{
      .key = "errors",
      .title = fmt::format("Errors of axis {} after {:.0f} min (ISO 230-1), from its first position on", letter,
                           volume.time_s.back() / 60.0),
      .caption = std::string("Of the tool against the work. The other axes are at the positions nearest to the pose of "
                             "the scenario.") +
                 (axes[axis].way.turns ? " At the point `through` of the axis of rotation." : ""),
      .columns = {{.key = "position_" + unit, .title = axes[axis].name, .unit = unit, .digits = output::decimals(1)}}};
  if (axes[axis].way.turns) table.file = own_csv(axes[axis], "errors");  // its columns are not those of linear axes
  Plot plot{.title = fmt::format("Errors of axis {} after {:.0f} min", letter, volume.time_s.back() / 60.0),
            .x_label = fmt::format("{} [{}]", axes[axis].name, unit),
            .y_label = "error [µm]"};
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string key = kErrorTitles[i], title = key + letter;
    table.columns.push_back(i < 3 ? um_column(key + "_um", title, 2) : urad_column(key + "_urad", title));
    if (i < 3) plot.series.push_back({.label = title});
  }
  const std::size_t last = volume.time_s.size() - 1;
  const auto error_at = [&](const studies::VolumePoint& p, std::size_t i) {
    if (i >= 3 || !axes[axis].way.turns) return error_of(p, last, i);
    return 1e6 * studies::error_on_axis(axes, axis, settings.work, p, last)[static_cast<Eigen::Index>(i)];
  };
  for (const studies::VolumePoint* p : line) {
    const double position = p->pose[axis] / axes[axis].unit_SI();
    std::vector<output::Datum> row = {position};
    for (std::size_t i = 0; i < 6; ++i) {
      const double change = error_at(*p, i) - error_at(*line.front(), i);
      row.emplace_back(change);
      if (i >= 3) continue;
      plot.series[i].x.push_back(position);
      plot.series[i].y.push_back(change);
    }
    table.rows.push_back(std::move(row));
  }
  add(section, std::move(plot));
  add(section, std::move(table));
  if (axes[axis].way.turns) add_axis_location(section, volume, line, settings, axes, axis);
  body.sections.push_back(std::move(section));
}

}  // namespace

output::Document document_of(const studies::WorkVolume& volume, const scenarios::Scenario& scenario,
                             const scenarios::Model& model, const output::Provenance& made_by) {
  const VolumeSettings& settings = *scenario.volume;
  const std::vector<MovingAxis>& axes = scenario.machine->axes;
  const studies::LargestError peak = studies::largest_error(volume);
  const studies::LargestError left = studies::largest_left(volume);
  const double own_um = 1e6 * studies::largest_error_m(volume.own), peak_um = 1e6 * peak.error_m,
               left_um = 1e6 * left.error_m;
  output::Document document{.made_by = made_by,
                            .title = scenario.name + ": error over the work volume",
                            .subtitle = fmt::format("{} poses, {} times of cyclogram '{}'; {}", volume.points.size(),
                                                    volume.time_s.size(), settings.cyclogram, model.words())};
  Section& body = document.body;
  add(body,
      output::Verdict{.key = "verdict",
                      .kind = output::Verdict::Kind::kNeutral,
                      .title = fmt::format("{:.1f} µm at most in the volume, {:.1f} µm after a correction by one point",
                                           peak_um, left_um),
                      .text = fmt::format(
                          "The largest error is at {}, after {:.0f} min. At the scenario's pose, {}, it is {:.1f} µm; "
                          "a correction by the error there leaves most at {}, after {:.0f} min.",
                          scenarios::pose_words(axes, volume.points[peak.point].pose), volume.time_s[peak.time] / 60.0,
                          scenarios::pose_words(axes, volume.own.pose), own_um,
                          scenarios::pose_words(axes, volume.points[left.point].pose), volume.time_s[left.time] / 60.0)});
  add_machine(body, *scenario.machine, model.mesh(), settings.cyclogram, {});
  add(body, named_value("peak_um", "largest error in the volume", peak_um, "um"));
  add(body,
      named_value("peak_place_mm", "its place in the frame of the work",
                  std::vector<double>{1e3 * volume.points[peak.point].place_m[0], 1e3 * volume.points[peak.point].place_m[1],
                                      1e3 * volume.points[peak.point].place_m[2]},
                  "mm"));
  add(body, named_value("own_um", "largest error at the scenario's pose", own_um, "um"));
  add(body, named_value("left_um", "largest error left by a correction by that pose", left_um, "um"));
  for (std::size_t i = 0; i < axes.size(); ++i) add_axis(body, volume, settings, axes, i);
  add_measurements(body, volume, settings, axes);
  add(body, volume_table(volume, axes));
  const Cyclogram& cyclogram = scenario.cyclogram(settings.cyclogram);
  Section run{.key = "cyclogram", .title = "Cyclogram " + cyclogram.name, .detail = true};
  add_channel_plots(run, volume.run.record, cyclogram);
  add_heat(run, volume.run.trajectory, cyclogram);
  body.sections.push_back(std::move(run));
  return document;
}

}  // namespace driftwright::findings
