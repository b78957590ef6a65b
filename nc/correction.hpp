#pragma once
// Offsets written into an NC program, every line of which stays as it is, byte by byte.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "nc/offset_lines.hpp"
#include "nc/step.hpp"

namespace driftwright {

/// A change of the offset: before the block `step`, or on its way at that share of it (it is divided then).
struct NcOffsetChange {
  std::size_t step = 0;
  double share = 0.0;                              ///< [0, 1)
  std::array<std::optional<double>, 3> shift_m{};  ///< new corrections of the offset, of the axes that change
};

struct CorrectedNcProgram {
  std::string text;
  std::vector<int> lines;               ///< line of each change's first offset word in `text`, from one
  std::vector<std::string> notes = {};  ///< what runs without corrections, with its line
};

/// Puts changes of the offset into a program. Before its first motion, and before any G41 or G42, stands what sets the corrections of `axes`
/// (with LinuxCNC's guard_lines()), before its end what takes them back. Each change is
///
///     [share > 0: the block's own motion word and F to the point at that share of its straight line]
///     the offset_lines()
///     [unless all of its axes come to it by the rapid that follows: a straight line to where they stand; in G91 by G90 and back]
///
/// and behind each block of the program's own that takes corrections away (NcStep::resets) they stand once more. Points are written to 1e-6 mm
/// or 1e-7 inch, offsets in the unit in force. Line ends are those of the line behind; in Heidenhain's languages lines of ours have a block number and
/// '*' where the program has them, and numbers go up by one where there is no room between two. Without changes the text is the program as it was.
/// @param bytes    the program
/// @param steps    of the same program
/// @param initial  shift in front [m]
/// @param changes  in their order; each where nc_entries() or why_not_divisible() allow it
/// @throws InputError  with the line: absolute, for another work offset than `work_offset` or one other than G54 that is not named before the
///                     first motion (LinuxCNC) and for datum shifts of the program's own (Heidenhain); for inches (Siemens, Heidenhain); and where
///                     lines are put: without a unit before them, with cutter compensation, mirror, rotation or a modal cycle on at the end, for a last
///                     block that cuts, for a block run more than once that takes different corrections away; for a G92 of an axis that nobody has moved
///                     before it, while a correction of it is in force, and for G10 where offsets are absolute (LinuxCNC)
///
/// LinuxCNC: a change at a line that loops or subprograms run more than once stands in an `o if` that counts its runs. Where the program has a G92 or
/// G52 of its own, corrections are added to it by the difference (`G92 Z[#5422-0.0125]`), for lack of another place.
[[nodiscard]] CorrectedNcProgram corrected_nc_program(const std::string& bytes, const std::vector<NcStep>& steps,
                                                      const std::array<double, 3>& initial_m,
                                                      const std::vector<NcOffsetChange>& changes,
                                                      const NcOffsetOptions& options);

}  // namespace driftwright
