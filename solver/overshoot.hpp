#pragma once
// Checks the bounds that conduction obeys: without a heat sink nothing gets colder than the coldest of start and
// surroundings, without a heat source nothing warmer than the warmest. The consistent mass matrix violates them briefly
// where a jump is sharper than the mesh; a lumped one would not, but is less accurate. The program reports violations and
// does not lump.

#include <optional>
#include <vector>

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Observes a run step by step.
class OvershootWatch {
 public:
  /// @param least_K  smaller overshoots are not reported
  /// @param share    the unknowns are those of this process; null: all
  explicit OvershootWatch(double least_K, const Share* share = nullptr) : least_K_(least_K), share_(share) {}

  /// Call when a power or coefficient has jumped, with this time and state.
  void begin(double time_s, const double* theta, int n);
  /// Call after a step. @param low_K, high_K    coldest and warmest surrounding or prescribed temperature at this time
  /// @param heats, cools  whether some source has power > 0, < 0
  void step(double time_s, const double* theta, int n, double low_K, double high_K, bool heats, bool cools);
  /// One entry per jump that caused an overshoot.
  [[nodiscard]] std::vector<Overshoot> result() const;

 private:
  double least_K_;
  const Share* share_;
  double low_K_ = 0.0, high_K_ = 0.0;
  Overshoot worst_;
  std::vector<Overshoot> found_;
};

}  // namespace driftwright::solver
