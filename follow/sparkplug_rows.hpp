#pragma once
// Rows of a Sparkplug B node: the last value of each metric, at a fixed interval by this computer's clock.

#include "follow/agent_rows.hpp"
#include "follow/mqtt_link.hpp"
#include "follow/sparkplug_node.hpp"

namespace driftwright::follow {

/// A node reports only changes: a value holds until its node or device dies, or while the broker is away as long as
/// `values` allow.
class SparkplugRows final : public RowSource {
 public:
  SparkplugRows(MqttLink& link, SparkplugNode node, HeardValues values, double every_s, Say say)
      : link_(link), node_(std::move(node)), values_(std::move(values)), ticks_(every_s), say_(std::move(say)) {}
  /// @throws InputError  for a metric that a birth does not have
  [[nodiscard]] Got next(std::string& line, double wait_s) override;

 private:
  void ask_for_birth();
  void hear();

  MqttLink& link_;
  SparkplugNode node_;
  HeardValues values_;
  Ticks ticks_;
  Say say_;
  HeardValues::Clock::time_point asked_ = {};
  int n_links_ = 0;
  bool has_header_ = false, has_birth_ = false, was_alive_ = false;
  std::string said_;
};

}  // namespace driftwright::follow
