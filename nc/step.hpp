#pragma once
// The executed blocks of an NC program: times, start and end positions, and modes. The code that inserts lines between
// blocks uses them.

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
  kMachine,   ///< G28, G30, G53: to a position that does not depend on work offsets
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

/// One executed block.
struct NcStep {
  Where where = {};
  int last_line = 0;  ///< last line of a block with several lines; 0: the line of `where`
  double start_s = 0.0, end_s = 0.0;
  NcStepKind kind = NcStepKind::kNone;
  std::array<double, 3> start_m = {0, 0, 0}, end_m = {0, 0, 0};  ///< in the coordinates of the program
  std::array<bool, 3> named = {false, false, false};             ///< axes that the block has a word for
  /// Axes whose position before the block is certain, because a word in G90 has set it: not since the start or the last G28,
  /// G30, G53, tool change, tool length, work offset, or block with '/' that names the axis.
  std::array<bool, 3> known = {false, false, false};
  NcModes before = {};
  bool absolute = true;            ///< G90 in force for the block itself
  bool motion_word = false;        ///< the block names its motion
  bool deletable = false;          ///< '/' in the first place
  bool plain = false;              ///< no words other than N, G0, G1, X, Y, Z, F
  bool compensated = false;        ///< G41, G42 in force after it
  bool unit_word = false;          ///< G20, G21
  bool tool_change = false;        ///< M6
  bool halts = false;              ///< M0, M1, M60, STOP: waits for the operator
  std::string feed_word = {};      ///< its F as written; empty without F
  std::optional<int> system = {};  ///< G54 ... G59.3 if the block names one, times ten
  bool ends_program = false;       ///< M2, M30, the last '%'
  bool no_place = false;           ///< no line may be inserted before it: mirrored, turned or scaled, or run more than once
  int nth_run = 1, n_runs = 1;     ///< count of the runs of its line, in loops and subprograms
  /// Axes whose corrections the block removes, as a datum shift or a work offset of the program does on some controls.
  std::array<bool, 3> resets = {false, false, false};
  std::array<bool, 3> own_shift = {
      false, false, false};  ///< axes of a G52 or G92 in the program itself (LinuxCNC); corrections share this offset
  bool sets_offset = false;  ///< G10 L2, L20 (LinuxCNC)
  NcDemand demand = {};      ///< speed, feed and positions of the block
  bool certain = true;       ///< false: its end is known only at the machine (a probe, an offset read there)

  [[nodiscard]] double duration_s() const { return end_s - start_s; }
  [[nodiscard]] bool moves() const { return kind != NcStepKind::kNone; }
};

}  // namespace driftwright
