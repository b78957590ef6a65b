#include "scenarios/reader/read_axes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/lists.hpp"
#include "base/quantity.hpp"
#include "scenarios/reader/recorded_run.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kRounding_m = 1e-9;  // of millimetres with seven digits over a hundred metres

bool is_within(const MovingAxis& axis, double position_m) {
  return position_m >= axis.low_m - kRounding_m && position_m <= axis.high_m + kRounding_m;
}

std::string range_words(const MovingAxis& axis) {
  return fmt::format("{:g} mm to {:g} mm", 1e3 * axis.low_m, 1e3 * axis.high_m);
}

MovingAxis read_moving_axis(const std::string& name, const ConfigMap& in) {
  const std::string along = in.choice("along");
  MovingAxis axis{.name = name,
                  .moves = in.texts("moves"),
                  .along = (along[0] == '-' ? -1.0 : 1.0) * Eigen::Vector3d::Unit(along.back() - 'x'),
                  .column = {},
                  .where = in.where()};
  const std::vector<double> range_m = in.quantities("range");
  if (range_m.size() != 2 || !(range_m[0] < range_m[1]))
    in.fail("range", "two positions are required, the lower one first, such as [0 mm, 400 mm]");
  axis.low_m = range_m[0];
  axis.high_m = range_m[1];
  axis.drawn_at_m = in.quantity("drawn_at");
  axis.at_m = in.has("at") ? in.quantity("at") : axis.drawn_at_m;
  axis.column = in.text("column", "position_" + name);
  if (!is_of_column(axis.column, "mm")) in.fail("column", "its name must begin with `position_`, such as position_x");
  axis.step_m = in.quantity("step");
  for (const char* key : {"drawn_at", "at"}) {
    const double position_m = std::string(key) == "at" ? axis.at_m : axis.drawn_at_m;
    if (!is_within(axis, position_m))
      in.fail(key,
              fmt::format("{:g} mm is outside the `range` of axis '{}', {}", 1e3 * position_m, name, range_words(axis)));
  }
  in.reject_unknown_keys();
  return axis;
}

/// The column that moves an axis, or nullptr. @throws InputError  if it is not in mm
const Cyclogram::Column* column_of(const MovingAxis& axis, const Cyclogram& cyclogram) {
  const Cyclogram::Column* column = cyclogram.column(axis.column);
  if (column && column->unit != "mm")
    throw InputError(axis.where,
                     fmt::format("column '{}' of cyclogram '{}' is in {}; the position of axis '{}' must be in mm",
                                 column->name, cyclogram.name, column->unit, axis.name));
  return column;
}

double position_m(const MovingAxis& axis, const Cyclogram::Column& column, double time_s) {
  double at_m = 1e-3 * column.at(time_s);
  if (axis.step_m > 0.0)
    at_m = std::min(axis.high_m, axis.low_m + axis.step_m * std::round((at_m - axis.low_m) / axis.step_m));
  return std::abs(at_m - axis.at_m) <= kRounding_m ? axis.at_m : at_m;  // else it would be another pose
}

}  // namespace

schema::Map axes_schema() {
  using namespace schema;
  const schema::Map axis = {
      .name = "axes, entries",
      .keys = {
          compulsory("moves", list(text(), 1), "regions of the mesh that slide as one rigid unit"),
          compulsory("along", choice({"x", "y", "z", "-x", "-y", "-z"}),
                     "the direction in which they slide while the position rises; of a body that carries the work the "
                     "opposite of the axis (ISO 841)"),
          compulsory("range", list(quantity("m"), 2), "lowest and highest position"),
          schema::optional("drawn_at", quantity("m"), 0.0, "position of the axis in the mesh or drawing"),
          schema::optional("at", quantity("m"), Said{"`drawn_at`"}, "position of the axis: the pose that is computed"),
          schema::optional("column", text(), Said{"`position_<name>`"},
                           "column in mm of cyclograms and records that moves the axis; begins with `position_`"),
          schema::optional("step", quantity("m", 0.0, 10.0), 0.0,
                           "positions of columns are rounded to multiples of it, from the lowest one on; each pose takes "
                           "memory and one factorisation")}};
  return {.name = "axes",
          .others = {compulsory("axis", schema::map(axis), "a linear axis by its name, such as x")},
          .about = "Bodies that slide on others (docs/how-to/poses.md)."};
}

std::vector<MovingAxis> read_axes(const ConfigMap& in) {
  std::vector<MovingAxis> axes;
  for (const std::string& name : in.keys()) {
    axes.push_back(read_moving_axis(name, in.map(name)));
    for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
      if (axes[i].column == axes.back().column)
        in.fail(name, fmt::format("axes '{}' and '{}' have the same `column`, {}", axes[i].name, name, axes[i].column));
    }
  }
  in.reject_unknown_keys();
  return axes;
}

