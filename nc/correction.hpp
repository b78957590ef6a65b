#pragma once
// Writes corrections into an NC program as offsets. The lines of the original program stay unchanged, byte by byte.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "nc/language.hpp"
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

/// Writes changes of the offset into a program. The lines that set the corrections of `axes` (after
/// NcLanguage::guard_lines()) are inserted before its first motion and before any G41 or G42; the lines that remove them are
/// inserted before its end. Each change is
///
///     [share > 0: the block's own motion word and F to the point at that share of its straight line]
///     NcLanguage::offset_lines()
///     [unless the rapid that follows moves all of its axes: a straight line to their present position; in G91 by G90 and
///     back]
///
/// These lines are repeated after each block of the program that removes corrections (NcStep::resets). Points are written to
/// 1e-6 mm or 1e-7 inch, offsets in the unit in force. An inserted line has the line ending of the line after it, and the
/// block number and end of NcLanguage::block_form() where the program has them; later numbers are increased where there is
/// no free number between two lines. A change at a line that runs several times, in a loop or subprogram, applies to one run
/// (NcLanguage::run_counter()). Without changes the text is the original program.
/// @param bytes    the program
/// @param steps    of the same program
/// @param initial_m  correction in force from the beginning [m]
/// @param changes  in their order; each at a place that nc_entries() or why_not_divisible() allow
/// @throws InputError  with the line: for inches, unless the language writes them; for what NcLanguage::check() refuses.
///                     Where lines are inserted also: without a unit before them; with cutter compensation, mirror, rotation
///                     or a modal cycle active at the end; for a last block that cuts; for a block that runs several times
///                     and removes different corrections; for what NcLanguage::check_written() refuses
[[nodiscard]] CorrectedNcProgram corrected_nc_program(const std::string& bytes, const std::vector<NcStep>& steps,
                                                      const std::array<double, 3>& initial_m,
                                                      const std::vector<NcOffsetChange>& changes,
                                                      const NcOffsetOptions& options);

}  // namespace driftwright
