#pragma once
// The pulse injector with time: edges with time stamps in and out, never closer together than the control can count, and no
// more insertions than the axis may follow.

#include <cstdint>
#include <limits>
#include <vector>

#include "compensation/injector/pulse_injector.hpp"

namespace driftwright::compensation {

/// The lines from a time on. The caller chooses the unit of time: nanoseconds, or rows of a sampled signal.
struct Edge {
  std::int64_t t = 0;
  Lines lines = 0;

  friend bool operator==(const Edge&, const Edge&) = default;
};

/// The rules and limits, in the caller's unit of time.
struct InsertionLimits {
  InsertionRules rules = {};
  std::int64_t separation = 1;          ///< smallest time between two edges of the output, >= 1
  std::int64_t insertion_interval = 1;  ///< smallest time between the starts of two insertions, >= 1

  /// Time that an insertion needs between two edges of the encoder, including the separation on both sides.
  [[nodiscard]] std::int64_t room() const { return (rules.quarters + 1) * separation; }
};

/// Result of next_event() if nothing will happen.
inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// Follows encoder + insertions and makes one legal step at a time.
///
/// An insertion begins while the encoder's lines are both low (or at any time, by the rules), when none of the encoder's own
/// steps wait, and when there is room. There is room if the next edge is at least room() away, assuming the same interval as
/// between the last two edges, or if it is overdue (the axis has become slower, or rests). An edge that comes earlier than
/// expected waits until the insertion is complete; so do edges that come faster than the separation. Waiting steps are a
/// number, not a queue: a reversal cancels them, memory does not grow, and none is lost however fast the encoder runs.
///
/// At any moment: count of the output = encoder().count() + inserted() - waiting().
class TimedInjector {
 public:
  /// @throws RangeError  when a limit is below 1, or the rules are wrong as in PulseInjector
  explicit TimedInjector(const InsertionLimits& limits);

  /// Total quarter steps to be inserted from `t` on. Times must not decrease from call to call.
  void set_target(std::int64_t t, std::int64_t quarters, std::vector<Edge>& out);
  /// The encoder's lines from edge.t on; appends the edges of the output up to then.
  void input(const Edge& edge, std::vector<Edge>& out);
  /// Appends the edges of the output up to and including `t`.
  void advance(std::int64_t t, std::vector<Edge>& out);
  /// Stops all insertions from now on; steps already inserted remain. Used for a fault that other code has detected
  /// (direction_watch).
  void freeze() { frozen_ = true; }

  /// Time of the next change of the output if the encoder rests, or kNever.
  [[nodiscard]] std::int64_t next_event() const;
  [[nodiscard]] std::int64_t inserted() const {
    return inserted_;
  }  ///< quarter steps; an insertion under way counts in full
  [[nodiscard]] std::int64_t waiting() const { return burst_ + held_; }  ///< quarter steps that the output has not made yet
  [[nodiscard]] std::int64_t n_insertions() const { return n_insertions_; }
  [[nodiscard]] const EncoderReader& encoder() const { return encoder_; }
  /// Steps of the encoder faster than the separation: in the direction of the previous one, and back again (glitches).
  [[nodiscard]] std::int64_t n_too_fast() const { return n_too_fast_; }
  [[nodiscard]] std::int64_t n_glitches() const { return n_glitches_; }
  [[nodiscard]] std::int64_t longest_wait() const { return longest_wait_; }  ///< of a step of the encoder

 private:
  [[nodiscard]] std::int64_t next_step() const;       // when a waiting step can be made
  [[nodiscard]] std::int64_t next_insertion() const;  // when an insertion can begin
  void make_step(std::int64_t t, std::vector<Edge>& out);

  InsertionLimits limits_;
  EncoderReader encoder_;
  std::int64_t clock_ = std::numeric_limits<std::int64_t>::min() / 4;  // everything up to this time is done
  std::int64_t edge_t_ = clock_, edge_interval_ = 0;                   // of the encoder's last step
  int edge_direction_ = 0;
  std::int64_t last_out_ = clock_, last_insertion_ = clock_;
  std::int64_t ready_ = clock_;       // time at which the waiting steps arose
  std::int64_t held_since_ = kNever;  // since when steps of the encoder itself wait
  std::int64_t target_ = 0, inserted_ = 0;
  std::int64_t burst_ = 0, held_ = 0;  // quarter steps not made yet: of an insertion, of the encoder
  std::int64_t out_phase_ = 0;
  bool frozen_ = false;
  std::int64_t n_insertions_ = 0, n_too_fast_ = 0, n_glitches_ = 0, longest_wait_ = 0;
};

/// Largest speed of the axis [um/s] at which an insertion fits between two edges of an encoder: quarter_um / ((quarters + 1)
/// separation). At higher speeds edges of the encoder would have to wait, so nothing is inserted.
/// @param separation_s  smallest time between two edges
[[nodiscard]] double largest_feed_um_s(double quarter_um, int quarters, double separation_s);

/// Rate of correction [um/s] that is possible at a constant feed: as many insertions in each low window as fit, limited by
/// the slew. Zero above largest_feed_um_s().
/// @param feed_um_s  > 0
/// @param slew_um_s  largest of the axis
[[nodiscard]] double insertion_rate_um_s(double feed_um_s, double quarter_um, int quarters, double separation_s,
                                         double slew_um_s);

}  // namespace driftwright::compensation
