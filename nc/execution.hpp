#pragma once
// Executes a program of any language block by block: modes, motion, time, and the resulting steps. The readers of the
// languages interpret the words and call it.

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "nc/program.hpp"

namespace driftwright {

/// Largest number of blocks and loop lines that a program may run, in addition to its own lines; more count as an endless
/// loop.
inline constexpr int kMostRuns = 500'000;

/// The running program.
class NcExecution {
 public:
  explicit NcExecution(const NcSettings& settings) : motion(settings.rapid_m_s), settings_(settings) {}

  NcMotion motion;
  double unit_m = 1e-3;            ///< of lengths
  double feed_unit_m = 1e-3;       ///< of F, which may differ (Siemens G70, G71)
  int normal = 2;                  ///< axis across the plane
  bool absolute = true;            ///< G90; false: G91
  bool compensated = false;        ///< cutter radius compensation is on
  bool transformed = false;        ///< mirrored, turned or swivelled
  bool modal_cycle = false;        ///< a cycle is called after each block that moves
  std::optional<int> motion_word;  ///< motion word in force, times ten

  /// Sets the number of lines of the program.
  void expect(std::size_t n_lines) { most_runs_ = kMostRuns + static_cast<int>(n_lines); }
  /// Counts a block or loop line that is run. @throws InputError  beyond kMostRuns plus the program's lines: an endless loop
  void count(const Where& where);
  /// Begins a block. @param deletable  the block begins with '/'
  void begin(const Where& where, bool deletable);
  /// Ends it: sets its times, and which axes are at known positions.
  void end();
  [[nodiscard]] NcStep& step() { return steps_.back(); }
  /// From this block on, earlier numbers mean other positions: another tool, length or zero.
  void forget() { forgets_ = true; }

  [[noreturn]] void fail(const std::string& message) const { throw InputError(motion.where, message); }
  /// A note with its line, once for each `word`.
  void note(const std::string& word, const std::string& message) { note_at(motion.where, word, message); }
  void note_at(const Where& where, const std::string& word, const std::string& message);
  /// After this block the position of the axis is a number that is known for certain.
  void know(int axis) { knows_[axis] = true; }
  [[nodiscard]] bool knows_place(int axis) const { return known_[axis]; }
  /// Handles an unknown M word: kept in the program, no time, one note.
  void pass_over(const std::string& word);

  /// Sets F, in the unit of the feed mode.
  void set_feed(double f);
  void set_feed_mode(NcFeedMode mode);
  void change_tool(const std::string& word);
  void halt(const std::string& word);

  /// By how much a coordinate as it is written may be off [m]: half of the last of the decimals that posts write at least,
  /// two of a millimetre or three of an inch.
  [[nodiscard]] double rounding_m() const { return unit_m > 1e-3 ? 0.5e-3 * unit_m : 0.5e-2 * unit_m; }
  /// Straight to a point, as rapid or at the feed.
  void rapid_to(const std::array<double, 3>& target_m) { go(NcStepKind::kRapid, target_m); }
  void feed_to(const std::array<double, 3>& target_m) { go(NcStepKind::kLine, target_m); }
  /// @throws InputError  for an impossible arc
  void arc_to(const std::array<double, 3>& target_m, const std::array<double, 3>& centre_m, bool clockwise, int turns);
  /// Centre [m] of an arc of that radius, see arc_centre().
  [[nodiscard]] std::array<double, 3> centre_of(const std::array<double, 3>& target_m, double radius_m,
                                                bool clockwise) const;
  /// The machine's zero in the coordinates of the program. @throws InputError  if NcSettings lacks it
  [[nodiscard]] const std::array<double, 3>& machine_zero(const std::string& word) const;

  [[nodiscard]] const NcSettings& settings() const { return settings_; }
  [[nodiscard]] NcProgram result(const std::string& path, const NcLanguage& language) &&;

 private:
  void go(NcStepKind kind, const std::array<double, 3>& target_m);

  const NcSettings& settings_;
  int n_runs_ = 0, most_runs_ = kMostRuns;
  double time_s_ = 0.0;
  std::size_t n_timed_ = 0;  // number of moves that time_s_ includes
  bool forgets_ = false;
  std::array<bool, 3> knows_ = {false, false, false};
  std::array<bool, 3> known_ = {false, false, false};
  std::vector<NcStep> steps_;
  std::vector<std::size_t> first_move_;  // index of each step's first move
  std::set<std::string> noted_;
  std::vector<std::string> notes_;
};

}  // namespace driftwright
