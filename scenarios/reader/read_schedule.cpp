#include "scenarios/reader/read_schedule.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "scenarios/reader/read_cyclogram.hpp"

namespace driftwright::scenarios {
namespace {

const std::map<std::string, int> kWorkOffsets = {{"G54", 540}, {"G55", 550},   {"G56", 560},   {"G57", 570},  {"G58", 580},
                                                 {"G59", 590}, {"G59.1", 591}, {"G59.2", 592}, {"G59.3", 593}};
const std::vector<std::string> kLetters = {"x", "y", "z"};

std::vector<std::string> along(const std::vector<DisplacementOutput>& displacements, int axis) {
  std::vector<std::string> names;
  for (const DisplacementOutput& d : displacements) {
    if (d.points && d.points->axis == axis) names.push_back(d.name);
  }
  return names;
}

ScheduleAxis read_axis(const ConfigMap& in, int axis, const std::vector<DisplacementOutput>& displacements,
                       double tolerance_um) {
  ScheduleAxis a{.axis = axis};
  std::vector<std::string> known;
  for (const DisplacementOutput& d : displacements) known.push_back(d.name);
  if (in.has("displacement")) {
    a.displacement = in.choice("displacement", known);
  } else {
    const std::vector<std::string> own = along(displacements, axis);
    if (own.size() != 1) {
      in.fail("displacement", fmt::format("{} along {}, so `displacement` must name one of {}",
                                          own.empty() ? "no displacement is" : fmt::format("{} are", fmt::join(own, ", ")),
                                          kLetters[axis], fmt::join(known, ", ")));
    }
    a.displacement = own.front();
  }
  a.sign = in.choice("sign", {"+1", "1", "-1"}, "+1") == "-1" ? -1.0 : 1.0;
  a.tolerance_um = in.quantity("tolerance", "um", 1e-3, 1e6, tolerance_um);
  in.reject_unknown_keys();
  return a;
}

}  // namespace

ScheduleSettings read_schedule(const ConfigMap& in, const std::vector<DisplacementOutput>& displacements,
                               double tolerance_um) {
  ScheduleSettings s;
  s.where = in.where();
  tolerance_um = in.quantity("tolerance", "um", 1e-3, 1e6, tolerance_um);
  if (const auto axes = in.optional_map("axes")) {
    for (int axis = 0; axis < 3; ++axis) {
      if (const auto entry = axes->optional_map(kLetters[axis]))
        s.axes.push_back(read_axis(*entry, axis, displacements, tolerance_um));
    }
    axes->reject_unknown_keys();
  } else {
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<std::string> own = along(displacements, axis);
      if (own.size() > 1) {
        in.fail("axes", fmt::format("{} are along {}; `axes: {{{}: {{displacement: ...}}}}` says which is meant",
                                    fmt::join(own, ", "), kLetters[axis], kLetters[axis]));
      }
      if (!own.empty()) s.axes.push_back({.axis = axis, .displacement = own.front(), .tolerance_um = tolerance_um});
    }
  }
  if (s.axes.empty())
    in.fail("axes", "no axis to correct; a map such as {z: {displacement: nose_z, sign: +1, tolerance: 10 um}} is wanted");
  s.policy = in.choice("policy", kSchedulePolicies, s.policy);
  s.dialect = in.choice("dialect", kScheduleDialects, s.dialect);
  std::vector<std::string> offsets;
  for (const auto& [name, code] : kWorkOffsets) offsets.push_back(name);
  s.work_offset = kWorkOffsets.at(in.choice("work_offset", offsets, "G54"));
  const Eigen::Vector3d base_m = in.vector3("base_offset", "m");
  s.base_offset_m = {base_m[0], base_m[1], base_m[2]};
  s.from_start = in.choice("drift_from", {"reference", "start"}, "reference") == "start";
  s.nc = read_nc_settings(in);
  s.resolution_s = in.quantity("resolution", "s", 0.0, 1e6, s.resolution_s);
  s.cutting_power_W = in.quantity("cutting_power", "W", 0.0, 1e9, s.cutting_power_W);
  in.reject_unknown_keys();
  return s;
}

}  // namespace driftwright::scenarios
