#pragma once
// Between a predictor and the axis: what keeps a broken sensor, or a state the model has never seen, from making things worse.

#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Fade times that a sensor must be beyond doubt before it counts again.
inline constexpr double kBackAfter = 3.0;
/// Of most_apart: as near to what the others say a doubted sensor must be.
inline constexpr double kBackWithin = 0.5;

/// Learned from training records; every bound is one that they kept, with room.
struct FailSafe {
  struct Guard {
    std::string input, unit;
    /// Validity range: a reading outside counts as its edge, and trust falls to 0 within another width of the range.
    double low = 0.0, high = 0.0;
    double most_jump = 0.0;  ///< between readings `period_s` apart; more is no machine but a broken wire
    /// Analytical redundancy: the reading that the other inputs lead to, and how far the two may be apart.
    double others_intercept = 0.0;
    std::vector<double>
        others_coefficient;  ///< of all inputs in their order, 0 for itself and for drives; empty without others
    double most_apart = 0.0;
  };
  std::vector<Guard> guards;
  bool from_start = false;  ///< bounds and relations are those of readings minus the first one of the run; not of drives
  double period_s = 60.0;   ///< of the training readings
  double lowest_um = 0.0, highest_um = 0.0;  ///< clamp
  double most_rate_um_s = 0.0;               ///< slew limit of the correction
  double fade_s = 600.0;                     ///< time constant with which trust is lost, and won again
  double stale_s = 300.0;  ///< after so long without a reading an input is doubted; until then its last one holds
};

/// How far beyond its range in the training records a reading may go, for there a prediction has been seen to hold.
struct Reach {
  std::string input;
  double below = 0.0, above = 0.0;  ///< unit of the input, >= 0
};

/// @param training    as the machine gave them
/// @param inputs      channels of the model; drives (rpm) have a range alone
/// @param predicted   by the model on each training record, per row
/// @param from_start  temperatures count from the first row of each record
/// @param is_counted  they do so already in `training`: rows may have been cut off since
/// @param reach       of some inputs; without it the range has a fifth of its width as room
/// @throws InputError  as complete_rows() and fit_regression(), and for training records of one row
[[nodiscard]] FailSafe learn_fail_safe(std::span<const Record> training, const std::vector<std::string>& inputs,
                                       const std::vector<std::vector<double>>& predicted, bool from_start,
                                       bool is_counted = false, const std::vector<Reach>& reach = {});

/// Readings with what is doubted replaced by what the other inputs lead to.
///
/// A reading is doubted that is missing for too long, that jumps, or that is too far from what the others say; of several that
/// disagree, the one furthest beyond its bound is doubted first, and the rest is looked at anew with its replacement. It stays doubted
/// until nothing has been wrong, and its reading near what the others say, for kBackAfter fade times. Up to a third of the inputs (one at least) are
/// replaced, all at once by what those beyond doubt lead to, and cost no trust; more, or one that nothing can replace, cost all of it. An
/// input that counts from its first reading and has none in the first row goes on from its replacement where it begins, and is written as a rise.
struct Repaired {
  Record readings;                  ///< channels of the guards repaired, others as they were
  std::vector<double> deserved;     ///< trust that the readings of each row deserve, 0 to 1
  std::vector<std::string> events;  ///< what was doubted, from when: one line each
};
/// Row by row by control/drift_correction.c, as on a control. A reading that is not finite is missing.
/// @throws InputError  when the record lacks an input
[[nodiscard]] Repaired repaired(const FailSafe& safe, Record readings);
/// How many of n inputs may be replaced.
[[nodiscard]] int most_replaced(std::size_t n_inputs);

struct GuardedCorrection {
  std::vector<double> correction_um;  ///< in force per row; never missing
  std::vector<double> trust;          ///< 0 to 1, that the prediction was multiplied by
  std::vector<std::string> events;    ///< as of the repair
};

/// The prediction as it may go to an axis: times trust, clamped, no faster than the slew limit. While the prediction is missing, the
/// last one holds.
/// @param predicted  per row, from the repaired readings
[[nodiscard]] GuardedCorrection guarded(const FailSafe& safe, const Repaired& readings, std::span<const double> predicted);

}  // namespace driftwright::compensation
