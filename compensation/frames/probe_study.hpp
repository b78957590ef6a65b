#pragma once
// Studies the errors from a probe's lag: touches at several feeds, and the thermal frame computed from rings measured this
// way.

#include <string>
#include <vector>

#include "compensation/frames/ring_measurement.hpp"

namespace driftwright::compensation {

/// Settings of the study.
struct ProbeStudySettings {
  ProbeSystem system = {};
  std::vector<double> feeds_m_s = {};  ///< ascending
  double reference_feed_m_s = 10e-3 / 60.0;
  double deceleration_m_s2 = 0.3;
  int touches = 100;  ///< number of touches of each kind at each feed
  double ring_distance_m = 9.6;
  double free_diameter_m = 0.05;
  std::uint64_t seed = 1;
};

/// Largest distances from the surface position that the slow touches of the calibration give [m].
struct ProbeErrors {
  double plain_m = 0.0;      ///< as the control computes it
  double latched_m = 0.0;    ///< with the latch only: the lag remains
  double by_speed_m = 0.0;   ///< less N v T with the commanded feed
  double whole_m = 0.0;      ///< less the increments of N cycles
  double corrected_m = 0.0;  ///< with latch and increments
};

struct ProbeRow {
  int axis = 0;
  double feed_m_s = 0.0;
  std::string motion = {};  ///< "constant", "braking", "roll-over 16", "roll-over 32"
  ProbeErrors worst = {};
};

/// Error of TEMP_SHIFT and TEMP_SCALE if nothing has moved between two measurements of the rings.
struct ShiftRow {
  std::string touches = {};  ///< "four" or "one" per ring and axis
  double feed_before_m_s = 0.0, feed_now_m_s = 0.0;
  std::string reading = {};
  double worst_shift_m = 0.0, rms_shift_m = 0.0;
  double worst_scale = 0.0;
};

struct ProbeStudy {
  std::array<ProbeCalibration, 3> calibration;
  std::vector<ProbeRow> rows;
  std::vector<ShiftRow> shifts;
};

/// Calibrates each axis by touches at constant speed, then evaluates other touches, with other seeds.
/// @throws InputError, RangeError  as calibrate_probe() and touch()
[[nodiscard]] ProbeStudy study_probe(const ProbeStudySettings& settings);

}  // namespace driftwright::compensation
