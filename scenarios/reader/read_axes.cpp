#include "scenarios/reader/read_axes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/lists.hpp"
#include "base/quantity.hpp"
#include "scenarios/reader/recorded_run.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kRounding_SI = 1e-9;  // m, of millimetres with seven digits over a hundred metres; rad, 1 nm at 1 m
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

std::string range_words(const MovingAxis& axis) {
  return axis.words(axis.low_SI) + " to " + axis.words(axis.high_SI);
}

/// The position as the axis counts it: without full turns, above -180 deg and up to 180 deg, if it is endless.
double counted(const MovingAxis& axis, double position_SI) {
  if (!axis.is_endless) return position_SI;
  constexpr double kDigits = 1e9;  // of a degree: 370 deg and 10 deg must be the same number, not only nearly
  const double rest_deg = std::round(kDigits * std::remainder(position_SI / axis.unit_SI(), 360.0)) / kDigits;
  return axis.unit_SI() * (rest_deg <= -180.0 ? 180.0 : rest_deg);
}

Eigen::Vector3d read_direction(const ConfigMap& in, bool turns) {
  if (turns && in.is_list("about")) {
    const Eigen::Vector3d direction = in.vector3("about");
    if (!(direction.norm() > 0.0)) in.fail("about", "the direction must have a length above zero, such as [0, 0, 1]");
    return direction.normalized();
  }
  const std::string word = in.choice(turns ? "about" : "along");
  return (word[0] == '-' ? -1.0 : 1.0) * Eigen::Vector3d::Unit(word.back() - 'x');
}

MovingAxis read_moving_axis(const std::string& name, const ConfigMap& in) {
  const bool turns = in.description().when_key == "turns";
  MovingAxis axis{.name = name,
                  .moves = in.texts(turns ? "turns" : "moves"),
                  .way = {.direction = read_direction(in, turns), .turns = turns},
                  .column = {},
                  .where = in.where()};
  if (turns) axis.way.through_m = in.vector3("through");
  const double unit_SI = turns ? axis.unit_SI() : 1.0;  // the keys of lengths are read in m, of angles in deg
  axis.is_endless = turns && !in.has("range");
  if (!axis.is_endless) {
    const std::vector<double> range = in.quantities("range");
    if (range.size() != 2 || !(range[0] < range[1]))
      in.fail("range", fmt::format("two positions are required, the lower one first, such as [0 {}, 90 {}]", axis.unit(),
                                   axis.unit()));
    axis.low_SI = unit_SI * range[0];
    axis.high_SI = unit_SI * range[1];
  }
  axis.drawn_at_SI = counted(axis, unit_SI * in.quantity("drawn_at"));
  axis.at_SI = in.has("at") ? counted(axis, unit_SI * in.quantity("at")) : axis.drawn_at_SI;
  axis.column = in.text("column", "position_" + name);
  if (!is_of_column(axis.column, axis.unit()))
    in.fail("column", "its name must begin with `position_`, such as position_" + name);
  axis.step_SI = unit_SI * in.quantity("step");
  for (const char* key : {"drawn_at", "at"}) {
    const double position_SI = std::string(key) == "at" ? axis.at_SI : axis.drawn_at_SI;
    if (!axis.allows(position_SI))
      in.fail(key,
              fmt::format("{} is outside the `range` of axis '{}', {}", axis.words(position_SI), name, range_words(axis)));
  }
  in.reject_unknown_keys();
  return axis;
}

/// True if an axis moves all bodies of another.
bool moves_all(const MovingAxis& axis, const MovingAxis& other) {
  return std::all_of(other.moves.begin(), other.moves.end(), [&](const auto& region) { return is_in(axis.moves, region); });
}

/// Turns and shifts do not commute, so it must be clear which axis carries which.
/// @throws InputError  if two axes move the same body, one of them turns, and the upper one does not carry the lower one
void require_carried(const ConfigMap& in, const std::vector<MovingAxis>& axes) {
  const MovingAxis& lower = axes.back();
  for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
    const MovingAxis& upper = axes[i];
    if ((!upper.way.turns && !lower.way.turns) || moves_all(upper, lower)) continue;
    for (const std::string& region : lower.moves) {
      if (is_in(upper.moves, region))
        in.fail(lower.name,
                fmt::format("axes '{}' and '{}' both move '{}'; an axis must be written above those that it "
                            "carries, and must move all of their bodies. Change the order, or add bodies to '{}'",
                            upper.name, lower.name, region, upper.name));
    }
  }
}

