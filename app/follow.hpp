#pragma once
// The verb `follow`, whose options no other verb has.

#include <optional>
#include <string>
#include <vector>

namespace driftwright::app {

struct FollowVerbOptions {
  std::vector<std::string> models;  ///< files of `validate`, or a scenario
  std::string columns;              ///< a scenario whose `columns` say how rows are written, or `topics` where from; empty: as records
  std::string replay;               ///< a file in place of standard input
  double pace = 0.0;                ///< of the replay: times its own; 0: as fast as it goes
  std::string mqtt;                 ///< broker HOST:PORT in place of standard input; empty: none
  std::string mtconnect;            ///< address of an agent in place of standard input; empty: none
  bool sample = false;              ///< of the agent all observations, not what it tells now
  std::string sparkplug;            ///< node of Sparkplug B at the broker, GROUP/NODE or GROUP/NODE/DEVICE; empty: none
  std::string from;                 ///< topic whose messages are rows
  std::vector<std::string> topics;  ///< or one a channel: "t01_degC=shop/mill/t01"; of an agent its data item; empty: the scenario's key `topics`
  std::string every = "1 s";        ///< of the rows that are made of those
  std::string to;                   ///< topic that lines go to, too; empty: none
  std::string state, record;        ///< files; empty: none
  std::optional<int> serve;         ///< port of a page; none: no page
  std::string bind = "127.0.0.1";   ///< address that it listens at
  std::string token;                ///< that it asks for; "@FILE": its first line
  std::string slew, hold, fade;     ///< "0.5 um/s", "5 min", "10 min"; empty: the model's own
  bool despite_verdict = false;     ///< models that `validate` calls unsafe are followed, too
  std::string watch;                ///< limits of the watch; empty: none
  std::string calibrate_watch;      ///< file that limits are written to, in place of following; empty: none
  std::string top_speed;            ///< with that: "2500 rpm"
};
void follow_stream(const FollowVerbOptions& options);

}  // namespace driftwright::app
