#pragma once
// What corrections leave along the travel of an axis: one for a single place, used everywhere, and those for several places,
// straight between them (control/axis_travel.h), as controls run them.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/judging/strategy_matrix.hpp"

namespace driftwright::compensation {

/// A place of the travel, and the channel of its error.
struct TravelPlace {
  std::string channel;
  double at_m = 0.0;
};

/// What is left along the travel over all rows of all judged runs, with all sensors intact.
struct LeftAlong {
  std::vector<double> peak_um = {};  ///< largest |drift - correction| at each judged place
  double worst_um = 0.0;             ///< the largest of these
  std::size_t place = 0, run = 0;    ///< where that is
};

/// A strategy, fitted for each corrected place.
struct TravelStrategy {
  std::string name;  ///< "ridge, all sensors"
  std::vector<LeftAlong> alone =
      {};                   ///< the correction for one place, used everywhere; in the order of the corrected places
  LeftAlong along = {};     ///< all of them, straight between their places
  bool is_formula = false;  ///< for every place: a control can run it
};

struct Travel {
  std::vector<TravelPlace> places;  ///< judged, by rising position
  std::vector<double> corrected_m;  ///< positions that have a correction of their own
  LeftAlong uncorrected;
  std::vector<TravelStrategy> strategies;  ///< fitted at every corrected place, without baselines
  /// The one to deploy by choose() on the left-out parts of all places, and the same of those that are formulas. No row of
  /// the judged runs decides it. None: nothing could be left out.
  std::optional<std::size_t> chosen = {}, chosen_formula = {};
  std::string why_chosen = {};  ///< one sentence
};

/// @param corrected  strategies judged for one place each, on the same runs, by rising position; at least two
/// @param at_m       these positions
/// @param judged     places whose channels are in the readings of these runs, by rising position
[[nodiscard]] Travel judge_travel(std::span<const StrategyMatrix> corrected, const std::vector<double>& at_m,
                                  std::vector<TravelPlace> judged);

}  // namespace driftwright::compensation
