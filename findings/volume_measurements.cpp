#include "findings/volume_measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "base/file_name.hpp"
#include "base/lists.hpp"
#include "findings/columns.hpp"
#include "findings/named_value.hpp"

namespace driftwright::findings {
namespace {

using output::Column, output::Datum, output::Plot, output::Section, output::Table;
using scenarios::MovingAxis, scenarios::VolumeSettings;

constexpr double kDegree_rad = 0.017453292519943295;
constexpr std::array<const char*, 3> kAlong = {"X", "Y", "Z"}, kAbout = {"A", "B", "C"};

Column time_column() {
  return {.key = "time_min", .title = "time", .unit = "min", .digits = output::decimals(0)};
}

Column angle_column(const std::string& title) {
  return {.key = "angle_deg", .title = title, .unit = "deg", .digits = output::decimals(1)};
}

/// XOC, YOC, AOC, BOC of an axis along z, and so on: what lies across the axis.
void add_location_columns(Table& table, const Eigen::Vector3d& direction, const std::string& letter) {
  for (const bool is_tilt : {false, true}) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string name = std::string(is_tilt ? kAbout[i] : kAlong[i]) + "O";
      if (std::abs(direction[static_cast<Eigen::Index>(i)]) > 1.0 - 1e-9) continue;  // along the axis, to rounding
      table.columns.push_back(is_tilt ? urad_column(name + "_urad", name + letter)
                                      : um_column(name + "_um", name + letter, 2));
    }
  }
}

void add_location(std::vector<Datum>& row, const Eigen::Vector3d& direction, const Eigen::Vector3d& shift_m,
                  const Eigen::Vector3d& tilt_rad) {
  for (const Eigen::Vector3d& part : {shift_m, tilt_rad}) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (std::abs(direction[i]) <= 1.0 - 1e-9) row.emplace_back(1e6 * part[i]);
    }
  }
}

Section r_test_section(const studies::WorkVolume& volume, const VolumeSettings& settings,
                       const std::vector<MovingAxis>& axes) {
  const studies::RTest& test = *volume.r_test;
  const std::string letter = axis_letter(axes[settings.r_test->axis]);
  Section section{.key = "r_test", .title = "R-test of axis " + letter};
  Plot plot{.title = fmt::format("R-test of axis {} after {:.0f} min", letter, volume.time_s.back() / 60.0),
            .x_label = axes[settings.r_test->axis].name + " [deg]",
            .y_label = "ball against the sensors [µm]"};
  Table readings{.key = "readings",
                 .title = "Ball against the sensors",
                 .caption = "Along the axes of the machine; less what the cold machine shows at the same position.",
                 .columns = {time_column(), angle_column(axes[settings.r_test->axis].name)},
                 .detail = true,
                 .file = "r_test.csv"};
  for (std::size_t i = 0; i < 3; ++i) {
    readings.columns.push_back(um_column(fmt::format("moved_{:c}_um", "xyz"[i]), std::string("D") + kAlong[i], 2));
    plot.series.push_back({.label = std::string("D") + kAlong[i]});
  }
  Table fit{.key = "fit",
            .title = "Errors that the R-test shows",
            .caption =
                "The axis of rotation against the path of the tool, positive along and about the axes of the machine, at "
                "the point `through`. The ball in the work: away from the axis, ahead in a positive turn, and along `about` "
                "together with the axis. What is left are error motions of the turn, and errors of the linear axes.",
            .columns = {time_column()}};
  add_location_columns(fit, test.direction, letter);
  fit.columns.push_back(um_column("radial_um", "ball outward", 2));
  fit.columns.push_back(um_column("tangential_um", "ball ahead", 2));
  fit.columns.push_back(um_column("axial_um", "ball along the axis", 2));
  fit.columns.push_back(um_column("left_um", "left", 2));
  for (std::size_t t = 0; t < volume.time_s.size(); ++t) {
    for (std::size_t k = 0; k < test.angles_rad.size(); ++k) {
      const Eigen::Vector3d moved_um = 1e6 * test.moved_m[t][k];
      readings.rows.push_back(
          {volume.time_s[t] / 60.0, test.angles_rad[k] / kDegree_rad, moved_um[0], moved_um[1], moved_um[2]});
      if (t + 1 < volume.time_s.size()) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        plot.series[i].x.push_back(test.angles_rad[k] / kDegree_rad);
        plot.series[i].y.push_back(moved_um[static_cast<Eigen::Index>(i)]);
      }
    }
    const studies::RTestFit& f = test.fits[t];
    std::vector<Datum> row = {volume.time_s[t] / 60.0};
    add_location(row, test.direction, f.shift_m, f.tilt_rad);
    for (const double value_m : {f.radial_m, f.tangential_m, f.axial_m, f.left_m}) row.emplace_back(1e6 * value_m);
    fit.rows.push_back(std::move(row));
  }
  add(section, std::move(plot));
  add(section, std::move(fit));
  add(section,
      named_value("reach_mm", "longest distance from the tool's point to the ball, spanned by the rigid sensor head",
                  1e3 * test.reach_m, "mm"));
  add(section, std::move(readings));
  return section;
}

