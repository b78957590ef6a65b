#pragma once
// Messages of an MQTT broker as they come, and ours to it. If the broker is unreachable or disconnects, the link waits and reconnects.

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

/// Of a payload, as of a line of standard input.
constexpr std::size_t kLargestPayload = 1'000'000;  // bytes

class MqttLink {
 public:
  struct Message {
    std::string topic, payload;
    bool is_cut = false;  ///< it was larger than that, and only its beginning is here
  };
  /// Connects in the background, now and whenever the link is lost (again after 1 s, later after up to 10 s).
  /// @param topics   that are listened to
  /// @param will     what the broker tells on `will_topic` when we go without a word; "": nothing
  /// @throws InputError  for a topic or host that can be none
  MqttLink(const MqttAddress& address, std::vector<std::string> topics, const std::string& will_topic,
           const std::string& will);
  ~MqttLink();
  MqttLink(const MqttLink&) = delete;
  MqttLink& operator=(const MqttLink&) = delete;

  /// The next message. @return false: none within so long
  [[nodiscard]] bool next(Message& message, double wait_s);
  /// Hands a message on, at most once. @return false: there is no link by now, and it is lost
  bool publish(const std::string& topic, const std::string& payload);
  /// How many times the broker was reached.
  [[nodiscard]] int n_links() const { return n_links_; }
  [[nodiscard]] bool is_linked() const { return is_linked_; }
  /// Messages that came faster than they were taken, of which the oldest are lost: more than 10 000 of them or 64 MB wait nowhere.
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
