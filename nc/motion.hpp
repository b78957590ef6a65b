#pragma once
// The state of the machine that an NC program drives: positions of its axes, its spindle, and the duration of each move. All
// speeds are as programmed; nc/planned_motion.hpp computes the times of real motion from the recorded path. Overrides are
// not modelled.

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "base/errors.hpp"
#include "nc/planned_motion.hpp"

namespace driftwright {

/// One piece of a program with one spindle speed: a line, an arc or a standstill of the axes.
struct NcMove {
  double duration_s = 0.0;
  double speed_rpm = 0.0;                      ///< of the spindle in either sense, >= 0
  std::array<double, 3> travel_m = {0, 0, 0};  ///< integral of |velocity| of x, y, z
  bool cutting = false;                        ///< a feed move while the spindle turns
};

/// What moves ask of the machine.
struct NcDemand {
  double speed_rpm = 0.0;  ///< highest of the spindle
  double feed_m_s = 0.0;   ///< highest programmed feed along the path; rapids do not count
  /// Lowest and highest position, in the work offset that the program starts in: shifts of the origin by the program do not
  /// count. low > high: the axis is not commanded.
  std::array<double, 3> low_m = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity()};
  std::array<double, 3> high_m = {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()};

  void take_position(int axis, double x_m);
};

enum class NcFeedMode { PerMinute, InverseTime, PerRevolution };

/// Executes moves and records them.
class NcMotion {
 public:
  explicit NcMotion(std::optional<double> rapid_m_s) : rapid_m_s_(rapid_m_s) {}

  Where where;  ///< of the current block, for messages
  std::array<double, 3> position_m = {0, 0, 0};
  NcFeedMode feed_mode = NcFeedMode::PerMinute;
  double feed = 0.0;  ///< [m/s], [1/s] (moves per second) or [m/rev], by the mode; 0: none
  double programmed_rpm = 0.0;
  bool turning = false;

  [[nodiscard]] double speed_rpm() const { return turning ? programmed_rpm : 0.0; }

  /// The present position with another coordinate along the normal of the plane.
  [[nodiscard]] std::array<double, 3> at_level(int normal, double level_m) const {
    std::array<double, 3> target_m = position_m;
    target_m[normal] = level_m;
    return target_m;
  }

  /// A straight line at rapid speed. @throws InputError  without a rapid speed
  void rapid_to(const std::array<double, 3>& target_m);
  /// A straight line at the feed. @throws InputError  without a feed, or per revolution of a spindle at rest
  void feed_to(const std::array<double, 3>& target_m);
  /// An arc at the feed (see nc/arc.hpp). @throws InputError  as feed_to, and for an impossible arc
  void arc_to(const std::array<double, 3>& target_m, const std::array<double, 3>& centre_m, int normal, bool clockwise,
              int turns, double rounding_m);
  void wait(double duration_s);

  /// Of the moves since it was last reset, which is done at each block. An axis that does not move is not in it.
  NcDemand demand;
  /// Position of an axis as in NcDemand.
  [[nodiscard]] double reached_m(int axis) const { return last_m_[axis] - shift_m_[axis]; }

  /// How far corners may be rounded from here on: < 0 as far as speed requires (G64), 0 not at all (G61), else the tolerance
  /// (G64 P).
  double blend_m = -1.0;
  /// The axes stop before what comes next: a spindle, a tool or an offset waits for them.
  void stop();

  [[nodiscard]] const std::vector<NcMove>& moves() const { return moves_; }
  /// The path of each move.
  [[nodiscard]] const std::vector<PathPiece>& path() const { return path_; }

 private:
  /// Notes by how much the origin has been shifted since the last move.
  void begin_move();
  /// Ends a move. Adds the position of the axes that have travelled to the demand.
  void end_move(const std::array<double, 3>& target_m, const std::array<double, 3>& travel_m);
  void feed_along(double length_m, const std::array<double, 3>& travel_m, PathPiece piece);
  void note(const NcMove& move, PathPiece piece);
  std::optional<double> rapid_m_s_;
  std::array<double, 3> last_m_ = {0, 0, 0};   // position at the end of the last move
  std::array<double, 3> shift_m_ = {0, 0, 0};  // of the origin
  std::vector<NcMove> moves_;
  std::vector<PathPiece> path_;
};

}  // namespace driftwright
