#include "compensation/frames/axis_programs.hpp"

#include <fmt/format.h>

#include "base/errors.hpp"
#include "compensation/frames/frame_programs_text.hpp"

namespace driftwright::compensation {

Eigen::Vector3d before_touch_m(const AxisProgram& p) {
  Eigen::Vector3d from_m = p.at_m;
  from_m[p.axis] -= p.toward * kBeforeTouch_m;
  return from_m;
}

double beyond_touch_m(const AxisProgram& p) {
  return p.at_m[p.axis] + p.toward * kBeyondTouch_m;
}

std::string gauge_words(const AxisProgram& p) {
  return fmt::format(
      "the gauge is touched along {} at X{} Y{} Z{}: the tip of the probe in machine coordinates, found by this program at "
      "the reference; {:g} mm above it the way must be free",
      letter_of(p), mm(p.at_m[0]), mm(p.at_m[1]), mm(p.at_m[2]), 1e3 * p.clearance_m);
}

std::string bound_words(const AxisProgram& p) {
  return fmt::format(
      "limits: first offset {:.1f} um, later steps {:.1f} um, offset {:.1f} um; beyond them a touch is refused", p.first_um,
      p.step_um, p.most_um);
}

std::vector<ProgramFile> axis_programs(const AxisProgram& p) {
  if (p.axis == 2 && p.toward > 0.0) throw InputError("z is touched downward, along -z; upward the spindle is in the way");
  std::vector<ProgramFile> files = siemens_axis(p);
  for (const auto& more : {linuxcnc_axis(p), heidenhain_axis(p)}) files.insert(files.end(), more.begin(), more.end());
  return files;
}

}  // namespace driftwright::compensation
