#pragma once
// Rows from an MTConnect agent: its current values, read at an interval, or all of its observations, with the agent's own
// times.

#include <deque>
#include <functional>
#include <optional>

#include "follow/heard_values.hpp"
#include "follow/mtconnect_agent.hpp"
#include "follow/row_source.hpp"

namespace driftwright::follow {

using Say = std::function<void(const std::string&)>;  ///< prints a sentence for the user

/// In which units an agent's numbers come: by its probe, which is read once, and again where the agent has been started
/// anew.
class ItemUnits {
 public:
  /// Where it gives none after three questions, the standard's units are taken, which is said.
  /// @throws RangeError  where it has not answered, and is to be asked again
  /// @throws InputError  for an item whose unit is not one of its channel's quantity
  void learn(HeardValues& values, MtconnectAgent& agent, const MtconnectStreams& told, const Say& say);

 private:
  std::optional<std::string> instance_;  // whose units are known
  int n_failed_ = 0;
};

/// `/current`, by this computer's clock. While the agent does not answer, what it said last holds until it is stale.
class CurrentRows final : public RowSource {
 public:
  CurrentRows(const std::string& url, HeardValues values, double every_s, Say say);
  /// @throws InputError  for an item that the agent does not have, or whose unit is not one of its channel's quantity
  [[nodiscard]] Got next(std::string& line, double wait_s) override;

 private:
  MtconnectAgent agent_;
  HeardValues values_;
  double every_s_;
  Ticks ticks_;
  Say say_;
  ItemUnits units_;
  bool has_header_ = false, has_answered_ = false, is_away_ = false;
};

/// Rows of `/sample?from=`: one at the time of each observation of a channel, and one at the agent's present time for
/// each request. No observation is lost between two requests: the agent buffers them and says where the next request
/// continues, also after the agent was unreachable. If the agent no longer has some of them (its buffer is too short), or
/// was restarted (another instanceId), a message says so and the current values are taken instead. An observation that
/// arrives after a row of a later time gets a row directly after that one.
class SampleRows final : public RowSource {
 public:
  SampleRows(const std::string& url, HeardValues values, double every_s, Say say);
  [[nodiscard]] Got next(std::string& line, double wait_s) override;

 private:
  void ask();
  void begin(const MtconnectStreams& now);
  void take(const MtconnectStreams& streams);

  MtconnectAgent agent_;
  HeardValues values_;
  double every_s_;
  Ticks ticks_;
  Say say_;
  std::deque<std::string> rows_;
  ItemUnits units_;
  std::optional<std::string> instance_;
  std::uint64_t next_ = 0;
  double last_s_ = 0.0;  // time of the last row
  bool has_header_ = false, is_away_ = false;
};

}  // namespace driftwright::follow
