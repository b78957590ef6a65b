#pragma once
// The blocks of an NC program one by one as they are executed: when, from where to where, and in which modes. For those who want to
// put lines between them.

#include <array>
#include <optional>
#include <string>

#include "base/errors.hpp"
#include "nc/motion.hpp"

namespace driftwright {

enum class NcStepKind {
  kNone,      ///< no motion: modes, dwell, tool change
  kRapid,     ///< G0
  kLine,      ///< G1
  kArc,       ///< G2, G3
  kDrilling,  ///< a block of a canned cycle
  kMachine,   ///< G28, G30, G53: to a place that work offsets do not move
};

/// Modes in force before a block.
struct NcModes {
  std::optional<int> motion = {};  ///< motion word times ten, as NcCode
  bool absolute = true;            ///< G90
  bool compensated = false;        ///< G41, G42
  double unit_m = 1e-3;            ///< of lengths as written
  NcFeedMode feed_mode = NcFeedMode::PerMinute;
  bool has_feed = false;

  [[nodiscard]] bool drilling() const { return motion && *motion >= 730 && *motion != 800; }
};

struct NcStep {
  Where where = {};
  int last_line = 0;  ///< of the file, where a block has several; 0: that of `where`
  double start_s = 0.0, end_s = 0.0;
  NcStepKind kind = NcStepKind::kNone;
  std::array<double, 3> start_m = {0, 0, 0}, end_m = {0, 0, 0};  ///< in the coordinates of the program
  std::array<bool, 3> named = {false, false, false};             ///< axes that the block has a word for
  /// Axes that stood, before it, where a word in G90 has put them for certain: not since the start or the last G28, G30, G53, tool
  /// change, tool length, work offset, or block with '/' that names the axis.
  std::array<bool, 3> known = {false, false, false};
  NcModes before = {};
  bool absolute = true;            ///< G90 as the block itself has it
  bool motion_word = false;        ///< it names its motion
  bool deletable = false;          ///< '/' in the first place
  bool plain = false;              ///< no words but N, G0, G1, X, Y, Z, F
  bool compensated = false;        ///< G41, G42 in force after it
  bool unit_word = false;          ///< G20, G21
  bool tool_change = false;        ///< M6
  std::string feed_word = {};      ///< its F as written, or empty
  std::optional<int> system = {};  ///< G54 ... G59.3 where it names one, times ten
  bool ends_program = false;       ///< M2, M30, the last '%'
  bool no_place = false;        ///< no line of ours may stand before it: mirrored, turned or scaled, or run more than once
  int nth_run = 1, n_runs = 1;  ///< of its line, which loops and subprograms run again
  /// Axes whose corrections it takes away, as a datum shift or a work offset of the program's own does on some controls.
  std::array<bool, 3> resets = {false, false, false};
  std::array<std::optional<double>, 3> local_shift_m = {};  ///< of a G52 of the program's own (LinuxCNC)
  std::array<bool, 3> own_shift = {
      false, false, false};  ///< axes of a G52 or G92 of the program's own (LinuxCNC), whose place corrections share
  bool sets_offset = false;  ///< G10 L2, L20 (LinuxCNC)
  bool certain = true;       ///< false: where it ends is known only at the machine (a probe, an offset read from it)

  [[nodiscard]] double duration_s() const { return end_s - start_s; }
};

}  // namespace driftwright
