#pragma once
// A followed stream: takes rows and returns one line for each, however faulty the row is.

#include <memory>

#include "follow/followed.hpp"
#include "follow/row_guard.hpp"

namespace driftwright::follow {

/// The output for one row.
struct FollowLine {
  std::optional<double> time_s;  ///< of the row, by the source's clock; none for a row without a time
  std::optional<double> run_s;   ///< since the first row; none for a row that was not taken
  std::string state;             ///< on, held, reduced, off
  std::string why;               ///< reason, unless the state is on
  std::vector<AxisCorrection> axes;
  std::vector<std::string> faults;  ///< of the row
};

class Session {
 public:
  struct Model {
    std::string path, hash;  ///< path and hash of the model's file
    std::unique_ptr<Followed> followed;
  };
  explicit Session(std::vector<Model> models);

  /// The channels that the stream must have, each once.
  /// @throws InputError  if models want one channel in two units, or correct one axis twice
  [[nodiscard]] std::vector<WantedChannel> wanted() const;
  /// Call it before the first row. @throws InputError  for a stream that lacks a wanted channel
  void begin(const std::vector<Channel>& channels);
  [[nodiscard]] bool has_channels() const { return !channels_.empty(); }
  [[nodiscard]] const std::vector<Channel>& channels() const { return channels_; }

  [[nodiscard]] FollowLine take(StreamRow row);
  /// Takes a line that is no row. @param why  the reason from RowText
  [[nodiscard]] FollowLine pass_over(const std::string& why);
  /// No line came during the last `step_s`.
  [[nodiscard]] FollowLine wait(double step_s);

  [[nodiscard]] const std::vector<Model>& models() const { return models_; }
  /// Present time of the run: that of the last row taken plus the time without rows since then.
  [[nodiscard]] double now_s() const { return guard_.state().run_s + waited_s_; }
  [[nodiscard]] double usual_step_s() const { return guard_.usual_step_s(); }
  [[nodiscard]] const FaultCounts& faults() const { return guard_.state().counts; }
  /// The last row taken, with the values that the models received and its time in the run, as a record holds it.
  [[nodiscard]] const StreamRow& taken() const { return taken_; }

  /// The whole state, for a file. @throws InputError  from recall(), for a state of other models or another stream
  [[nodiscard]] nlohmann::ordered_json state() const;
  void recall(const nlohmann::ordered_json& state);

 private:
  /// @param passed_over  why a row was not taken, in place of its faults; "": its faults @param lost_probing  with a probing
  ///                     in it
  [[nodiscard]] FollowLine line(bool is_taken, std::vector<Fault> faults, const std::string& passed_over,
                                bool lost_probing = false) const;
  [[nodiscard]] bool has_probing(const StreamRow& row) const;
  void require_probed_axes(const std::vector<Channel>& channels) const;
  void wait_all(double step_s);

  std::vector<Model> models_;
  std::vector<Channel> channels_;
  RowGuard guard_;
  double waited_s_ = 0.0;  // since the last row that was taken
  StreamRow taken_;
};

/// One line of JSON.
[[nodiscard]] std::string line_text(const FollowLine& line);

}  // namespace driftwright::follow
