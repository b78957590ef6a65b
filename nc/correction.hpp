#pragma once
// Offsets written into an NC program, every line of which stays as it is, byte by byte.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "nc/step.hpp"

namespace driftwright {

enum class NcDialect {
  kLinuxCnc,  ///< G10 L2 Pn X Y Z: the active work offset, absolute; no G92, which the program may use
  kSiemens,  ///< $P_BFRAME[X,TR]=: the base frame, absolute. Every work offset follows it; written again behind each G54 ... of the
             ///< program, which loads it anew. TRANS and ATRANS stay the program's
  kHeidenhain,  ///< G54 X+... of DIN/ISO, its datum shift, absolute, all of `axes` each time
};

struct NcOffsetOptions {
  NcDialect dialect = NcDialect::kLinuxCnc;
  int work_offset = 540;                             ///< LinuxCNC: 540 ... 590, 591, 592, 593 for G54 ... G59.3
  std::array<double, 3> base_m = {0, 0, 0};          ///< what the offset (base frame, datum shift) holds without corrections
  std::array<bool, 3> axes = {false, false, false};  ///< that corrections are written for
};

/// A change of the offset: before the block `step`, or on its way at that share of it (it is divided then).
struct NcOffsetChange {
  std::size_t step = 0;
  double share = 0.0;                              ///< [0, 1)
  std::array<std::optional<double>, 3> shift_m{};  ///< new offset - base_m of the axes that change
};

struct CorrectedNcProgram {
  std::string text;
  std::vector<int> lines;               ///< line of each change's first offset word in `text`, from one
  std::vector<std::string> notes = {};  ///< what runs without corrections, with its line
};

/// Puts changes of the offset into a program. Before its first motion, and before any G41 or G42, stands a line that sets the offset of
/// `axes` (a run cut short leaves the last one behind), before its end one that sets base_m again. Each change is
///
///     [share > 0: the block's own motion word and F to the point at that share of its straight line]
///     the offset
///     [unless all of its axes come to it by the rapid that follows: `G0` or `G1` to where they stand; in G91 by G90 and back]
///
/// Points are written to 1e-6 mm or 1e-7 inch, offsets in the unit in force. Line ends are those of the line behind.
/// Without changes the text is the program as it was.
/// @param bytes    the program
/// @param steps    of the same program
/// @param initial  shift in front [m]
/// @param changes  in their order; each where nc_entries() or why_not_divisible() allow it
/// @throws InputError  with the line: for another work offset than `work_offset` or one other than G54 that is not named before the
///                     first motion (LinuxCNC), for inches (Siemens, Heidenhain), for G28, G30, G53 to G59 (Heidenhain),
///                     and where lines are put: without G20 or G21 before
///                     them, with G41 or G42 on at the end, for a last block that cuts
[[nodiscard]] CorrectedNcProgram corrected_nc_program(const std::string& bytes, const std::vector<NcStep>& steps,
                                                      const std::array<double, 3>& initial_m,
                                                      const std::vector<NcOffsetChange>& changes,
                                                      const NcOffsetOptions& options);

}  // namespace driftwright
