#pragma once
// What follows a stream and gives corrections: predictors from files, or the machine of a scenario.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "follow/stream_row.hpp"
#include "machine/model.hpp"

namespace driftwright::follow {

/// What became of a probing.
struct ProbingAnswer {
  bool is_taken = false;
  double off_um = 0.0;    ///< read minus expected
  double bound_um = 0.0;  ///< by which they may differ
  /// Half width of the 95 % interval after some times without a further probing: "1 h".
  std::vector<std::pair<std::string, double>> intervals_um = {};
  std::string words = {};
};

/// What probings have found of an axis.
struct ProbingState {
  double residual_um = 0.0;   ///< part of the correction
  double deviation_um = 0.0;  ///< 1 sigma of what is left
  int n_refused = 0;
  std::vector<std::pair<std::string, double>> weights = {};  ///< of a blend and its members, by name; empty for others
  std::optional<ProbingAnswer> answer = {};                  ///< to a probing of this row
  std::string probe_now = {};                                ///< why a probing is due; "": none is
};

/// The correction of one axis at one row.
struct AxisCorrection {
  std::string name;            ///< the displacement that is corrected
  double correction_um = 0.0;  ///< in force: to be subtracted from the position
  double predicted_um = 0.0;   ///< the predictor's value, before hold, fade and slew limit of the stream
  std::optional<double>
      interval_um;  ///< half width of the 95 % interval of the drift, in force; none without trust, or if none was learned
  std::optional<double> deviation_um;        ///< of an observer: its filter's present standard deviation of the drift
  double trust = 0.0;                        ///< factor on the prediction, 0 to 1
  std::string verdict = {};                  ///< from `validate`; "" if nothing has judged it
  std::vector<std::string> doubted = {};     ///< inputs that are not trusted now
  std::optional<double> watch_level = {};    ///< with a watch: above 1 the machine no longer behaves as modelled
  std::string alarm = {};                    ///< since when, and which sensors show it; "": none
  std::optional<ProbingState> probing = {};  ///< where the stream has a column of its probings
};

/// The state that colours the picture of a machine.
struct MachineState {
  Eigen::VectorXd state;   ///< of the machine's model
  double ambient_K = 0.0;  ///< over the reference
};

/// Something that follows the rows of a stream and gives corrections. Call begin() once, then take() for each row and
/// wait() while there is none.
class Followed {
 public:
  virtual ~Followed() = default;
  /// The channels that the stream must have.
  [[nodiscard]] virtual std::vector<WantedChannel> wanted() const = 0;
  /// The columns that this one takes as probings. @throws InputError  for those that it cannot take
  [[nodiscard]] virtual std::vector<std::string> probings(const std::vector<Channel>& channels) const {
    (void)channels;
    return {};
  }
  /// Call it before the first row. @param channels  of the stream; they include all wanted ones
  virtual void begin(const std::vector<Channel>& channels) = 0;
  /// Takes a row. @param step_s  time since the last row or wait
  /// @return false while drive or ambient are not known yet and the run has not begun
  virtual bool take(double run_s, const std::vector<double>& values, double step_s) = 0;
  /// No row came during the last `step_s`.
  virtual void wait(double step_s) = 0;
  [[nodiscard]] virtual bool has_begun() const = 0;
  [[nodiscard]] virtual std::vector<AxisCorrection> axes() const = 0;
  /// The machine model that a page can draw, valid as long as this object; null: none.
  [[nodiscard]] virtual const scenarios::Model* model() const { return nullptr; }
  /// The state of that model; none before the first row.
  [[nodiscard]] virtual std::optional<MachineState> machine_state() const { return {}; }
  /// The whole state, to be saved, and its restoration.
  [[nodiscard]] virtual nlohmann::ordered_json state() const = 0;
  virtual void recall(const nlohmann::ordered_json& state) = 0;
};

}  // namespace driftwright::follow
