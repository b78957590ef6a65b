#pragma once
// Reads an MTConnect agent by HTTP: the last observation of each data item, or all observations from a number on
// (MTConnect Standard, part 1, "Current Request", "Sample Request").

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "follow/item_units.hpp"

namespace driftwright::follow {

struct Observation {
  std::string id, name;                  ///< of its data item; "" where it has no name
  std::string value;                     ///< what the agent calls UNAVAILABLE is ""
  std::uint64_t sequence = 0;            ///< number in the agent's buffer
  double time_s = 0.0;                   ///< since 1970
  std::string type = {}, sub_type = {};  ///< "AxisFeedrate", "ACTUAL"
};

/// A document of MTConnectStreams.
struct MtconnectStreams {
  std::string instance;              ///< changes when the agent is restarted
  double created_s = 0.0;            ///< since 1970, by the agent's clock
  std::uint64_t next = 0, last = 0;  ///< number where the next request continues; number of the last observation
  bool is_out_of_range = false;      ///< the requested observation does not exist; only `instance` is set then
  std::vector<Observation> observations;
};

/// What an agent's probe says; a document of MTConnectDevices.
struct MtconnectProbe {
  std::vector<DataItem> items;
  std::string why_none = {};  ///< where the agent has no such document
};

/// @throws RangeError  for a document that is none, with what the agent says where it answers with an error
[[nodiscard]] std::vector<DataItem> read_mtconnect_devices(const std::string& xml);
[[nodiscard]] MtconnectStreams read_mtconnect_streams(const std::string& xml);

class MtconnectAgent {
 public:
  /// @param url  of the agent or of one of its devices: "http://10.0.0.7:5000", ".../mill"
  /// @throws InputError  for an address that is not http
  explicit MtconnectAgent(const std::string& url);
  ~MtconnectAgent();
  MtconnectAgent(const MtconnectAgent&) = delete;
  MtconnectAgent& operator=(const MtconnectAgent&) = delete;

  /// The current values. @throws RangeError  if it does not answer within `most_s`, or not with MTConnectStreams
  [[nodiscard]] MtconnectStreams current(double most_s);
  /// Its data items. @throws RangeError  where it does not answer within `most_s`, or is busy (HTTP 503)
  [[nodiscard]] MtconnectProbe probe(double most_s);
  /// Observations from a number on, up to a thousand. @throws RangeError  as current()
  [[nodiscard]] MtconnectStreams sample(std::uint64_t from, double most_s);

 private:
  struct Answer {
    std::string text;
    long status = 0;  ///< of HTTP
  };
  /// Redirections are followed. @throws RangeError  where there is no answer within `most_s`
  [[nodiscard]] Answer ask(const std::string& request, double most_s);
  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::string url_;
};

}  // namespace driftwright::follow
