#include "follow/sparkplug_node.hpp"

#include <fmt/format.h>

#include <limits>

#include "base/errors.hpp"
#include "sparkplug_b.pb.h"

namespace driftwright::follow {
namespace {

using sparkplug::Payload;
using Metric = Payload::Metric;

constexpr const char* kNamespace = "spBv1.0";
constexpr const char* kRebirth = "Node Control/Rebirth";
constexpr std::uint64_t kNumbers = 256;
constexpr std::uint32_t kBoolean = 11;

std::vector<std::string> parts_of(const std::string& topic) {
  std::vector<std::string> parts{""};
  for (char ch : topic) {
    if (ch == '/')
      parts.emplace_back();
    else
      parts.back() += ch;
  }
  return parts;
}

/// Signed integers are sent as unsigned ones of 32 or 64 bits (6.4.16: two's complement).
std::optional<std::string> number_of(const Metric& m, std::uint32_t datatype) {
  if (m.is_null()) return std::nullopt;
  switch (m.value_case()) {
    case Metric::kIntValue:
      switch (datatype) {
        case 1:
          return fmt::format("{}", static_cast<std::int8_t>(m.int_value()));
        case 2:
          return fmt::format("{}", static_cast<std::int16_t>(m.int_value()));
        case 3:
          return fmt::format("{}", static_cast<std::int32_t>(m.int_value()));
        default:
          return fmt::format("{}", m.int_value());
      }
    case Metric::kLongValue:
      return datatype == 4 ? fmt::format("{}", static_cast<std::int64_t>(m.long_value()))
                           : fmt::format("{}", m.long_value());
    case Metric::kFloatValue:
      return fmt::format("{:.9g}", m.float_value());
    case Metric::kDoubleValue:
      return fmt::format("{:.17g}", m.double_value());
    case Metric::kBooleanValue:
      return m.boolean_value() ? "1" : "0";
    default:
      return std::nullopt;
  }
}

std::optional<std::uint64_t> birth_number_of(const Payload& payload) {
  for (const Metric& m : payload.metrics()) {
    if (m.name() == "bdSeq") return m.value_case() == Metric::kIntValue ? m.int_value() : m.long_value();
  }
  return std::nullopt;
}

}  // namespace

SparkplugAddress read_sparkplug_address(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text);
  const bool is_well = (parts.size() == 2 || parts.size() == 3) && text.find_first_of("+#") == std::string::npos &&
                       !parts[0].empty() && !parts[1].empty() && !parts.back().empty();
  if (!is_well)
    throw InputError(
        fmt::format("--sparkplug '{}': GROUP/NODE or GROUP/NODE/DEVICE is required, such as shop/mill/spindle", text));
  return {parts[0], parts[1], parts.size() == 3 ? parts[2] : ""};
}

std::vector<std::string> SparkplugNode::topics() const {
  const std::string& g = address_.group;
  std::vector<std::string> list;
  for (const char* type : {"NBIRTH", "NDATA", "NDEATH"})
    list.push_back(fmt::format("{}/{}/{}/{}", kNamespace, g, type, address_.node));
  for (const char* type : {"DBIRTH", "DDATA", "DDEATH"})
    list.push_back(fmt::format("{}/{}/{}/{}/+", kNamespace, g, type, address_.node));
  return list;
}

std::string SparkplugNode::rebirth_topic() const {
  return fmt::format("{}/{}/NCMD/{}", kNamespace, address_.group, address_.node);
}

std::string SparkplugNode::rebirth_payload() {
  Payload payload;
  Metric* metric = payload.add_metrics();
  metric->set_name(kRebirth);
  metric->set_datatype(kBoolean);
  metric->set_boolean_value(true);
  return payload.SerializeAsString();
}

std::string SparkplugNode::take(const std::string& topic, const std::string& bytes) {
  const std::vector<std::string> parts = parts_of(topic);
  if (parts.size() < 4) return "its topic is none of Sparkplug B";
  const std::string& type = parts[2];
  const std::string device = parts.size() > 4 ? parts[4] : "";
  Payload payload;
  if (!payload.ParseFromString(bytes)) return fmt::format("its payload is none of Sparkplug B ({} bytes)", bytes.size());
  const auto nobody = [&] {
    for (auto& [name, value] : metrics_) value.reset();
  };

  if (type == "NDEATH") {
    if (!wants_birth_ && birth_number_of(payload) != birth_number_) return "it is the death of a birth before";
    is_alive_ = false;
    nobody();
    return "";
  }
  if (type == "NBIRTH") {
    birth_number_ = birth_number_of(payload);
    next_seq_ = (payload.seq() + 1) % kNumbers;
    is_alive_ = true;
    wants_birth_ = false;
    nobody();  // a device of the node sends all of its values again
  } else {
    if (!is_alive_ && !wants_birth_) wants_birth_ = true;  // data after its death
    if (wants_birth_) return "its node's birth has not been heard";
    if (payload.seq() != next_seq_) {
      wants_birth_ = true;
      return fmt::format("message {} of its node is missing", next_seq_);
    }
    next_seq_ = (next_seq_ + 1) % kNumbers;
  }
  if (device != address_.device) return "";
  if (type == "DDEATH") {
    nobody();
    return "";
  }
  const bool is_birth = type.ends_with("BIRTH");
  if (is_birth) {
    metrics_.clear();
    datatype_.clear();
    aliases_.clear();
  }
  for (const Metric& m : payload.metrics()) {
    if (m.is_historical()) continue;  // an old value
    Known known{m.name(), m.datatype()};
    if (m.has_alias()) {
      if (is_birth) {
        aliases_[m.alias()] = known;
      } else if (m.name().empty()) {
        const auto at = aliases_.find(m.alias());
        if (at == aliases_.end()) {
          wants_birth_ = true;
          return fmt::format("alias {} is of no birth", m.alias());
        }
        known.name = at->second.name;
      }
    }
    if (!is_birth && !datatype_.contains(known.name)) {
      wants_birth_ = true;
      return fmt::format("metric '{}' is of no birth", known.name);
    }
    if (is_birth) datatype_[known.name] = known.datatype;
    if (known.datatype == 0) known.datatype = datatype_[known.name];
    metrics_[known.name] = number_of(m, known.datatype);
  }
  return "";
}

}  // namespace driftwright::follow
