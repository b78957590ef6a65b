#pragma once
// An incremental encoder on a moving axis: the times at which its lines change.

#include <cstdint>
#include <vector>

#include "compensation/injector/timed_injector.hpp"

namespace driftwright::compensation {

/// Position of the encoder.
enum class Feedback {
  kMotor,  ///< on the motor (semi-closed loop): it does not measure the screw's growth
  kScale,  ///< a linear scale on the axis (full closed loop): it measures everything except its own growth
};

/// Thermal strain [-] of the screw and the scale, measured from the point where each is fixed.
struct AxisStrain {
  double screw = 0.0;
  double scale = 0.0;
};

/// Distance by which the axis is farther than its encoder shows [um]: the encoder's position times the strain that it does
/// not measure.
[[nodiscard]] constexpr double unseen_um(Feedback feedback, const AxisStrain& strain, double encoder_um) {
  return encoder_um * (feedback == Feedback::kMotor ? strain.screw : strain.scale);
}

struct Encoder {
  double period_um = 4.0;     ///< travel of one signal period: pitch / lines for a motor encoder, the grating's for a scale
  int periods_per_index = 0;  ///< the index is high during one quarter per this number of periods; 0: never
  /// Position error of each edge, uniform in +-jitter quarters, always the same at the same place; < 0.5.
  double jitter = 0.0;
  std::uint64_t seed = 0;  ///< of the jitter

  [[nodiscard]] double quarter_um() const { return period_um / kQuartersPerPeriod; }
};

/// The lines of an encoder while its axis moves. Memory does not grow with the travel.
class EncoderEdges {
 public:
  /// @throws RangeError  when the period is not positive or the jitter not in [0, 0.5)
  EncoderEdges(const Encoder& encoder, double position_um);

  [[nodiscard]] Lines lines() const;
  [[nodiscard]] std::int64_t phase() const { return phase_; }  ///< quarter steps from position 0

  /// Moves the axis to `to_um` at constant speed between two times; appends the edges that it passes, in order.
  void move(std::int64_t from_t, std::int64_t to_t, double to_um, std::vector<Edge>& out);

 private:
  [[nodiscard]] double place_um(std::int64_t phase) const;  // position at which the lines change to that phase

  Encoder encoder_;
  double position_um_;
  std::int64_t phase_ = 0;
};

}  // namespace driftwright::compensation