Section ball_bar_section(const studies::WorkVolume& volume, const VolumeSettings& settings,
                         const std::vector<MovingAxis>& axes) {
  const studies::BallBar& bar = *volume.ball_bar;
  const std::array<std::string, 2> names = {axes[settings.ball_bar->axes[0]].name, axes[settings.ball_bar->axes[1]].name};
  Section section{
      .key = "ball_bar",
      .title = fmt::format("Ball-bar: circle of {:g} mm of {} and {}", 1e3 * settings.ball_bar->radius_m,
                           axis_letter(axes[settings.ball_bar->axes[0]]), axis_letter(axes[settings.ball_bar->axes[1]]))};
  Plot plot{.title = "Ball-bar: deviation of the radius", .x_label = "angle [deg]", .y_label = "longer [µm]"};
  Table readings{.key = "readings",
                 .title = "Deviation of the radius",
                 .caption = fmt::format("Actual - commanded. The angle counts from +{} to +{}.", names[0], names[1]),
                 .columns = {time_column(), angle_column("angle"), um_column("longer_um", "longer", 2)},
                 .detail = true,
                 .file = "ball_bar.csv"};
  Table fit{
      .key = "fit",
      .title = "Circular test (ISO 230-4)",
      .caption =
          "G: width of the ring about the centre of the least-squares circle. F: deviation of the radius about the "
          "commanded centre. The bar itself keeps its length.",
      .columns = {time_column(), um_column("G_um", "G", 2), um_column("F_max_um", "F max", 2),
                  um_column("F_min_um", "F min", 2), um_column("radius_um", "mean radius", 2),
                  um_column("centre_1_um", "centre " + names[0], 2), um_column("centre_2_um", "centre " + names[1], 2)}};
  for (std::size_t t = 0; t < volume.time_s.size(); ++t) {
    output::Series series{.label = fmt::format("{:.0f} min", volume.time_s[t] / 60.0)};
    for (std::size_t k = 0; k < bar.angles_rad.size(); ++k) {
      const double angle_deg = bar.angles_rad[k] / kDegree_rad, longer_um = 1e6 * bar.longer_m[t][k];
      readings.rows.push_back({volume.time_s[t] / 60.0, angle_deg, longer_um});
      series.x.push_back(angle_deg);
      series.y.push_back(longer_um);
    }
    plot.series.push_back(std::move(series));
    const studies::CircleFit& f = bar.fits[t];
    fit.rows.push_back({volume.time_s[t] / 60.0, 1e6 * f.circular_m, 1e6 * f.most_m, 1e6 * f.least_m, 1e6 * f.radius_m,
                        1e6 * f.centre_m[0], 1e6 * f.centre_m[1]});
  }
  add(section, std::move(plot));
  add(section, std::move(fit));
  add(section, std::move(readings));
  return section;
}

}  // namespace

std::string axis_letter(const MovingAxis& axis) {
  std::string letter = axis.name;
  std::transform(letter.begin(), letter.end(), letter.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return letter;
}

std::string own_csv(const MovingAxis& axis, const std::string& table) {
  return "tables/" + file_name(fmt::format("axis_{}_{}", axis.name, table), ".csv");
}

Column urad_column(const std::string& key, const std::string& title) {
  return {.key = key, .title = title, .unit = "urad", .digits = output::decimals(1)};
}

void add_axis_location(Section& section, const studies::WorkVolume& volume,
                       const std::vector<const studies::VolumePoint*>& line, const VolumeSettings& settings,
                       const std::vector<MovingAxis>& axes, std::size_t axis) {
  const bool turns_work = is_in(axes[axis].moves, settings.work), turns_tool = is_in(axes[axis].moves, settings.tool.region);
  if (turns_work == turns_tool) return;
  const double sign = turns_work ? -1.0 : 1.0;  // errors are those of the tool against the work
  const Eigen::Vector3d direction = scenarios::way_at_pose(scenarios::axes_at(axes, line.front()->pose), axis).direction;
  Table table{
      .key = "location",
      .title = fmt::format("Place of the axis of rotation {} (ISO 230-7)", axis_letter(axes[axis])),
      .caption = fmt::format("Of the axis against the {0}, positive along and about the axes of the machine, at the point "
                             "`through`: the part of the errors that does not turn with the body. A tilt of the {0} counts, "
                             "too; an R-test shows the axis against the linear axes. Left: the longest remainder of the "
                             "shifts.",
                             turns_work ? "tool" : "work"),
      .columns = {time_column()},
      .file = own_csv(axes[axis], "location")};  // its columns depend on the direction of the axis
  add_location_columns(table, direction, axis_letter(axes[axis]));
  table.columns.push_back(um_column("left_um", "left", 2));
  std::vector<double> angles_rad;
  for (const studies::VolumePoint* p : line) angles_rad.push_back(p->pose[axis]);
  for (std::size_t t = 0; t < volume.time_s.size(); ++t) {
    std::vector<Eigen::Vector3d> shifts_m, tilts_rad;
    for (const studies::VolumePoint* p : line) {
      shifts_m.push_back(sign * studies::error_on_axis(axes, axis, settings.work, *p, t));
      tilts_rad.push_back(sign * p->turn_rad[t]);
    }
    const auto shift = studies::fit_turn(direction, angles_rad, shifts_m),
               tilt = studies::fit_turn(direction, angles_rad, tilts_rad);
    if (!shift || !tilt) return;
    std::vector<Datum> row = {volume.time_s[t] / 60.0};
    add_location(row, direction, shift->still, tilt->still);
    row.emplace_back(1e6 * shift->left);
    table.rows.push_back(std::move(row));
  }
  add(section, std::move(table));
}

void add_measurements(Section& body, const studies::WorkVolume& volume, const VolumeSettings& settings,
                      const std::vector<MovingAxis>& axes) {
  if (volume.r_test) body.sections.push_back(r_test_section(volume, settings, axes));
  if (volume.ball_bar) body.sections.push_back(ball_bar_section(volume, settings, axes));
}

}  // namespace driftwright::findings
