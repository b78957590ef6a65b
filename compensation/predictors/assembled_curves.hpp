#pragma once
// Drift of any cyclogram put together from heating and cooling curves at fixed speeds, as the paper does it.
//
// Each channel for itself. At a change of speed the curve of the new speed is entered where it has the level reached so far:
// - to a speed whose curve passes that level: along its heating curve from there on (stepwise up, intermittent on);
// - to standstill: along the cooling curve measured after the speed just run, from where it has that level; a level above that curve's start
//   shrinks with it in proportion (intermittent off);
// - down to a speed whose curve never reaches the level (stepwise down), where the paper says that steps are required and not which: the excess over the
//   steady level of the new speed falls as the cooling curve after that speed does, δ = δ∞(n) + (δ0 - δ∞(n)) c(t) / c(0). This rule is ours.
// Curves between tested speeds are linear in speed at equal times. The ambient is not looked at: the tests' own is in their curves.
// A channel whose heating curve turns round has two times at one level, and one whose level lies beyond both curves has none: the first time, or the
// nearest level, is then taken; the method is no good there.
// Source: Polyakov, Marusich & Nikitina.

#include "compensation/predictors/identified_modes.hpp"

namespace driftwright::compensation {

/// What kind of cyclogram the paper calls it.
enum class CyclogramType { kContinuous, kStepwiseUp, kIntermittent, kStepwiseDown, kChaotic };
[[nodiscard]] CyclogramType type_of(const Cyclogram& cyclogram);
[[nodiscard]] const char* word(CyclogramType type);

class AssembledCurves {
 public:
  /// @param tests  each: heating at one speed from the start, then standstill
  /// @throws InputError  for a test of another form, two tests of one speed
  AssembledCurves(const std::vector<ThermalTest>& tests, const TestChannels& channels);

  /// As IdentifiedModes::predict(), the ambient left out.
  [[nodiscard]] Eigen::MatrixXd predict(const Cyclogram& cyclogram, const std::vector<double>& output_s,
                                        bool extrapolate = false) const;

 private:
  struct Curves {
    double speed_rpm = 0.0;
    Eigen::MatrixXd heating, cooling;  ///< n_channels x n_times from the change on, every kStep_s
  };
  [[nodiscard]] Curves at(double speed_rpm) const;

  std::vector<Curves> curves_;  ///< by speed
  std::size_t n_channels_ = 0;
};

}  // namespace driftwright::compensation
