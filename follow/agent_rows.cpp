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
// Of an observation before the agent's own time: no more than clocks of its adapters differ.
constexpr double kClockAhead_s = 60.0;
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

void hear_in(HeardValues& values, const Observation& o) {
  for (const std::string& from : {o.id, o.name}) {
    if (from.empty()) continue;
    if (o.value.empty())
      values.forget(from);  // UNAVAILABLE
    else
      values.hear(from, o.value);
  }
}

double in_milliseconds(double time_s) {
  return std::round(1e3 * time_s) / 1e3;  // as a row writes it
}

void wait_for(double seconds) {
  const timespec time{.tv_sec = static_cast<time_t>(seconds),
                      .tv_nsec = static_cast<long>(1e9 * (seconds - std::floor(seconds)))};
  (void)nanosleep(&time, nullptr);  // a signal ends it
}

}  // namespace

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
    values_.forget_all();
    for (const Observation& o : told.observations) hear_in(values_, o);
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
    const auto until = Clock::now() + std::chrono::duration<double>(most_s);  // the rest at the next question
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
  instance_ = now.instance;
  next_ = now.next;
  values_.forget_all();
  for (const Observation& o : now.observations) hear_in(values_, o);
  last_s_ = in_milliseconds(now.created_s);
  rows_.push_back(values_.row(last_s_));
}

/// Observations of one time make one row, a millisecond after the last one if they come late; those of channels that nobody follows make none.
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
      streams.created_s < last_s_ - kClockAhead_s) {  // its clock was set: rows go on in front of all that is told by it
    last_s_ = streams.created_s;
    for (const Observation& o : list) last_s_ = std::min(last_s_, o.time_s);
    last_s_ -= 1e-3;
  }
  std::sort(list.begin(), list.end(), [](const Observation& a, const Observation& b) { return a.sequence < b.sequence; });
  for (std::size_t i = 0; i < list.size(); ++i) {
    hear_in(values_, list[i]);
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
