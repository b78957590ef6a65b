#include "compensation/frames/frame_programs.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.hpp"
#include "compensation/frames/frame_programs_text.hpp"

namespace driftwright::compensation {

std::string mm(double m, int decimals) {
  const std::string text = fmt::format("{:.{}f}", 1e3 * m, decimals);
  return text.find_first_not_of("-0.") == std::string::npos ? "0." + std::string(static_cast<std::size_t>(decimals), '0')
                                                            : text;
}

double search_m(const FrameProgram& p) {
  return 0.5 * p.free_diameter_m + 3e-3;
}

std::string limit_words(const FrameProgram& p) {
  if (!std::isfinite(p.most_correction_um)) return "";
  return fmt::format("; limit of the scenario: no correction above {:g} um", p.most_correction_um);
}

std::string last_numbers(const FrameProgram& p) {
  return fmt::format("last: TEMP_SCALE {:.9f}, TEMP_SHIFT {} mm, shift y {} mm, z {} mm, turn {:.7f} deg, tilt {:.7f} deg{}",
                     p.frame.x.scale, mm(p.frame.x.shift_m), mm(p.frame.shift_y_m), mm(p.frame.shift_z_m),
                     kDegrees * p.frame.turn_rad, kDegrees * p.frame.tilt_rad, limit_words(p));
}

std::string origin_words(const FrameProgram& p) {
  return fmt::format("places are of the tip of the probe in machine coordinates; the origin of the model is at X{} Y{} Z{}",
                     mm(p.origin_m[0]), mm(p.origin_m[1]), mm(p.origin_m[2]));
}

std::string arc_words(const FrameProgram& p) {
  return fmt::format("X alone is scaled: an arc in X Y of 100 mm radius is out of round by {:.1f} um",
                     1e5 * std::abs(p.frame.x.scale - 1.0));
}

std::string why_no_program(const std::vector<ProgramRing>& rings) {
  if (rings.size() != 2) return fmt::format("{} rings; a program measures exactly two", rings.size());
  const Eigen::Vector3d apart_m = rings[1].at_m - rings[0].at_m;
  if (!(apart_m[0] >= kLeastRingDistance_m))
    return fmt::format("the rings are {:.1f} mm apart along x; they must be {:g} mm apart or more, in the order of rising x",
                       1e3 * apart_m[0], 1e3 * kLeastRingDistance_m);
  const double off_m = apart_m.tail<2>().cwiseAbs().maxCoeff();
  if (off_m <= kMostOffLine * apart_m[0]) return "";
  return fmt::format(
      "the rings differ by {:.1f} mm across x; a program takes a turn of the table for a scale then, unless they lie on a "
      "line "
      "along x to {:.1f} mm",
      1e3 * off_m, 1e3 * kMostOffLine * apart_m[0]);
}

FrameProgram in_machine(FrameProgram program, const Eigen::Vector3d& origin_m) {
  if (const std::string why = why_no_program(program.rings); !why.empty()) throw InputError(why);
  const Frame frame = program.frame.frame();
  std::vector<RingPair> pairs;
  for (ProgramRing& ring : program.rings) {
    pairs.push_back({ring.name, ring.at_m + origin_m, frame.map(ring.at_m) + origin_m});
    ring.at_m += origin_m;
  }
  program.frame = fit_table_frame(pairs);
  program.control.reference_position_m += origin_m[0];
  program.low_m += origin_m[0];
  program.high_m += origin_m[0];
  program.origin_m += origin_m;
  return program;
}

std::vector<ProgramFile> frame_programs(const FrameProgram& program) {
  if (const std::string why = why_no_program(program.rings); !why.empty()) throw InputError(why);
  std::vector<ProgramFile> files = siemens_frame(program);
  for (const auto& more : {linuxcnc_frame(program), heidenhain_frame(program)})
    files.insert(files.end(), more.begin(), more.end());
  return files;
}

}  // namespace driftwright::compensation
