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
  a.sign = in.choice("sign") == "-1" ? -1.0 : 1.0;
  a.tolerance_um = in.quantity("tolerance", tolerance_um);
  in.reject_unknown_keys();
  return a;
}

}  // namespace

schema::Map schedule_schema() {
  using namespace schema;
  const ScheduleSettings s;
  std::vector<std::string> offsets;
  for (const auto& [name, code] : kWorkOffsets) offsets.push_back(name);
  const schema::Map axis = {
      .name = "schedule, axes",
      .keys = {schema::optional("displacement", text(), Said{"the only one along the axis"}, "whose drift is corrected"),
               schema::optional("sign", choice({"+1", "1", "-1"}), "+1",
                                "+1: the displacement counts in the axis's direction, -1: against it"),
               schema::optional("tolerance", quantity("um", 1e-3, 1e6), Said{"that of `schedule`"},
                                "a correction may be wrong by it")},
      .about = "An axis of the program, under its letter."};
  schema::Map axes = {.name = "schedule, axes by letter"};
  for (const std::string& letter : kLetters)
    axes.keys.push_back(schema::optional(letter, schema::map(axis), "how this axis is corrected"));
  schema::Map map = {
      .name = "schedule",
      .keys = {schema::optional("axes", schema::map(axes), Said{"each along which one displacement is"},
                                "that are corrected"),
               schema::optional("tolerance", quantity("um", 1e-3, 1e6), Said{"that of `study`"},
                                "a correction may be wrong by it"),
               schema::optional("policy", choice(kSchedulePolicies), s.policy.c_str(),
                                "`paper`: steps of the tolerance; `minimal`: fewest changes"),
               schema::optional(
                   "offset", choice({"add", "absolute"}), "add",
                   "`add`: to what the operator has set; `absolute`: base_offset and the correction overwrite it"),
               schema::optional("base_offset", schema::vector3("m"),
                                "what the work offset (base frame, datum shift) holds without corrections; with `offset: "
                                "absolute`, compulsory there"),
               schema::optional("work_offset", choice(offsets), "G54",
                                "that the program runs in; with `offset: absolute` on LinuxCNC"),
               schema::optional("parts", integer(1, 1000), 1, "made one after another by the program"),
               schema::optional("between", quantity("s", 0.0, 1e7), 0.0, "at rest between two of them"),
               schema::optional("drift_from", choice({"reference", "start"}), "reference", "what the drift counts from")},
      .about = "Corrections written into an NC program (docs/how-to/schedule.md)."};
  for (Key& key : nc_keys()) map.keys.push_back(std::move(key));
  return map;
}

ScheduleSettings read_schedule(const ConfigMap& in, const std::vector<DisplacementOutput>& displacements,
                               double tolerance_um) {
  ScheduleSettings s;
  s.where = in.where();
  tolerance_um = in.quantity("tolerance", tolerance_um);
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
    in.fail("axes",
            "no axis is to be corrected; write a map such as {z: {displacement: nose_z, sign: +1, tolerance: 10 um}}");
  s.policy = in.choice("policy");
  s.absolute = in.choice("offset") == "absolute";
  for (const char* key : {"base_offset", "work_offset"}) {
    if (!s.absolute && in.has(key))
      in.fail(key,
              "corrections are added to what the operator has set, whatever that is; where they shall overwrite it, write "
              "`offset: absolute`");
  }
  s.work_offset = kWorkOffsets.at(in.choice("work_offset"));
  if (s.absolute && !in.has("base_offset"))
    in.fail("offset", "absolute offsets require `base_offset`, what the offset holds without corrections");
  if (s.absolute) {
    const Eigen::Vector3d base_m = in.vector3("base_offset");
    s.base_offset_m = {base_m[0], base_m[1], base_m[2]};
  }
  s.parts = in.integer("parts");
  s.between_s = in.quantity("between");
  s.from_start = in.choice("drift_from") == "start";
  s.nc = read_nc_settings(in);
  s.resolution_s = in.quantity("resolution");
  s.cutting_power_W = in.quantity("cutting_power");
  in.reject_unknown_keys();
  return s;
}

}  // namespace driftwright::scenarios
