#pragma once
// Watches the bounds that conduction keeps: without a heat sink nothing gets colder than the coldest of start and surroundings,
// without a heat source nothing warmer than the warmest. The consistent mass matrix breaks them for a moment where a jump is
// sharper than the mesh; a lumped one would not, at the price of accuracy. We report, and lump nothing.

#include <optional>
#include <vector>

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

class OvershootWatch {
 public:
  /// @param least_K  smaller overshoots are not reported
  explicit OvershootWatch(double least_K) : least_K_(least_K) {}

  /// A power or coefficient has jumped at this time and state.
  void begin(double time_s, const double* theta, int n);
  /// After a step. @param low_K, high_K    coldest and warmest surrounding or prescribed temperature at this time
  /// @param heats, cools  whether some source has power > 0, < 0
  void step(double time_s, const double* theta, int n, double low_K, double high_K, bool heats, bool cools);
  /// One entry per jump that made one.
  [[nodiscard]] std::vector<Overshoot> result() const;

 private:
  double least_K_;
  double low_K_ = 0.0, high_K_ = 0.0;
  Overshoot worst_;
  std::vector<Overshoot> found_;
};

}  // namespace driftwright::solver
