#include "follow/agent_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "base/config_map.hpp"
#include "base/errors.hpp"

namespace driftwright::follow {
namespace {

constexpr double kLongestAnswer_s = 2.0;
// Most that an observation's time may be after the agent's own time; the clocks of its adapters differ by less.
constexpr double kClockAhead_s = 60.0;
constexpr int kProbeTries = 3;
constexpr int kMostAnswers = 100;  // to one question, before rows are handed on

void require_items(const HeardValues& values, const MtconnectStreams& told) {
  std::vector<std::string> known;
  for (const Observation& o : told.observations) {
    known.push_back(o.id);
    if (!o.name.empty()) known.push_back(o.name);
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  for (const ChannelOrigin& c : values.origins()) {
    std::set<std::string> ids;
    for (const Observation& o : told.observations) {
      if (o.id == c.from || o.name == c.from) ids.insert(o.id);
    }
    if (ids.size() > 1)
      throw InputError(fmt::format("--topic {}={}: several data items have that name, {}; say which by its id", c.header,
                                   c.from, fmt::join(ids, ", ")));
    if (!std::binary_search(known.begin(), known.end(), c.from))
      throw InputError(fmt::format("--topic {}={}: the agent has no data item of this id or name; it has {}.{}", c.header,
                                   c.from, fmt::join(known, ", "), did_you_mean(c.from, known)));
  }
}

/// "Xfrt (AxisFeedrate)".
std::string words_of(const ChannelOrigin& c, const Observation& o) {
  return fmt::format("{} ({})", c.from, o.type);
}

/// In which unit the numbers of each channel come: as the probe says, else as the standard does for the type. What is not
/// the agent's own word is said.
/// @throws InputError  where an item's unit is not one of its channel's quantity
void set_units(HeardValues& values, const MtconnectProbe& probe, const MtconnectStreams& told, const Say& say) {
  std::vector<std::string> standard, unknown;
  for (std::size_t k = 0; k < values.origins().size(); ++k) {
    const ChannelOrigin& c = values.origins()[k];
    const auto o = std::find_if(told.observations.begin(), told.observations.end(),
                                [&](const Observation& at) { return at.id == c.from || at.name == c.from; });
    if (o == told.observations.end()) continue;  // since the agent was started anew: it is missing until it is there again
    const auto item =
        std::find_if(probe.items.begin(), probe.items.end(), [&](const DataItem& at) { return at.id == o->id; });
    const bool has_units = item != probe.items.end() && !item->units.empty();
    const std::string units = has_units ? item->units : standard_units(o->type, o->sub_type);
    if (units.empty())
      unknown.push_back(fmt::format("{} in {}", words_of(c, *o), c.numbers.unit));
    else if (!has_units)
      standard.push_back(fmt::format("{} in {}", words_of(c, *o), units));
    if (units.empty()) continue;
    try {
      values.set_unit(k, unit_of_mtconnect(units));
    } catch (const RangeError& e) {
      throw InputError(
          fmt::format("--topic {}={}: the numbers of this data item are in {} ({}) and must "
                      "convert to the channel's unit '{}': {}",
                      c.header, c.from, units, has_units ? "by its probe" : "by the standard", c.numbers.unit, e.what()));
    }
  }
  const std::string why =
      probe.why_none.empty() ? "its probe gives no units for them" : fmt::format("it gives no probe ({})", probe.why_none);
  if (!standard.empty()) say(fmt::format("{}, so the standard's units are taken: {}", why, fmt::join(standard, ", ")));
  if (!unknown.empty())
    say(fmt::format("{}, and the standard has none for their types; their numbers are taken in the channels' units: {}", why,
                    fmt::join(unknown, ", ")));
}

/// @param is_former  the observation was made before anybody asked
void hear_in(HeardValues& values, const Observation& o, bool is_former) {
  for (const std::string& from : {o.id, o.name}) {
    if (from.empty()) continue;
    if (o.value.empty())
      values.forget(from);  // UNAVAILABLE
    else if (is_former)
      values.hear_former(from, o.value, o.sequence);
    else
      values.hear(from, o.value, o.sequence);
  }
}

double in_milliseconds(double time_s) {
  return std::round(1e3 * time_s) / 1e3;  // as a row writes it
}

void wait_for(double seconds) {
  const timespec time{.tv_sec = static_cast<time_t>(seconds),
                      .tv_nsec = static_cast<long>(1e9 * (seconds - std::floor(seconds)))};
  (void)nanosleep(&time, nullptr);  // a signal ends the wait
}

}  // namespace

void ItemUnits::learn(HeardValues& values, MtconnectAgent& agent, const MtconnectStreams& told, const Say& say) {
  if (instance_ == told.instance) return;
  MtconnectProbe probe;
  try {
    probe = agent.probe(kLongestAnswer_s);
  } catch (const RangeError& e) {
    if (++n_failed_ < kProbeTries) throw;
    probe.why_none = e.what();
  }
  n_failed_ = 0;
  set_units(values, probe, told, say);
  instance_ = told.instance;
}

CurrentRows::CurrentRows(const std::string& url, HeardValues values, double every_s, Say say)
    : agent_(url), values_(std::move(values)), every_s_(every_s), ticks_(every_s), say_(std::move(say)) {}

RowSource::Got CurrentRows::next(std::string& line, double wait_s) {
  if (!has_header_) {
    has_header_ = true;
    line = values_.header();
    return Got::kLine;
  }
  wait_for(std::min(wait_s, ticks_.until_next_s()));
  if (!ticks_.is_due()) return Got::kNothingYet;
  try {
    const MtconnectStreams told = agent_.current(std::min(every_s_, kLongestAnswer_s));
    if (!has_answered_) require_items(values_, told);
    units_.learn(values_, agent_, told, say_);
    values_.forget_all();
    for (const Observation& o : told.observations) hear_in(values_, o, !has_answered_);
    if (is_away_) say_("answers again");
    has_answered_ = true;
    is_away_ = false;
  } catch (const RangeError& e) {
    if (!is_away_) say_(fmt::format("{}; `follow` asks it again every {:g} s", e.what(), every_s_));
    is_away_ = true;
  }
  if (!has_answered_) return Got::kNothingYet;
  line = values_.row(now_s());
  return Got::kLine;
}

SampleRows::SampleRows(const std::string& url, HeardValues values, double every_s, Say say)
    : agent_(url), values_(std::move(values)), every_s_(every_s), ticks_(every_s), say_(std::move(say)) {}

RowSource::Got SampleRows::next(std::string& line, double wait_s) {
  if (!has_header_) {
    has_header_ = true;
    line = values_.header();
    return Got::kLine;
  }
  if (rows_.empty()) {
    wait_for(std::min(wait_s, ticks_.until_next_s()));
    if (ticks_.is_due()) ask();
  }
  if (rows_.empty()) return Got::kNothingYet;
  line = std::move(rows_.front());
  rows_.pop_front();
  return Got::kLine;
}

void SampleRows::ask() {
  try {
    const double most_s = std::max(every_s_, kLongestAnswer_s);
    if (!instance_) begin(agent_.current(most_s));
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + std::chrono::duration<double>(most_s);  // the rest follows with the next request
    for (int answers = 0; answers < kMostAnswers && Clock::now() < until; ++answers) {
      const MtconnectStreams streams = agent_.sample(next_, most_s);
      if (!streams.instance.empty() && streams.instance != *instance_) {
        say_(fmt::format("it has been started anew (instanceId {} in place of {}); its observations begin anew",
                         streams.instance, *instance_));
        begin(agent_.current(most_s));
        continue;
      }
      if (streams.is_out_of_range) {
        say_(
            fmt::format("it no longer has the observations from number {} on, because its buffer is too short; its latest "
                        "ones are taken instead",
                        next_));
        begin(agent_.current(most_s));
        continue;
      }
      if (streams.next < next_ || (streams.next == next_ && next_ <= streams.last) || streams.next == 0)
        throw RangeError(
            fmt::format("its answer does not continue after observation {} (nextSequence {})", next_, streams.next));
      take(streams);
      if (next_ > streams.last) break;
    }
    if (is_away_) say_("answers again");
    is_away_ = false;
  } catch (const RangeError& e) {
    if (!is_away_)
      say_(fmt::format("{}; `follow` asks it again every {:g} s, for all that it observes meanwhile", e.what(), every_s_));
    is_away_ = true;
  }
}

void SampleRows::begin(const MtconnectStreams& now) {
  if (!instance_) require_items(values_, now);
  units_.learn(values_, agent_, now, say_);
  instance_ = now.instance;
  next_ = now.next;
  values_.forget_all();
  for (const Observation& o : now.observations) hear_in(values_, o, true);
  last_s_ = in_milliseconds(now.created_s);
  rows_.push_back(values_.row(last_s_));
}

/// Observations of one time make one row. A late row gets the last time plus a millisecond; channels that are not
/// followed make none.
void SampleRows::take(const MtconnectStreams& streams) {
  std::vector<Observation> list;
  for (const Observation& o : streams.observations) {
    const bool is_followed = std::any_of(values_.origins().begin(), values_.origins().end(),
                                         [&](const ChannelOrigin& c) { return c.from == o.id || c.from == o.name; });
    if (is_followed) list.push_back(o);
  }
  for (Observation& o : list) {
    if (streams.created_s > 0.0 && o.time_s > streams.created_s + kClockAhead_s) o.time_s = streams.created_s;
  }
  if (streams.created_s > 0.0 &&
      streams.created_s < last_s_ - kClockAhead_s) {  // the agent's clock was set back: rows continue before its new times
    last_s_ = streams.created_s;
    for (const Observation& o : list) last_s_ = std::min(last_s_, o.time_s);
    last_s_ -= 1e-3;
  }
  std::sort(list.begin(), list.end(), [](const Observation& a, const Observation& b) { return a.sequence < b.sequence; });
  for (std::size_t i = 0; i < list.size(); ++i) {
    hear_in(values_, list[i], false);
    const bool is_last_of_time = i + 1 == list.size() || list[i + 1].time_s != list[i].time_s;
    if (!is_last_of_time) continue;
    last_s_ = std::max(in_milliseconds(list[i].time_s), in_milliseconds(last_s_ + 1e-3));
    rows_.push_back(values_.row(last_s_));
  }
  next_ = streams.next;
  if (next_ > streams.last && in_milliseconds(streams.created_s) > last_s_) {
    last_s_ = in_milliseconds(streams.created_s);
    rows_.push_back(values_.row(last_s_));
  }
}

}  // namespace driftwright::follow
