#pragma once
// Between a predictor and the axis: what keeps a broken sensor, or a state the model has never seen, from making things worse.

#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Fade times that a sensor must be beyond doubt before it counts again.
inline constexpr double kBackAfter = 3.0;

/// Learned from training records; every bound is one that they kept, with room.
struct FailSafe {
  struct Guard {
    std::string input, unit;
    double low = 0.0, high = 0.0;  ///< validity range: outside, trust falls to 0 within half of its width
    double most_jump = 0.0;        ///< between readings `period_s` apart; more is no machine but a broken wire
    /// Analytical redundancy: the reading that the other inputs lead to, and how far the two may be apart.
    double others_intercept = 0.0;
    std::vector<double> others_coefficient;  ///< of the other inputs, in their order, 0 for itself; empty without others
    double most_apart = 0.0;
  };
  std::vector<Guard> guards;
  double period_s = 60.0;                    ///< of the training readings
  double lowest_um = 0.0, highest_um = 0.0;  ///< clamp
  double most_rate_um_s = 0.0;               ///< slew limit of the correction
  double fade_s = 600.0;                     ///< time constant with which trust is lost, and won again
  double stale_s = 300.0;  ///< after so long without a reading an input is not trusted; until then its last one holds
};

/// @param predicted  by the model on each training record, per row
/// @param inputs     channels of the model; drives (rpm) have a range alone
/// @throws InputError  as complete_rows()
[[nodiscard]] FailSafe learn_fail_safe(std::span<const Record> training, const std::vector<std::string>& inputs,
                                       const std::vector<std::vector<double>>& predicted);

struct GuardedCorrection {
  std::vector<double> correction_um;  ///< in force per row; never missing
  std::vector<double> trust;          ///< 0 to 1, that the prediction was multiplied by
  std::vector<std::string> events;    ///< what was not trusted, from when: one line each
};

/// The prediction as it may go to an axis: times trust, clamped, no faster than the slew limit. While the prediction is missing, the
/// last one holds.
/// @param predicted  per row of `readings`
[[nodiscard]] GuardedCorrection guarded(const FailSafe& safe, const Record& readings, std::span<const double> predicted);

}  // namespace driftwright::compensation
