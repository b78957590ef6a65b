#pragma once
// Drift of any cyclogram, assembled from heating and cooling curves at fixed speeds, as in the paper.
//
// Each channel separately. At a change of speed the curve of the new speed is entered where it has the level reached so far:
// - to a speed whose curve passes that level: along its heating curve from there on (stepwise up, intermittent on);
// - to standstill: along the cooling curve measured after the previous speed, from where it has that level; a level above
//   that curve's start is scaled in proportion (intermittent off);
// - down to a speed whose curve never reaches the level (stepwise down). The paper says that steps are required but not
//   which ones; this rule is our own: the excess over the steady level of the new speed falls like the cooling curve after
//   that speed, δ = δ∞(n) + (δ0 - δ∞(n)) c(t) / c(0).
// Curves between tested speeds are linear in speed at equal times. The ambient is not used; the curves contain the ambient
// of the tests. A channel whose heating curve is not monotone has two times at one level, and a level beyond both curves has
// none: then the first time, or the nearest level, is used; the method is poor there.
// Source: Polyakov, Marusich & Nikitina.

#include "compensation/predictors/identified_modes.hpp"

namespace driftwright::compensation {

/// The paper's name for a kind of cyclogram.
enum class CyclogramType { kContinuous, kStepwiseUp, kIntermittent, kStepwiseDown, kChaotic };
[[nodiscard]] CyclogramType type_of(const Cyclogram& cyclogram);
[[nodiscard]] const char* word(CyclogramType type);

class AssembledCurves {
 public:
  /// @param tests  each: heating at one speed from the start, then standstill
  /// @throws InputError  for a test of another form, two tests of one speed
  AssembledCurves(const std::vector<ThermalTest>& tests, const TestChannels& channels);

  /// As IdentifiedModes::predict(), without the ambient.
  [[nodiscard]] Eigen::MatrixXd predict(const Cyclogram& cyclogram, const std::vector<double>& output_s,
                                        bool extrapolate = false) const;

 private:
  struct Curves {
    double speed_rpm = 0.0;
    Eigen::MatrixXd heating, cooling;  ///< n_channels x n_times from the change of speed on, every kStep_s
  };
  [[nodiscard]] Curves at(double speed_rpm) const;

  std::vector<Curves> curves_;  ///< by speed
  std::size_t n_channels_ = 0;
};

}  // namespace driftwright::compensation
