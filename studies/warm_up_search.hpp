#pragma once
// Searches the shortest warm-up with one speed, with two, and with up to four.

#include <vector>

#include "studies/warm_up_trials.hpp"

namespace driftwright::studies {

inline constexpr double kWarmUpStep_rpm = 10.0;  ///< speeds are whole multiples of it, times are whole seconds
/// Largest ratio of peaks that is shown: an insufficient warm-up that reduces the peak by less is not worth the wait.
inline constexpr double kWorthTelling = 0.99;

class WarmUpSearch {
 public:
  /// A programme of n sections: n speeds as shares of the limit, then the ends of the first n - 1 sections as shares of
  /// the time.
  using Shape = std::vector<double>;

  /// @param trials, listener  must outlive this
  WarmUpSearch(const WarmUpTrials& trials, double tolerance_um, double most_rpm, double most_s, const Listener& listener)
      : trials_(trials), tolerance_um_(tolerance_um), most_rpm_(most_rpm), most_s_(most_s), listener_(listener) {}

  /// The least time at one speed; if no time is enough, the one that comes nearest.
  /// @param share   of the speed limit; 0: at rest
  /// @param most_s  longest time to consider
  [[nodiscard]] WarmUp least_time(double share, double most_s) const;
  /// The best of all speeds except rest.
  [[nodiscard]] WarmUp constant() const;
  /// The least drift at one speed in a given time.
  [[nodiscard]] WarmUp constant_in(double time_s) const;
  /// The best of two speeds in a given time, or the first within the tolerance. @param shape  start of the search, and
  /// its result
  [[nodiscard]] WarmUp staged_in(double time_s, Shape& shape) const;
  /// The shortest with two speeds. @param known  the shortest that is known, or the one that comes nearest
  [[nodiscard]] WarmUp staged_best(const WarmUp& known) const;
  /// A shorter programme than the known one, by inserting sections until there are four; if none is enough, one with less
  /// drift in the same time. Returns the known one if nothing better is found.
  [[nodiscard]] WarmUp refined(const WarmUp& known) const;

 private:
  [[nodiscard]] WarmUp constant(double time_s, double share) const;
  [[nodiscard]] WarmUp of(double time_s, const Shape& shape) const;
  /// The least peak at one speed between two times, or the first peak that is small enough, by golden section.
  [[nodiscard]] WarmUp least_between(double low_s, double high_s, double share) const;
  /// The least sufficient time at one speed, by bisection. @param low_s  a time that is not enough
  [[nodiscard]] WarmUp shortened(WarmUp best, double low_s, double share) const;
  [[nodiscard]] WarmUp best_of(const std::vector<double>& shares, double most_s) const;
  /// The best programme in a given time from the known one with one more section, which gets a tenth of the time.
  [[nodiscard]] WarmUp with_one_more(const WarmUp& known, double time_s) const;
  /// Pattern search: steps along each number, halved when none improves, until the tolerance is kept.
  [[nodiscard]] WarmUp improved(WarmUp best, double time_s, Shape& shape) const;

  const WarmUpTrials& trials_;
  double tolerance_um_, most_rpm_, most_s_;
  const Listener& listener_;
};

}  // namespace driftwright::studies
