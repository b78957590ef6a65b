#pragma once
// Writes corrections into an NC program as offsets. The lines of the original program stay unchanged, byte by byte.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "nc/offset_lines.hpp"
#include "nc/step.hpp"

namespace driftwright {

/// A change of the offset: before the block `step`, or at a share of its path (the block is then divided).
struct NcOffsetChange {
  std::size_t step = 0;
  double share = 0.0;                              ///< [0, 1)
  std::array<std::optional<double>, 3> shift_m{};  ///< new correction for each axis that changes
};

/// The corrected program.
struct CorrectedNcProgram {
  std::string text;
  std::vector<int> lines;               ///< line of each change's first offset word in `text`, from one
  std::vector<std::string> notes = {};  ///< what runs without corrections, with its line
};

/// Writes changes of the offset into a program. The lines that set the corrections of `axes` (with LinuxCNC's guard_lines())
/// are inserted before its first motion and before any G41 or G42; the lines that remove them are inserted before its end.
/// Each change is
///
///     [share > 0: the block's own motion word and F to the point at that share of its straight line]
///     the offset_lines()
///     [unless the rapid that follows moves all of its axes: a straight line to their present position; in G91 by G90 and
///     back]
///
/// These lines are repeated after each block of the program that removes corrections (NcStep::resets). Points are written to
/// 1e-6 mm or 1e-7 inch, offsets in the unit in force. An inserted line has the line ending of the line after it. In
/// Heidenhain's languages, inserted lines have a block number and '*' where the program has them; later numbers are
/// increased where there is no free number between two lines. Without changes the text is the original program.
/// @param bytes    the program
/// @param steps    of the same program
/// @param initial_m  correction in force from the beginning [m]
/// @param changes  in their order; each at a place that nc_entries() or why_not_divisible() allow
/// @throws InputError  with the line. With absolute offsets: for a work offset other than `work_offset`, or one other than
///                     G54 that the program does not name before the first motion (LinuxCNC), and for datum shifts of the
///                     program (Heidenhain). For inches (Siemens, Heidenhain). Where lines are inserted: without a unit
///                     before them; with cutter compensation, mirror, rotation or a modal cycle active at the end; for a
///                     last block that cuts; for a block that runs several times and removes different corrections; for a
///                     G92 of an axis that has not moved before while it has a correction, and for G10 with absolute offsets
///                     (LinuxCNC)
///
/// LinuxCNC: a change at a line that runs several times, in a loop or subprogram, is put into an `o if` that counts the
/// runs. If the program itself uses G92 or G52, corrections are added to it by their difference (`G92 Z[#5422-0.0125]`),
/// because no other offset is free.
[[nodiscard]] CorrectedNcProgram corrected_nc_program(const std::string& bytes, const std::vector<NcStep>& steps,
                                                      const std::array<double, 3>& initial_m,
                                                      const std::vector<NcOffsetChange>& changes,
                                                      const NcOffsetOptions& options);

}  // namespace driftwright
