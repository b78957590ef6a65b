#pragma once
// The pulse injector in time: edges with time stamps in and out, never closer than the control can count, and no more
// insertions than the axis may be moved by.

#include <cstdint>
#include <limits>
#include <vector>

#include "compensation/injector/pulse_injector.hpp"

namespace driftwright::compensation {

/// The lines from a time on. The unit of time is the caller's: nanoseconds, or rows of a sampled signal.
struct Edge {
  std::int64_t t = 0;
  Lines lines = 0;

  friend bool operator==(const Edge&, const Edge&) = default;
};

struct InsertionLimits {
  InsertionRules rules = {};
  std::int64_t separation = 1;          ///< least time between two edges of the output, >= 1
  std::int64_t insertion_interval = 1;  ///< least time between the beginnings of two insertions, >= 1

  /// Time that an insertion takes between two edges of the encoder, with the separation kept on both sides.
  [[nodiscard]] std::int64_t room() const { return (rules.quarters + 1) * separation; }
};

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// A follower of encoder + insertions that makes one legal step at a time.
///
/// An insertion begins while the encoder's lines are both low (or anywhere, by the rules), when none of the encoder's own steps
/// wait, and when there is room: the next edge, expected as long after the last one as that came after the one before, is at least
/// room() away, or has failed to come (the axis has become slower, or stands). An edge that comes earlier than expected waits until
/// the insertion is complete; so do edges that come faster than the separation. Waiting steps are a number, not a queue: a reversal
/// takes them back, memory does not grow, and none is lost however fast the encoder runs.
///
/// What holds at any moment: count of the output = encoder().count() + inserted() - waiting().
class TimedInjector {
 public:
  /// @throws RangeError  when a limit is below 1, or the rules are wrong as in PulseInjector
  explicit TimedInjector(const InsertionLimits& limits);

  /// Quarter steps that shall have been inserted, from `t` on. Times of all calls may not fall.
  void set_target(std::int64_t t, std::int64_t quarters, std::vector<Edge>& out);
  /// The encoder's lines from edge.t on; appends the edges of the output up to then.
  void input(const Edge& edge, std::vector<Edge>& out);
  /// Appends the edges of the output up to and including `t`.
  void advance(std::int64_t t, std::vector<Edge>& out);
  /// No insertion from now on: what is in stays in. For a fault that others have found (direction_watch).
  void freeze() { frozen_ = true; }

  /// When the output will change next if the encoder rests, or kNever.
  [[nodiscard]] std::int64_t next_event() const;
  [[nodiscard]] std::int64_t inserted() const { return inserted_; }      ///< quarter steps, begun insertions count in full
  [[nodiscard]] std::int64_t waiting() const { return burst_ + held_; }  ///< quarter steps that the output has yet to make
  [[nodiscard]] std::int64_t n_insertions() const { return n_insertions_; }
  [[nodiscard]] const EncoderReader& encoder() const { return encoder_; }
  /// Steps of the encoder that came faster than the separation, the same way as the last, and back again (glitches).
  [[nodiscard]] std::int64_t n_too_fast() const { return n_too_fast_; }
  [[nodiscard]] std::int64_t n_glitches() const { return n_glitches_; }
  [[nodiscard]] std::int64_t longest_wait() const { return longest_wait_; }  ///< of a step of the encoder

 private:
  [[nodiscard]] std::int64_t next_step() const;       // when a waiting step may be made
  [[nodiscard]] std::int64_t next_insertion() const;  // when one may begin
  void make_step(std::int64_t t, std::vector<Edge>& out);

  InsertionLimits limits_;
  EncoderReader encoder_;
  std::int64_t clock_ = std::numeric_limits<std::int64_t>::min() / 4;  // everything up to here is done
  std::int64_t edge_t_ = clock_, edge_interval_ = 0;                   // of the encoder's last step
  int edge_direction_ = 0;
  std::int64_t last_out_ = clock_, last_insertion_ = clock_;
  std::int64_t ready_ = clock_;       // when the waiting steps arose
  std::int64_t held_since_ = kNever;  // the encoder's own
  std::int64_t target_ = 0, inserted_ = 0;
  std::int64_t burst_ = 0, held_ = 0;  // quarter steps yet to be made: of an insertion, of the encoder
  std::int64_t out_phase_ = 0;
  bool frozen_ = false;
  std::int64_t n_insertions_ = 0, n_too_fast_ = 0, n_glitches_ = 0, longest_wait_ = 0;
};

/// Speed of the axis [um/s] up to which an insertion finds room between two edges of an encoder: quarter_um / ((quarters + 1)
/// separation). Faster, edges of the encoder would have to wait, so nothing is inserted.
/// @param separation_s  least time between two edges
[[nodiscard]] double largest_feed_um_s(double quarter_um, int quarters, double separation_s);

/// Correction [um/s] that can be brought in at a steady feed: as many insertions in each low window as find room, no more than the
/// slew allows. Zero above largest_feed_um_s().
/// @param feed_um_s  > 0
/// @param slew_um_s  largest of the axis
[[nodiscard]] double insertion_rate_um_s(double feed_um_s, double quarter_um, int quarters, double separation_s,
                                         double slew_um_s);

}  // namespace driftwright::compensation
