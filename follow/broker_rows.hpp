#pragma once
// Rows of an MQTT broker: messages that are rows, or one number a message, of which rows are made.

#include <deque>

#include "follow/heard_values.hpp"
#include "follow/mqtt_link.hpp"
#include "follow/row_source.hpp"

namespace driftwright::follow {

/// Messages of the link's topic, line by line.
class MessageRows final : public RowSource {
 public:
  explicit MessageRows(MqttLink& link) : link_(link) {}
  [[nodiscard]] Got next(std::string& line, double wait_s) override;

 private:
  MqttLink& link_;
  std::deque<std::string> lines_;
};

/// Rows of the last number of each topic, so often, by this computer's clock.
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
