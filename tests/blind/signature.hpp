#pragma once
// The strength of an effect: the norm of its change of the measured records, in units of noise, minus what scatter could
// explain.
//
//     d'^2 = s' (1 + J J')^-1 s = s's - (J's)' (1 + J'J)^-1 (J's)
//
// s: change of all measured readings divided by the noise of their channel; J: the same for one standard deviation of
// each scattering number, by finite differences. (1 + J J') is the covariance of readings before any are known, so d' is
// the distance at which the best linear test distinguishes the effect from nothing.

#include "blind/drawn.hpp"

namespace driftwright::blind {

/// True readings of a record on a fine grid, 10 minutes longer than the record (clocks may be early).
/// @param values  scattered, without the hidden effects
[[nodiscard]] Readings readings_of(const Subject& subject, const Values& values, const std::vector<Hidden>& hidden,
                                   const CasePlan& plan, std::size_t record, double step_s, bool is_full);

class Loudness {
 public:
  Loudness(const Subject& subject, const CasePlan& plan);
  /// The s of effects that act together.
  [[nodiscard]] Eigen::VectorXd signature(const std::vector<Hidden>& hidden) const;
  /// a' (1 + J J')^-1 b
  [[nodiscard]] double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;
  [[nodiscard]] double d_prime(const Hidden& hidden) const;

 private:
  [[nodiscard]] Eigen::VectorXd rows(const Values& values, const std::vector<Hidden>& hidden) const;
  const Subject& subject_;
  const CasePlan& plan_;
  Eigen::VectorXd nominal_;
  Eigen::MatrixXd jacobian_, inverse_;  ///< J; (1 + J'J)^-1
};

/// Changes the size until d' has the required value, within the effect's bounds. @return d' of the size found
double tune(const Loudness& loudness, Hidden& hidden, double wanted);

}  // namespace driftwright::blind