Eigen::Vector3d shift_m(const std::vector<MovingAxis>& axes, const std::string& region) {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  for (const MovingAxis& axis : axes) {
    if (is_in(axis.moves, region)) shift += (axis.at_m - axis.drawn_at_m) * axis.along;
  }
  return shift;
}

Pose pose_of(const std::vector<MovingAxis>& axes) {
  Pose pose;
  for (const MovingAxis& axis : axes) pose.push_back(axis.at_m);
  return pose;
}

std::string pose_words(const std::vector<MovingAxis>& axes, const Pose& pose) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < axes.size(); ++i) parts.push_back(fmt::format("{} = {:g} mm", axes[i].name, 1e3 * pose[i]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

void set_pose(std::vector<MovingAxis>& axes, const std::string& text, const std::vector<Cyclogram>& cyclograms) {
  const std::vector<std::string> known = names_of(axes);
  if (known.empty()) throw InputError(fmt::format("--pose {}: the scenario has no `axes` that could move", text));
  const std::size_t equals = text.find('=');
  const int axis = index_of(known, text.substr(0, equals));
  if (equals == std::string::npos || axis < 0)
    throw InputError(fmt::format("--pose {}: an axis and its position are required, such as {}=100mm; there are {}", text,
                                 known.front(), fmt::join(known, ", ")));
  MovingAxis& moved = axes[static_cast<std::size_t>(axis)];
  try {
    moved.at_m = parse_quantity(text.substr(equals + 1), "m");
  } catch (const RangeError& e) {
    throw InputError(fmt::format("--pose {}: {}", text, e.what()));
  }
  if (!is_within(moved, moved.at_m))
    throw InputError(moved.where, fmt::format("--pose {}: the position is outside the `range` of axis '{}', {}", text,
                                              moved.name, range_words(moved)));
  for (const Cyclogram& c : cyclograms) {
    if (c.column(moved.column))
      throw InputError(
          fmt::format("--pose {}: cyclogram '{}' moves axis '{}' by its column '{}'; leave out --pose, or "
                      "choose a cyclogram without this column by --cyclogram",
                      text, c.name, moved.name, moved.column));
  }
}

std::vector<PoseStretch> pose_stretches(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram) {
  const double end_s = cyclogram.duration_s();
  std::vector<double> changes_s = {0.0};
  std::vector<const Cyclogram::Column*> columns;
  for (const MovingAxis& axis : axes) {
    columns.push_back(column_of(axis, cyclogram));
    if (!columns.back()) continue;
    for (const double t_s : columns.back()->rows.time_s) {
      if (t_s > 0.0 && t_s < end_s) changes_s.push_back(t_s);
    }
  }
  std::sort(changes_s.begin(), changes_s.end());
  std::vector<PoseStretch> stretches;
  for (const double t_s : changes_s) {
    Pose pose = pose_of(axes);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (columns[i]) pose[i] = position_m(axes[i], *columns[i], t_s);
    }
    if (!stretches.empty() && stretches.back().start_s == t_s) stretches.pop_back();
    if (!stretches.empty() && stretches.back().pose == pose) continue;
    if (!stretches.empty()) stretches.back().end_s = t_s;
    stretches.push_back({t_s, end_s, std::move(pose)});
  }
  return stretches;
}

bool moves_axes(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram) {
  if (axes.empty()) return false;
  const std::vector<PoseStretch> stretches = pose_stretches(axes, cyclogram);
  return stretches.size() > 1 || stretches.front().pose != pose_of(axes);
}

void require_within_range(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram) {
  for (const MovingAxis& axis : axes) {
    const Cyclogram::Column* column = column_of(axis, cyclogram);
    if (!column) continue;
    for (std::size_t i = 0; i < column->rows.value.size(); ++i) {
      if (is_within(axis, 1e-3 * column->rows.value[i])) continue;
      throw InputError(axis.where,
                       fmt::format("cyclogram '{}' moves axis '{}' to {:g} mm in row {} of column '{}', at {:g} min; its "
                                   "`range` is {}. Correct the row or the range",
                                   cyclogram.name, axis.name, column->rows.value[i], i + 1, column->name,
                                   column->rows.time_s[i] / 60.0, range_words(axis)));
    }
  }
}

void require_resting(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram) {
  if (!moves_axes(axes, cyclogram)) return;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (const PoseStretch& stretch : pose_stretches(axes, cyclogram)) {
      if (stretch.pose[i] == axes[i].at_m) continue;
      throw InputError(
          axes[i].where,
          fmt::format("cyclogram '{}' moves axis '{}' to {:g} mm, but this model holds it at {:g} mm. If it stays "
                      "there, write `at: {:g} mm`. Only `simulate`, and `run` with `volume`, of the full model "
                      "(`solver: {{model: full}}`) follow moves; otherwise leave out the column '{}'",
                      cyclogram.name, axes[i].name, 1e3 * stretch.pose[i], 1e3 * axes[i].at_m, 1e3 * stretch.pose[i],
                      axes[i].column));
    }
  }
}

}  // namespace driftwright::scenarios
