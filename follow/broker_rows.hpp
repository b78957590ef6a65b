#pragma once
// Rows from an MQTT broker: messages that are rows themselves, or rows made of messages with one number each.

#include <deque>

#include "follow/heard_values.hpp"
#include "follow/mqtt_link.hpp"
#include "follow/row_source.hpp"

namespace driftwright::follow {

/// The lines of the messages of the link's topic.
class MessageRows final : public RowSource {
 public:
  explicit MessageRows(MqttLink& link) : link_(link) {}
  [[nodiscard]] Got next(std::string& line, double wait_s) override;

 private:
  MqttLink& link_;
  std::deque<std::string> lines_;
};

/// Rows of the last number of each topic, at a fixed interval by this computer's clock.
class TopicRows final : public RowSource {
 public:
  TopicRows(MqttLink& link, HeardValues values, double every_s) : link_(link), values_(std::move(values)), ticks_(every_s) {}
  [[nodiscard]] Got next(std::string& line, double wait_s) override;

 private:
  MqttLink& link_;
  HeardValues values_;
  Ticks ticks_;
  bool has_header_ = false;
};

}  // namespace driftwright::follow
