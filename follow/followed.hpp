#pragma once
// What follows a stream and tells corrections: predictors from files, or the machine of a scenario.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "follow/stream_row.hpp"
#include "machine/model.hpp"

namespace driftwright::follow {

/// What is said of one axis at one row.
struct AxisCorrection {
  std::string name;            ///< the displacement that is corrected
  double correction_um = 0.0;  ///< in force: what is to be taken away from the position
  double predicted_um = 0.0;   ///< as the predictor was judged by, before hold, fade and slew of the stream
  std::optional<double>
      interval_um;  ///< half width of the 95 % interval of the drift in force, over trust; none without trust, or where none was learned
  std::optional<double> deviation_um;      ///< of an observer: 1 sigma that its filter gives the drift now
  double trust = 0.0;                      ///< 0 to 1, that the prediction is multiplied by
  std::string verdict = {};                ///< of `validate`; "" where nobody has judged it
  std::vector<std::string> doubted = {};   ///< inputs
  std::optional<double> watch_level = {};  ///< where it is watched: above 1 the machine is not as modelled
  std::string alarm = {};                  ///< since when, and what it shows in; "": none
};

/// What a picture of a machine is coloured by.
struct MachineState {
  Eigen::VectorXd state;   ///< of its model
  double ambient_K = 0.0;  ///< over the reference
};

class Followed {
 public:
  virtual ~Followed() = default;
  /// Channels that the stream must have.
  [[nodiscard]] virtual std::vector<WantedChannel> wanted() const = 0;
  /// Before the first row. @param channels  of the stream, all wanted ones among them
  virtual void begin(const std::vector<Channel>& channels) = 0;
  /// Takes a row. @param step_s  since the row or wait before. @return false: drive or ambient are not known yet, and nothing has begun
  virtual bool take(double run_s, const std::vector<double>& values, double step_s) = 0;
  /// There was no row for so long.
  virtual void wait(double step_s) = 0;
  [[nodiscard]] virtual bool has_begun() const = 0;
  [[nodiscard]] virtual std::vector<AxisCorrection> axes() const = 0;
  /// The model of a machine that a page can draw, as long as this is there; null: none.
  [[nodiscard]] virtual const scenarios::Model* model() const { return nullptr; }
  /// Of that model; none before the first row.
  [[nodiscard]] virtual std::optional<MachineState> machine_state() const { return {}; }
  /// All that it knows, and back.
  [[nodiscard]] virtual nlohmann::ordered_json state() const = 0;
  virtual void recall(const nlohmann::ordered_json& state) = 0;
};

}  // namespace driftwright::follow