/// The column that moves an axis, or nullptr. @throws InputError  if it is not in mm (deg)
const Cyclogram::Column* column_of(const MovingAxis& axis, const Cyclogram& cyclogram) {
  const Cyclogram::Column* column = cyclogram.column(axis.column);
  if (column && column->unit != axis.unit())
    throw InputError(axis.where,
                     fmt::format("column '{}' of cyclogram '{}' is in {}; the position of axis '{}' must be in {}",
                                 column->name, cyclogram.name, column->unit, axis.name, axis.unit()));
  return column;
}

double column_position_SI(const MovingAxis& axis, const Cyclogram::Column& column, double time_s) {
  double at_SI = axis.unit_SI() * column.at(time_s);
  if (axis.step_SI > 0.0) {
    const double from_SI = axis.is_endless ? 0.0 : axis.low_SI;
    at_SI = from_SI + axis.step_SI * std::round((at_SI - from_SI) / axis.step_SI);
    if (!axis.is_endless) at_SI = std::min(axis.high_SI, at_SI);
  }
  at_SI = counted(axis, at_SI);
  return std::abs(at_SI - axis.at_SI) <= kRounding_SI ? axis.at_SI : at_SI;  // else it would be another pose
}

}  // namespace

schema::Map axes_schema() {
  using namespace schema;
  const auto further = [](schema::Map map, const std::string& unit, const char* column_unit) {
    const double most_step = unit == "m" ? 10.0 : 180.0;
    for (Key& key : std::vector<Key>{
             schema::optional("drawn_at", quantity(unit), 0.0, "position of the axis in the mesh or drawing"),
             schema::optional("at", quantity(unit), Said{"`drawn_at`"}, "position of the axis: the pose that is computed"),
             schema::optional("column", text(), Said{"`position_<name>`"},
                              fmt::format("column in {} of cyclograms and records that moves the axis; begins with "
                                          "`position_`",
                                          column_unit)),
             schema::optional("step", quantity(unit, 0.0, most_step), 0.0,
                              "positions of columns are rounded to multiples of it, from the lowest one on (of an endless "
                              "axis from 0 deg on); each pose takes memory and one factorisation")})
      map.keys.push_back(std::move(key));
    return map;
  };
  const Value direction = choice({"x", "y", "z", "-x", "-y", "-z"});
  const schema::Map linear = {
      .name = "axes, linear",
      .keys = {compulsory("moves", list(text(), 1), "regions of the mesh that slide as one rigid unit"),
               compulsory("along", direction,
                          "the direction in which they slide while the position rises; of a body that carries the work the "
                          "opposite of the axis (ISO 841)"),
               compulsory("range", list(quantity("m"), 2), "lowest and highest position")},
      .when_key = "moves"};
  const schema::Map rotary = {
      .name = "axes, rotary",
      .keys = {compulsory("turns", list(text(), 1), "regions of the mesh that turn as one rigid unit"),
               compulsory("about", Ways{direction, vector3("1")},
                          "the direction of the axis; while the position rises they turn about it as a right-handed screw; "
                          "of a body that carries the work the opposite of the axis (ISO 841)"),
               compulsory("through", vector3("m"), "a point of the axis, as drawn"),
               schema::optional("range", list(quantity("deg"), 2), Said{"endless"},
                                "lowest and highest position; without it positions a full turn apart are the same")},
      .when_key = "turns"};
  return {.name = "axes",
          .others = {compulsory("axis", one_of({further(linear, "m", "mm"), further(rotary, "deg", "deg")}),
                                "an axis by its name, such as x or c; an axis carries those below it")},
          .about = "Bodies that slide or turn on others (docs/how-to/poses.md)."};
}

double MovingAxis::unit_SI() const {
  return way.turns ? kTurn_rad / 360.0 : 1e-3;
}

bool MovingAxis::allows(double position_SI) const {
  return is_endless || (position_SI >= low_SI - kRounding_SI && position_SI <= high_SI + kRounding_SI);
}

double MovingAxis::apart_SI(double a_SI, double b_SI) const {
  return std::abs(is_endless ? std::remainder(a_SI - b_SI, kTurn_rad) : a_SI - b_SI);
}

std::string MovingAxis::words(double position_SI) const {
  const double position = position_SI / unit_SI();
  return fmt::format("{:g} {}", std::abs(position) < 1e-9 ? 0.0 : position, unit());
}

std::vector<MovingAxis> read_axes(const ConfigMap& in) {
  std::vector<MovingAxis> axes;
  for (const std::string& name : in.keys()) {
    axes.push_back(read_moving_axis(name, in.map(name)));
    for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
      if (axes[i].column == axes.back().column)
        in.fail(name, fmt::format("axes '{}' and '{}' have the same `column`, {}", axes[i].name, name, axes[i].column));
    }
    require_carried(in, axes);
  }
  in.reject_unknown_keys();
  return axes;
}

