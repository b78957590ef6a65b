#pragma once
// What effects `learned` add to a displacement while rows arrive: the same as over a whole record.

#include <string>
#include <vector>

#include "effects/effect.hpp"

namespace driftwright::effects {

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

}  // namespace driftwright::effects
