#pragma once
// Receives messages from an MQTT broker and publishes ours. If the broker is unreachable or disconnects, the link waits
// and reconnects.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

struct mosquitto;
struct mosquitto_message;

namespace driftwright::follow {

struct MqttAddress {
  std::string host;
  int port = 1883;
};
/// "localhost", "10.0.0.5:1884". @throws InputError
[[nodiscard]] MqttAddress read_mqtt_address(const std::string& text);

/// Largest payload, the same limit as for a line of standard input.
constexpr std::size_t kLargestPayload = 1'000'000;  // bytes

class MqttLink {
 public:
  struct Message {
    std::string topic, payload;
    bool is_cut = false;  ///< the message was larger, and only its beginning is here
  };
  /// Connects in the background, now and whenever the link is lost (again after 1 s, later after up to 10 s).
  /// @param topics   topics to subscribe to
  /// @param will     message that the broker publishes on `will_topic` if we disconnect without a word; "": none
  /// @throws InputError  for an invalid topic or host
  MqttLink(const MqttAddress& address, std::vector<std::string> topics, const std::string& will_topic,
           const std::string& will);
  ~MqttLink();
  MqttLink(const MqttLink&) = delete;
  MqttLink& operator=(const MqttLink&) = delete;

  /// Takes the next message. @return false if none arrives within `wait_s`
  [[nodiscard]] bool next(Message& message, double wait_s);
  /// Publishes a message, at most once. @return false if there is no link; the message is lost then
  bool publish(const std::string& topic, const std::string& payload);
  /// How often the broker was reached.
  [[nodiscard]] int n_links() const { return n_links_; }
  [[nodiscard]] bool is_linked() const { return is_linked_; }
  /// Number of messages lost because they arrived faster than they were taken: beyond 10 000 or 64 MB waiting, the oldest
  /// are dropped.
  [[nodiscard]] std::int64_t n_lost();

 private:
  struct Free {
    void operator()(mosquitto* m) const;
  };
  static void connected(mosquitto* m, void* self, int code);
  static void disconnected(mosquitto* m, void* self, int code);
  static void heard(mosquitto* m, void* self, const mosquitto_message* message);

  std::vector<std::string> topics_;
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<Message> waiting_;
  std::size_t waiting_bytes_ = 0;  // of their payloads
  std::int64_t n_lost_ = 0;
  std::atomic<int> n_links_ = 0;
  std::atomic<bool> is_linked_ = false;
  std::unique_ptr<mosquitto, Free> client_;
};

}  // namespace driftwright::follow
