#include "follow/mqtt_link.hpp"

#include <fmt/format.h>
#include <mosquitto.h>

#include <algorithm>
#include <charconv>
#include <chrono>

#include "base/errors.hpp"

namespace driftwright::follow {
namespace {

constexpr int kKeepAlive_s = 10;
constexpr unsigned kFirstDelay_s = 1, kLongestDelay_s = 10;
constexpr std::size_t kMostWaiting = 10'000, kMostWaitingBytes = 64'000'000;

}  // namespace

MqttAddress read_mqtt_address(const std::string& text) {
  MqttAddress address{.host = text};
  if (const std::size_t colon = text.rfind(':'); colon != std::string::npos) {
    address.host = text.substr(0, colon);
    const char *begin = text.data() + colon + 1, *end = text.data() + text.size();
    const auto [at, error] = std::from_chars(begin, end, address.port);
    if (error != std::errc() || at != end || address.port < 1 || address.port > 65535)
      throw InputError(fmt::format("--mqtt '{}': a port from 1 to 65535 is required after the colon", text));
  }
  if (address.host.empty()) throw InputError(fmt::format("--mqtt '{}' must be HOST or HOST:PORT", text));
  return address;
}

void MqttLink::Free::operator()(mosquitto* m) const {
  mosquitto_destroy(m);
  mosquitto_lib_cleanup();
}

MqttLink::MqttLink(const MqttAddress& address, std::vector<std::string> topics, const std::string& will_topic,
                   const std::string& will)
    : topics_(std::move(topics)) {
  mosquitto_lib_init();
  client_.reset(mosquitto_new(nullptr, true, this));
  if (!client_) throw std::bad_alloc();
  const auto must = [&](int code, const std::string& what) {
    if (code != MOSQ_ERR_SUCCESS) throw InputError(fmt::format("{}: {}", what, mosquitto_strerror(code)));
  };
  for (const std::string& topic : topics_) must(mosquitto_sub_topic_check(topic.c_str()), fmt::format("topic '{}'", topic));
  if (!will_topic.empty()) {
    must(mosquitto_pub_topic_check(will_topic.c_str()), fmt::format("topic '{}'", will_topic));
    if (!will.empty())
      must(mosquitto_will_set(client_.get(), will_topic.c_str(), static_cast<int>(will.size()), will.data(), 1, false),
           "the last will");
  }
  mosquitto_connect_callback_set(client_.get(), &MqttLink::connected);
  mosquitto_disconnect_callback_set(client_.get(), &MqttLink::disconnected);
  mosquitto_message_callback_set(client_.get(), &MqttLink::heard);
  mosquitto_reconnect_delay_set(client_.get(), kFirstDelay_s, kLongestDelay_s, true);
  const int begun = mosquitto_connect_async(client_.get(), address.host.c_str(), address.port, kKeepAlive_s);
  // While the broker is unreachable, the link waits and tries again.
  if (begun != MOSQ_ERR_SUCCESS && begun != MOSQ_ERR_ERRNO)
    must(begun, fmt::format("--mqtt {}:{}", address.host, address.port));
  must(mosquitto_loop_start(client_.get()), "MQTT");
}

MqttLink::~MqttLink() {
  (void)mosquitto_disconnect(client_.get());
  (void)mosquitto_loop_stop(client_.get(), false);
}

void MqttLink::connected(mosquitto* m, void* self, int code) {
  if (code != 0) return;
  ++static_cast<MqttLink*>(self)->n_links_;
  static_cast<MqttLink*>(self)->is_linked_ = true;
  for (const std::string& topic : static_cast<MqttLink*>(self)->topics_)
    (void)mosquitto_subscribe(m, nullptr, topic.c_str(), 1);
}

void MqttLink::disconnected(mosquitto*, void* self, int) {
  static_cast<MqttLink*>(self)->is_linked_ = false;
}

void MqttLink::heard(mosquitto*, void* self, const mosquitto_message* message) {
  auto& link = *static_cast<MqttLink*>(self);
  const auto size = static_cast<std::size_t>(message->payloadlen), n_kept = std::min(size, kLargestPayload);
  const std::lock_guard lock(link.mutex_);
  link.waiting_.push_back({message->topic, std::string(static_cast<const char*>(message->payload), n_kept), n_kept < size});
  link.waiting_bytes_ += n_kept;
  while (link.waiting_.size() > kMostWaiting || link.waiting_bytes_ > kMostWaitingBytes) {
    link.waiting_bytes_ -= link.waiting_.front().payload.size();
    link.waiting_.pop_front();
    ++link.n_lost_;
  }
  link.came_.notify_one();
}

bool MqttLink::next(Message& message, double wait_s) {
  std::unique_lock lock(mutex_);
  if (!came_.wait_for(lock, std::chrono::duration<double>(wait_s), [&] { return !waiting_.empty(); })) return false;
  message = std::move(waiting_.front());
  waiting_bytes_ -= message.payload.size();
  waiting_.pop_front();
  return true;
}

bool MqttLink::publish(const std::string& topic, const std::string& payload) {
  return mosquitto_publish(client_.get(), nullptr, topic.c_str(), static_cast<int>(payload.size()), payload.data(), 0,
                           false) == MOSQ_ERR_SUCCESS;
}

std::int64_t MqttLink::n_lost() {
  const std::lock_guard lock(mutex_);
  return n_lost_;
}

}  // namespace driftwright::follow
