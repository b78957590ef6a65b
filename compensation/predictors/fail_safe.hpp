#pragma once
// The fail-safe between a predictor and the axis: limits the harm of a broken sensor, or of a state that the model has never
// seen.

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/machine_limits.hpp"
#include "base/record.hpp"

namespace driftwright::compensation {

/// Number of fade times for which a sensor must be free of doubt before it is used again.
inline constexpr double kBackAfter = 3.0;
/// Share of most_apart: a doubted sensor must be this close to the value computed from the others.
inline constexpr double kBackWithin = 0.5;

/// Limits learned from training records; each is the extreme value of these records plus a margin.
struct FailSafe {
  struct Guard {
    std::string input, unit;
    /// Validity range: a reading outside is replaced by the limit, and trust falls to 0 within one more width of the range.
    double low = 0.0, high = 0.0;
    double most_jump = 0.0;  ///< between readings `period_s` apart; more means a broken wire
    /// Analytical redundancy: the value computed from the other inputs, and the largest allowed difference.
    double others_intercept = 0.0;
    /// Of all inputs in their order, 0 for itself and for drives; empty without other inputs.
    std::vector<double> others_coefficient;
    double most_apart = 0.0;
    /// First reading of a run minus the mean of those of all watched inputs [K], and the weight of what it is above this
    /// [1/K] in the warmth with which a run starts; 0: not watched.
    double start_offset = 0.0, start_weight = 0.0;
  };
  std::vector<Guard> guards;
  bool from_start = false;  ///< limits and relations apply to readings minus the first one of the run, except for drives
  double period_s = 60.0;   ///< interval of the training readings
  double lowest_um = 0.0, highest_um = 0.0;  ///< limits of the correction
  double most_rate_um_s = 0.0;               ///< slew limit of the correction
  double fade_s = 600.0;                     ///< time constant with which trust is lost and regained
  double stale_s = 300.0;  ///< an input without a reading for this long is doubted; until then its last reading applies
  double most_start = std::numeric_limits<double>::infinity();  ///< warmth with which a run may start; infinite: any
  /// Time constant with which the predictor forgets how a run started; infinite if it never does.
  double start_s = std::numeric_limits<double>::infinity();
};

/// The use of relations between the inputs: they replace readings that are missing or jump, and those that are too far from
/// what the others lead to.
enum class Redundancy { kReplaces, kDoubts };

/// @param training    as recorded
/// @param inputs      channels of the model; drives (rpm) get a range only
/// @param predicted   the model's values on each training record, per row
/// @param from_start  temperatures count from the first row of each record
/// @param is_counted  they already do so in `training`, whose first rows may have been cut off since
/// @param room        factor on the usual margins beyond the training records, which are a fifth of the width of an input's
///                    range, half of the width of the drift's, and once more its rate
/// @param redundancy  kReplaces is much faster: the largest difference between an input and its relation is not learned
/// @throws InputError  as complete_rows() and fit_regression(), and for training records of one row
[[nodiscard]] FailSafe learn_fail_safe(std::span<const Record> training, const std::vector<std::string>& inputs,
                                       const std::vector<std::vector<double>>& predicted, bool from_start,
                                       bool is_counted = false, double room = 1.0,
                                       Redundancy redundancy = Redundancy::kDoubts);

/// The same without relations between the inputs: nothing replaces a reading that is missing or jumps.
[[nodiscard]] FailSafe learn_limits(std::span<const Record> training, const std::vector<std::string>& inputs,
                                    const std::vector<std::vector<double>>& predicted, bool from_start,
                                    bool is_counted = false, double room = 1.0);

/// Share of the warmth of work beyond which a start is not trusted. A predictor that takes a machine of the share s for cold
/// is wrong by s of the drift of work; without correction 1 - s of it is left. So it gains up to a half.
inline constexpr double kMostWarmStart = 0.5;

/// Watches the start of a run: a predictor with lags takes for granted that the machine starts as in its training runs,
/// usually at rest and cold. How warm a machine is shows in the differences between its thermometers: the warmth is their
/// first readings' part along the pattern of work (least squares), 0 as at the mean of the training starts, 1 as in the mean
/// of all training rows. Beyond kMostWarmStart, and what the training starts reach themselves, trust is 0 at the start and
/// comes back with `memory_s`, or not at all if the drift counts from the start.
/// @param starts    the first row of each training run whose history is not known: readings of the guards, NaN where missing
/// @param rise      of each guard, mean over all training rows of its reading minus that at the run's start; NaN: unknown
/// @param memory_s  Predictor::memory_s(); 0: nothing is watched, as with a pattern of less than 1.5 K
void watch_start(FailSafe& safe, std::span<const std::vector<double>> starts, std::span<const double> rise, double memory_s);

/// Why trust is low then, for a person.
inline constexpr const char* kStrangeStart =
    "the thermometers differ from each other otherwise than where the training runs begin, as on a warm machine, so lags "
    "start wrong; begin when the machine is as cold as there, or give first the rows since it was";

/// The same fail-safe for a run whose history is known: its start is not watched.
[[nodiscard]] FailSafe with_known_start(FailSafe safe);

/// Narrows clamp and slew limit: no correction larger than `most_um`, and none that changes by more than `most_step_um` from
/// one reading to the next, which are `period_s` apart.
void limit(FailSafe& safe, const CorrectionLimits& limits);

/// Readings in which doubted values are replaced by values computed from the other inputs.
///
/// A reading is doubted if it is missing for too long, jumps, or is too far from the value computed from the others. If
/// several disagree, the one with the largest excess over its limit is doubted first, and the rest is checked again with its
/// replacement. It stays doubted until, for kBackAfter fade times, nothing has been wrong and its reading was near the
/// computed value. Up to a third of the inputs (at least one) are replaced, all at once from the undoubted ones, without
/// loss of trust; with more, or with one that cannot be replaced, trust becomes 0. An input that counts from its first
/// reading and has none in the first row continues from its replacement where it begins, and is stored as a rise.
struct Repaired {
  Record readings;                  ///< channels of the guards repaired, others unchanged
  std::vector<double> deserved;     ///< trust that the readings of each row justify, 0 to 1
  std::vector<std::string> events;  ///< which inputs were doubted, and from when: one line each
};
/// Repairs readings row by row with control/drift_correction.c, as on a control. A reading that is not finite is missing.
/// @throws InputError  when the record lacks an input
[[nodiscard]] Repaired repaired(const FailSafe& safe, Record readings);
/// The number of inputs, out of n, that may be replaced.
[[nodiscard]] int most_replaced(std::size_t n_inputs);

/// The correction after the fail-safe.
struct GuardedCorrection {
  std::vector<double> correction_um;  ///< in force, per row; never missing
  std::vector<double> trust;          ///< factor on the prediction, 0 to 1
  /// Of correct(): half width of the 95 % interval of the drift about the correction [um], per row; NaN without one.
  std::vector<double> interval_um = {};
  std::vector<std::string> events;  ///< those of the repair
  /// Of correct(): what members of a blend may send to the axis [um], [member][row].
  std::vector<std::vector<double>> members_um = {};
};

/// Limits a prediction before it is sent to an axis: multiplied by trust, clamped, and limited in slew. While the prediction
/// is missing, the last one applies.
/// @param predicted  per row, computed from the repaired readings
[[nodiscard]] GuardedCorrection guarded(const FailSafe& safe, const Repaired& readings, std::span<const double> predicted);

}  // namespace driftwright::compensation
