#pragma once
// An edge node of Sparkplug B: the values of its metrics, by name, from its birth and data messages (Eclipse Sparkplug
// Specification 3.0.0).
//
// A birth (NBIRTH, DBIRTH) names all metrics and may give each an alias; data (NDATA, DDATA) may use the alias alone.
// Messages of a node are numbered 0 to 255 from its NBIRTH on. If a message is missing, or data come before the birth,
// the node is asked to send its birth again ("Node Control/Rebirth"). The broker does not keep births, so a client that
// connects later asks for one.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace driftwright::follow {

struct SparkplugAddress {
  std::string group, node;
  std::string device;  ///< "": metrics of the node itself
};
/// "shop/mill", "shop/mill/spindle". @throws InputError
[[nodiscard]] SparkplugAddress read_sparkplug_address(const std::string& text);

class SparkplugNode {
 public:
  explicit SparkplugNode(SparkplugAddress address) : address_(std::move(address)) {}

  /// The topics to subscribe to: of the node and of all its devices, whose messages are numbered together.
  [[nodiscard]] std::vector<std::string> topics() const;
  /// Topic and payload of the request for a birth.
  [[nodiscard]] std::string rebirth_topic() const;
  [[nodiscard]] static std::string rebirth_payload();

  /// Takes a message. @return why the message is of no use; "" if it is of use
  std::string take(const std::string& topic, const std::string& payload);
  /// The link was lost, and possibly messages: a new birth is required.
  void lose_sight() { wants_birth_ = true; }
  [[nodiscard]] bool wants_birth() const { return wants_birth_; }
  [[nodiscard]] bool is_alive() const { return is_alive_; }

  /// The metrics of the valid birth: numbers as text; none for null, and for a type that is no number.
  [[nodiscard]] const std::map<std::string, std::optional<std::string>>& metrics() const { return metrics_; }

 private:
  struct Known {
    std::string name;
    std::uint32_t datatype = 0;
  };
  using Aliases = std::map<std::uint64_t, Known>;

  SparkplugAddress address_;
  std::map<std::string, std::optional<std::string>> metrics_;
  std::map<std::string, std::uint32_t> datatype_;  // by name
  Aliases aliases_;
  std::optional<std::uint64_t> birth_number_;  // "bdSeq" of the NBIRTH
  std::uint64_t next_seq_ = 0;
  bool is_alive_ = false, wants_birth_ = true;
};

}  // namespace driftwright::follow
