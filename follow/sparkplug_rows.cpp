#include "follow/sparkplug_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/config_map.hpp"
#include "base/errors.hpp"

namespace driftwright::follow {
namespace {

constexpr auto kAskAgain = std::chrono::seconds(5);

}  // namespace

void SparkplugRows::ask_for_birth() {
  const auto now = HeardValues::Clock::now();
  if (!link_.is_linked() || now - asked_ < kAskAgain) return;
  asked_ = now;
  (void)link_.publish(node_.rebirth_topic(), SparkplugNode::rebirth_payload());
}

/// Takes over the values in force; throws for a channel whose metric is not in the birth, since it will never come.
void SparkplugRows::hear() {
  const auto& metrics = node_.metrics();
  if (!has_birth_ && node_.is_alive() && !metrics.empty()) {
    std::vector<std::string> known;
    for (const auto& [name, value] : metrics) known.push_back(name);
    for (const ChannelOrigin& c : values_.origins()) {
      if (!metrics.contains(c.from))
        throw InputError(fmt::format("--topic {}={}: the birth has no metric of this name; it has {}.{}", c.header, c.from,
                                     fmt::join(known, ", "), did_you_mean(c.from, known)));
    }
    has_birth_ = true;
  }
  for (const ChannelOrigin& c : values_.origins()) {
    const auto metric = metrics.find(c.from);
    if (metric == metrics.end() || !metric->second)
      values_.forget(c.from);
    else
      values_.hear(c.from, *metric->second);
  }
}

RowSource::Got SparkplugRows::next(std::string& line, double wait_s) {
  if (!has_header_) {
    has_header_ = true;
    line = values_.header();
    return Got::kLine;
  }
  if (link_.n_links() != n_links_) {
    n_links_ = link_.n_links();
    node_.lose_sight();
    asked_ = {};
  }
  if (node_.wants_birth()) ask_for_birth();
  MqttLink::Message message;
  if (link_.next(message, std::min(wait_s, ticks_.until_next_s()))) {
    const std::string why = message.is_cut
                                ? fmt::format("its payload has more than {} bytes, which is the most", kLargestPayload)
                                : node_.take(message.topic, message.payload);
    if (!why.empty() && why != said_) say_(fmt::format("{}: {}", message.topic, why));
    said_ = why;
    if (node_.is_alive() != was_alive_) {
      was_alive_ = node_.is_alive();
      say_(was_alive_ ? "the node is born" : "the node has died; its metrics are missing");
    }
  }
  if (!ticks_.is_due()) return Got::kNothingYet;
  if (link_.is_linked() && !node_.wants_birth()) hear();  // otherwise the last values hold until they are stale
  if (!has_birth_) return Got::kNothingYet;
  line = values_.row(now_s());
  return Got::kLine;
}

}  // namespace driftwright::follow
