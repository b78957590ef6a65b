#pragma once
// What an MTConnect agent tells now: the last observation of each data item, by HTTP (MTConnect Standard, part 1, "Current Request").

#include <map>
#include <memory>
#include <string>

namespace driftwright::follow {

/// The observations of a document of MTConnectStreams, by the `dataItemId` and, where there is one, the `name` of their data items.
/// What the agent calls UNAVAILABLE is "".
/// @throws RangeError  for a document that is none, with what the agent says where it answers with an error
[[nodiscard]] std::map<std::string, std::string> read_mtconnect_streams(const std::string& xml);

class MtconnectAgent {
 public:
  /// @param url  of the agent or of one of its devices: "http://10.0.0.7:5000", ".../mill"
  /// @throws InputError  for an address that is no http
  explicit MtconnectAgent(const std::string& url);
  ~MtconnectAgent();
  MtconnectAgent(const MtconnectAgent&) = delete;
  MtconnectAgent& operator=(const MtconnectAgent&) = delete;

  /// What it tells now. @throws RangeError  where it does not answer within `most_s`, or not with MTConnectStreams
  [[nodiscard]] std::map<std::string, std::string> current(double most_s);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::string url_;
};

}  // namespace driftwright::follow
