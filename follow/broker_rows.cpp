#include "follow/broker_rows.hpp"

#include <algorithm>

namespace driftwright::follow {

RowSource::Got MessageRows::next(std::string& line, double wait_s) {
  MqttLink::Message message;
  if (lines_.empty() && link_.next(message, wait_s)) {
    if (message.is_cut) {  // not a row, though some of its lines may look like one
      line = std::move(message.payload);
      return Got::kLine;
    }
    for (std::size_t begin = 0; begin < message.payload.size();) {
      const std::size_t end = std::min(message.payload.find('\n', begin), message.payload.size());
      lines_.push_back(message.payload.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  if (lines_.empty()) return Got::kNothingYet;
  line = std::move(lines_.front());
  lines_.pop_front();
  return Got::kLine;
}

RowSource::Got TopicRows::next(std::string& line, double wait_s) {
  if (!has_header_) {
    has_header_ = true;
    line = values_.header();
    return Got::kLine;
  }
  MqttLink::Message message;
  if (link_.next(message, std::min(wait_s, ticks_.until_next_s())))
    values_.hear(message.topic, message.is_cut ? "too large for a number" : message.payload);
  if (!ticks_.is_due()) return Got::kNothingYet;
  line = values_.row(now_s());
  return Got::kLine;
}

}  // namespace driftwright::follow
