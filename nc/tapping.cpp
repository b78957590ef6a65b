#include "nc/tapping.hpp"

namespace driftwright {

void tap_to(NcExecution& run, const std::array<double, 3>& target_m, double pitch_m, double speed_rpm) {
  if (!(speed_rpm > 0.0)) run.fail("tapping requires a speed of the spindle; write an S above zero");
  if (!(pitch_m > 0.0)) run.fail("tapping requires a pitch");
  const NcFeedMode mode = run.motion.feed_mode;
  const double feed = run.motion.feed, programmed_rpm = run.motion.programmed_rpm;
  const bool turning = run.motion.turning;
  run.motion.feed_mode = NcFeedMode::PerMinute;
  run.motion.feed = pitch_m * speed_rpm / 60.0;
  run.motion.programmed_rpm = speed_rpm;
  run.motion.turning = true;
  run.feed_to(target_m);
  run.motion.feed_mode = mode;
  run.motion.feed = feed;
  run.motion.programmed_rpm = programmed_rpm;
  run.motion.turning = turning;
}

}  // namespace driftwright
