#pragma once
// What an MTConnect agent tells, by HTTP: the last observation of each data item, or all from one of them on (MTConnect Standard, part 1, "Current
// Request", "Sample Request").

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace driftwright::follow {

struct Observation {
  std::string id, name;        ///< of its data item; "" where it has no name
  std::string value;           ///< what the agent calls UNAVAILABLE is ""
  std::uint64_t sequence = 0;  ///< number in the agent's buffer
  double time_s = 0.0;         ///< since 1970
};

/// A document of MTConnectStreams.
struct MtconnectStreams {
  std::string instance;              ///< changes where the agent is started anew
  double created_s = 0.0;            ///< since 1970, by the agent's clock
  std::uint64_t next = 0, last = 0;  ///< number that the next question goes on from; that of the last observation
  bool is_out_of_range =
      false;  ///< there is no observation of the number that was asked for; nothing else is told but `instance`
  std::vector<Observation> observations;
};

/// @throws RangeError  for a document that is none, with what the agent says where it answers with an error
[[nodiscard]] MtconnectStreams read_mtconnect_streams(const std::string& xml);

class MtconnectAgent {
 public:
  /// @param url  of the agent or of one of its devices: "http://10.0.0.7:5000", ".../mill"
  /// @throws InputError  for an address that is no http
  explicit MtconnectAgent(const std::string& url);
  ~MtconnectAgent();
  MtconnectAgent(const MtconnectAgent&) = delete;
  MtconnectAgent& operator=(const MtconnectAgent&) = delete;

  /// What it tells now. @throws RangeError  where it does not answer within `most_s`, or not with MTConnectStreams
  [[nodiscard]] MtconnectStreams current(double most_s);
  /// Observations from a number on, up to a thousand. @throws RangeError  as current()
  [[nodiscard]] MtconnectStreams sample(std::uint64_t from, double most_s);

 private:
  [[nodiscard]] MtconnectStreams ask(const std::string& request, double most_s);
  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::string url_;
};

}  // namespace driftwright::follow
