#pragma once
// Rows made of single values: what was heard last of each channel, at times that somebody else says.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "follow/stream_row.hpp"

namespace driftwright::follow {

/// A channel and where its numbers come from, as --topic says it: "t01_degC=shop/mill/t01".
struct ChannelOrigin {
  std::string header, from;
  ColumnUnit numbers = {};
};
/// @throws InputError  for text that is none
[[nodiscard]] std::vector<ChannelOrigin> read_origins(const std::vector<std::string>& topics);

class HeardValues {
 public:
  using Clock = std::chrono::steady_clock;
  /// @param stale_s  so long after it was heard a value is missing; infinity: it holds until it is forgotten
  HeardValues(std::vector<ChannelOrigin> origins, double stale_s);

  [[nodiscard]] const std::vector<ChannelOrigin>& origins() const { return origins_; }
  /// Numbers of origin k come in that unit, and are converted to the channel's; "": they are the channel's.
  /// @throws RangeError  where the two are no units of one quantity, or a map multiplies the numbers in another unit
  void set_unit(std::size_t k, const std::string& unit);
  /// A value of all channels that come from there; text that is no number is an unreadable cell.
  void hear(const std::string& from, const std::string& text);
  /// It is missing by now.
  void forget(const std::string& from);
  void forget_all();

  /// Header and row of CSV.
  [[nodiscard]] std::string header() const;
  [[nodiscard]] std::string row(double time_s) const;

 private:
  struct Value {
    std::string cell = {};
    std::optional<Clock::time_point> at = {};
  };
  std::vector<ChannelOrigin> origins_;
  std::vector<Value> values_;       // of each
  std::vector<std::string> units_;  // in which they come; "": that of the channel
  double stale_s_;
};

/// When rows are due that are made so often; of the time in which the computer was asleep none are made up.
class Ticks {
 public:
  explicit Ticks(double every_s) : every_s_(every_s) {}
  [[nodiscard]] double until_next_s() const;
  /// @return whether one is due; the next then is one step later
  [[nodiscard]] bool is_due();

 private:
  double every_s_;
  HeardValues::Clock::time_point due_ = HeardValues::Clock::now();
};

/// By this computer's clock, since 1970.
[[nodiscard]] double now_s();

}  // namespace driftwright::follow