mesh::Motion motion_of(const std::vector<MovingAxis>& axes, const std::string& region) {
  mesh::Motion motion;
  for (const MovingAxis& axis : axes) {
    if (is_in(axis.moves, region)) motion = motion.after(axis.way.by(axis.at_SI - axis.drawn_at_SI));
  }
  return motion;
}

mesh::Way way_at_pose(const std::vector<MovingAxis>& axes, std::size_t axis) {
  mesh::Motion motion;
  for (std::size_t i = 0; i < axis; ++i) {
    if (moves_all(axes[i], axes[axis])) motion = motion.after(axes[i].way.by(axes[i].at_SI - axes[i].drawn_at_SI));
  }
  return axes[axis].way.moved(motion);
}

Pose pose_of(const std::vector<MovingAxis>& axes) {
  Pose pose;
  for (const MovingAxis& axis : axes) pose.push_back(axis.at_SI);
  return pose;
}

std::vector<MovingAxis> axes_at(std::vector<MovingAxis> axes, const Pose& pose) {
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i].at_SI = pose[i];
  return axes;
}

std::string pose_words(const std::vector<MovingAxis>& axes, const Pose& pose) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < axes.size(); ++i) parts.push_back(axes[i].name + " = " + axes[i].words(pose[i]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

void set_pose(std::vector<MovingAxis>& axes, const std::string& text, const std::vector<Cyclogram>& cyclograms) {
  const std::vector<std::string> known = names_of(axes);
  if (known.empty()) throw InputError(fmt::format("--pose {}: the scenario has no `axes` that could move", text));
  const std::size_t equals = text.find('=');
  const int axis = index_of(known, text.substr(0, equals));
  if (equals == std::string::npos || axis < 0)
    throw InputError(fmt::format("--pose {}: an axis and its position are required, such as {}={}; there are {}", text,
                                 known.front(), axes.front().way.turns ? "30deg" : "100mm", fmt::join(known, ", ")));
  MovingAxis& moved = axes[static_cast<std::size_t>(axis)];
  try {
    moved.at_SI = counted(moved, moved.unit_SI() * parse_quantity(text.substr(equals + 1), moved.unit()));
  } catch (const RangeError& e) {
    throw InputError(fmt::format("--pose {}: {}", text, e.what()));
  }
  if (!moved.allows(moved.at_SI))
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
      if (columns[i]) pose[i] = column_position_SI(axes[i], *columns[i], t_s);
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
    const std::string stroke_name = "stroke_" + axis.column.substr(std::string_view("position_").size());
    const Cyclogram::Column* stroke = axis.way.turns ? nullptr : cyclogram.column(stroke_name);
    if (stroke && stroke->unit != axis.unit()) stroke = nullptr;
    for (const Cyclogram::Column* rows_of : {column, stroke}) {
      if (!rows_of) continue;
      for (std::size_t i = 0; i < rows_of->rows.time_s.size(); ++i) {
        const double time_s = rows_of->rows.time_s[i], middle = column->at(time_s),
                     half = stroke ? 0.5 * stroke->at(time_s) : 0.0;
        const bool allows_low = axis.allows(axis.unit_SI() * (middle - half));
        if (allows_low && axis.allows(axis.unit_SI() * (middle + half))) continue;
        throw InputError(
            axis.where,
            fmt::format("cyclogram '{}' moves axis '{}' to {:g} {} in row {} of column '{}', at {:g} min{}; its "
                        "`range` is {}. Correct the row or the range",
                        cyclogram.name, axis.name, allows_low ? middle + half : middle - half, axis.unit(), i + 1,
                        rows_of->name, time_s / 60.0,
                        half > 0.0 ? fmt::format(", with its stroke of {:g} mm", 2.0 * half) : "", range_words(axis)));
      }
    }
  }
}

void require_resting(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram) {
  if (!moves_axes(axes, cyclogram)) return;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (const PoseStretch& stretch : pose_stretches(axes, cyclogram)) {
      if (stretch.pose[i] == axes[i].at_SI) continue;
      const std::string to = axes[i].words(stretch.pose[i]);
      throw InputError(axes[i].where,
                       fmt::format("cyclogram '{}' moves axis '{}' to {}, but this model holds it at {}. If it stays "
                                   "there, write `at: {}`. Only `simulate`, `predict`, and `run` with `volume` follow moves; otherwise leave out "
                                   "the column '{}'",
                                   cyclogram.name, axes[i].name, to, axes[i].words(axes[i].at_SI), to, axes[i].column));
    }
  }
}

}  // namespace driftwright::scenarios
