#pragma once
// Options of the verb `follow`, which no other verb shares, and the verb itself.

#include <optional>
#include <string>
#include <vector>

namespace driftwright::app {

struct FollowVerbOptions {
  std::vector<std::string> models;  ///< files of `validate`, or a scenario
  std::string columns;              ///< scenario with `columns` or `topics` of the rows; empty: rows as in records
  std::string replay;               ///< a file in place of standard input
  double pace = 0.0;                ///< speed of the replay, as a multiple of real time; 0: as fast as possible
  std::string mqtt;                 ///< broker HOST:PORT in place of standard input; empty: none
  std::string mtconnect;            ///< address of an agent in place of standard input; empty: none
  bool sample = false;              ///< read all observations of the agent, not only its current values
  std::string sparkplug;            ///< node of Sparkplug B at the broker, GROUP/NODE or GROUP/NODE/DEVICE; empty: none
  std::string from;                 ///< topic whose messages are rows
  std::vector<std::string> topics;  ///< or a topic or data item per channel: "t01_degC=shop/mill/t01"; empty: the scenario's
  std::string every = "1 s";        ///< interval of rows made from topics or items
  std::string to;                   ///< topic to which lines are also published; empty: none
  std::string state, record;        ///< files; empty: none
  std::optional<int> serve;         ///< port of a page; none: no page
  std::string bind = "127.0.0.1";   ///< address that it listens at
  std::string token;                ///< that it asks for; "@FILE": its first line
  std::string slew, hold, fade;     ///< "0.5 um/s", "5 min", "10 min"; empty: the model's own
  bool despite_verdict = false;     ///< models that `validate` calls unsafe are followed, too
  std::string watch;                ///< limits of the watch; empty: those of the model's file
  bool no_watch = false;            ///< nothing is watched
  std::string calibrate_watch;      ///< file that limits are written to, in place of following; empty: none
  std::string top_speed;            ///< with that: "2500 rpm"
};
void follow_stream(const FollowVerbOptions& options);

}  // namespace driftwright::app
