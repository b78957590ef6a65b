#pragma once
// A stream as it is followed: rows in, a line for each out, whatever they are like.

#include <memory>

#include "follow/followed.hpp"
#include "follow/row_guard.hpp"

namespace driftwright::follow {

/// What is said after a row.
struct FollowLine {
  std::optional<double> time_s;  ///< of the row, by the source's clock; none where it has none
  std::optional<double> run_s;   ///< since the first row, of a row that was taken
  std::string state;             ///< on, held, reduced, off
  std::string why;               ///< where it is not on
  std::vector<AxisCorrection> axes;
  std::vector<std::string> faults;  ///< of the row
};

class Session {
 public:
  struct Model {
    std::string path, hash;  ///< of the file that it was read from
    std::unique_ptr<Followed> followed;
  };
  explicit Session(std::vector<Model> models);

  /// What the stream must have, each once. @throws InputError  where models want one channel in two units, or correct one axis twice
  [[nodiscard]] std::vector<WantedChannel> wanted() const;
  /// Before the first row. @throws InputError  for a stream that lacks a wanted channel
  void begin(const std::vector<Channel>& channels);
  [[nodiscard]] bool has_channels() const { return !channels_.empty(); }
  [[nodiscard]] const std::vector<Channel>& channels() const { return channels_; }

  [[nodiscard]] FollowLine take(StreamRow row);
  /// A line that is no row. @param why  as RowText says it
  [[nodiscard]] FollowLine pass_over(const std::string& why);
  /// No line came for so long, since the last one or the last wait.
  [[nodiscard]] FollowLine wait(double step_s);

  [[nodiscard]] const std::vector<Model>& models() const { return models_; }
  /// Of the run: of the row taken last, and how long there has been none.
  [[nodiscard]] double now_s() const { return guard_.state().run_s + waited_s_; }
  [[nodiscard]] double usual_step_s() const { return guard_.usual_step_s(); }
  [[nodiscard]] const FaultCounts& faults() const { return guard_.state().counts; }
  /// The values of the row taken last, as the models got them, and its time in the run: what a record holds.
  [[nodiscard]] const StreamRow& taken() const { return taken_; }

  /// All that it knows, for a file. @throws InputError  from recall(): for a state of other models or another stream
  [[nodiscard]] nlohmann::ordered_json state() const;
  void recall(const nlohmann::ordered_json& state);

 private:
  [[nodiscard]] FollowLine line(bool is_taken, std::vector<Fault> faults, const std::string& passed_over) const;
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
