#pragma once
// Rows of an MTConnect agent: what it tells now, asked so often, or all that it has observed, row by row of its own time.

#include <deque>
#include <functional>
#include <optional>

#include "follow/heard_values.hpp"
#include "follow/mtconnect_agent.hpp"
#include "follow/row_source.hpp"

namespace driftwright::follow {

using Say = std::function<void(const std::string&)>;  ///< a sentence to whoever runs it

/// In which units an agent's numbers come: by its probe, which is read once, and again where the agent has been started anew.
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

/// `/sample?from=`: a row at the time of each observation of a channel, and one at the agent's present time each time that it is asked. No observation
/// is lost between two questions: the agent keeps them, and says where the next question goes on. What came while it was away comes then. Where it
/// has forgotten some (its buffer is too short for that), or has been started anew (another instanceId), that is said, and what it tells now is taken.
/// An observation that comes behind a row of a later time has a row right behind that one.
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
