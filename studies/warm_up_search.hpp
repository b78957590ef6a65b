#pragma once
// The shortest of programmes at one speed, at two and at up to four.

#include <vector>

#include "studies/warm_up_trials.hpp"

namespace driftwright::studies {

inline constexpr double kWarmUpStep_rpm = 10.0;  ///< speeds are whole multiples of it, times whole seconds
/// Of a peak: what is not enough and takes off less is not worth the wait.
inline constexpr double kWorthTelling = 0.99;

class WarmUpSearch {
 public:
  /// Of n sections: n speeds as shares of the limit, then where n - 1 of them end as shares of the time.
  using Shape = std::vector<double>;

  /// @param trials, listener  outlive this
  WarmUpSearch(const WarmUpTrials& trials, double tolerance_um, double most_rpm, double most_s, const Listener& listener)
      : trials_(trials), tolerance_um_(tolerance_um), most_rpm_(most_rpm), most_s_(most_s), listener_(listener) {}

  /// The least time at one speed; where none is enough, what comes nearest.
  /// @param share   of the limit; 0: at rest
  /// @param most_s  no longer one is of interest
  [[nodiscard]] WarmUp least_time(double share, double most_s) const;
  /// The best of all speeds above rest.
  [[nodiscard]] WarmUp constant() const;
  /// The least drift at one speed in a given time.
  [[nodiscard]] WarmUp constant_in(double time_s) const;
  /// The best of two speeds in a given time; the first that is within the tolerance. @param shape  where to begin, and where it ended
  [[nodiscard]] WarmUp staged_in(double time_s, Shape& shape) const;
  /// The shortest of two speeds. @param known  the shortest that is known, or what comes nearest
  [[nodiscard]] WarmUp staged_best(const WarmUp& known) const;
  /// Shorter than what is known, by sections put into it until there are four; where none is enough, of less drift in its time. What is known, where
  /// nothing better is found.
  [[nodiscard]] WarmUp refined(const WarmUp& known) const;

 private:
  [[nodiscard]] WarmUp constant(double time_s, double share) const;
  [[nodiscard]] WarmUp of(double time_s, const Shape& shape) const;
  /// The least peak at one speed between two times, or the first that is enough, by golden section.
  [[nodiscard]] WarmUp least_between(double low_s, double high_s, double share) const;
  /// The least time at one speed that is enough, by halves. @param low_s  at which it is not
  [[nodiscard]] WarmUp shortened(WarmUp best, double low_s, double share) const;
  [[nodiscard]] WarmUp best_of(const std::vector<double>& shares, double most_s) const;
  /// The best in a given time of what is known with one section more, which has a tenth of it.
  [[nodiscard]] WarmUp with_one_more(const WarmUp& known, double time_s) const;
  /// Steps along each of its numbers, halved where none helps, until the tolerance is kept.
  [[nodiscard]] WarmUp improved(WarmUp best, double time_s, Shape& shape) const;

  const WarmUpTrials& trials_;
  double tolerance_um_, most_rpm_, most_s_;
  const Listener& listener_;
};

}  // namespace driftwright::studies
