#pragma once
// Rows made of single values: the last value of each channel, at times that the caller chooses.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "follow/stream_row.hpp"

namespace driftwright::follow {

/// A channel and the source of its numbers, as in --topic: "t01_degC=shop/mill/t01".
struct ChannelOrigin {
  std::string header, from;
  ColumnUnit numbers = {};
};
/// @throws InputError  for text that is not CHANNEL=TOPIC
[[nodiscard]] std::vector<ChannelOrigin> read_origins(const std::vector<std::string>& topics);

/// Keeps the last value of each channel, until it is stale, and writes them as rows. A probing (is_probing() of its channel)
/// is in one row alone.
class HeardValues {
 public:
  using Clock = std::chrono::steady_clock;
  /// @param stale_s  a value is missing when it is older than this; infinity: it holds until it is forgotten
  HeardValues(std::vector<ChannelOrigin> origins, double stale_s);

  [[nodiscard]] const std::vector<ChannelOrigin>& origins() const { return origins_; }
  /// Numbers of origin k come in that unit, and are converted to the channel's; "": they are the channel's.
  /// @throws RangeError  where the two are no units of one quantity, or a map multiplies the numbers in another unit
  void set_unit(std::size_t k, const std::string& unit);
  /// A value of all channels that come from there; text that is no number is an unreadable cell.
  /// @param number  of the observation, by the source; a probing of the number heard last is the same one. 0: none
  void hear(const std::string& from, const std::string& text, std::uint64_t number = 0);
  /// The same for a value that the source had before: no probing of now.
  void hear_former(const std::string& from, const std::string& text, std::uint64_t number = 0);
  /// Makes the value of these channels missing.
  void forget(const std::string& from);
  void forget_all();

  /// Header and row in CSV.
  [[nodiscard]] std::string header() const;
  [[nodiscard]] std::string row(double time_s);

 private:
  struct Value {
    std::string cell = {};
    std::optional<Clock::time_point> at = {};
  };
  void hear(const std::string& from, const std::string& text, std::uint64_t number, bool is_former);
  std::vector<ChannelOrigin> origins_;
  std::vector<Value> values_;       // of each
  std::vector<std::string> units_;  // in which they come; "": that of the channel
  std::vector<bool> is_probing_;
  std::vector<std::uint64_t> numbers_;  // of the last observation
  double stale_s_;
};

/// The times at which rows of a fixed interval are due; rows missed while the computer slept are not made up for.
class Ticks {
 public:
  explicit Ticks(double every_s) : every_s_(every_s) {}
  [[nodiscard]] double until_next_s() const;
  /// @return whether a row is due; if so, the next one is due one step later
  [[nodiscard]] bool is_due();

 private:
  double every_s_;
  HeardValues::Clock::time_point due_ = HeardValues::Clock::now();
};

/// This computer's time [s] since 1970.
[[nodiscard]] double now_s();

}  // namespace driftwright::follow
