#pragma once
// What effects `learned` add to a displacement while rows arrive: the same as over a whole record. And how far they may be
// wrong beyond the drives that they were learned from.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "effects/effect.hpp"

namespace driftwright::effects {
namespace learned {

/// The name of the table of an effect `learned`; "" if it learned nothing.
[[nodiscard]] const std::string& table_of(const Effect& e);
/// What it follows, scaled to 1 at the stated drive; not of the ambient.
[[nodiscard]] std::function<double(const Drive&)> law_of(const Effect& e);

}  // namespace learned

/// The effects `learned` of one displacement, step by step.
class LearnedStream {
 public:
  struct State {
    double first = 0.0, first_ambient_K = 0.0;  ///< the displacement [m, or rad] and the ambient in the first row
    std::vector<double> x;                      ///< the lagged value of each term, in the order of effects and tables
  };

  /// @param effects  of a machine; others than those `learned` of this displacement are ignored
  LearnedStream(const std::vector<Effect>& effects, const std::string& displacement);
  [[nodiscard]] bool empty() const { return effects_.empty(); }

  void begin(double displacement, double ambient_K);
  /// @param during  the drive since the last row; the ambient is linear in between
  void advance(double step_s, const Drive& during, double ambient_before_K, double ambient_K);
  /// The displacement with what was learned. @param displacement  by the physics  @param now  the drive from this row on
  [[nodiscard]] double with_learned(double displacement, const Drive& now) const;

  [[nodiscard]] const State& state() const { return state_; }
  /// @throws InputError  for a state with another number of terms
  void recall(const State& state);

 private:
  std::vector<Effect> effects_;
  State state_;
};

/// One sigma of what the effects `learned` of a sensor or a displacement miss beyond their hull, the largest drive that they
/// were learned from: 0 within it, after the lags. There the amounts stay, while the law may go on. With e_k the lagged
/// excess of the unlimited law over 1, and amounts a_k known by a fit with covariance C, the mean square of what is missing
/// if the law goes on is (a' e)^2 + e' C e. Of C an entry holds `error`, the sigma of its sum of amounts. Hence
/// e' C e <= sum over entries of (error max_k |e_k|)^2, where the entries are independent. Of what follows the turning
/// spindle, (n / at_speed)^exponent - 1 is taken for the excess. The ambient has no hull.
/// @param time_s  increasing, from 0
/// @return in K, m or rad, for each time
[[nodiscard]] Eigen::RowVectorXd learned_sd_beyond(const std::vector<Effect>& effects, Place kind, const std::string& place,
                                                   const std::vector<double>& time_s, const Cyclogram& cyclogram);

}  // namespace driftwright::effects
