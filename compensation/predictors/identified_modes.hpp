#pragma once
// Thermal modes identified from tests alone: each channel is a sum of first-order states that all channels share.
//
//     y_c(t) = Σ_k a_ck(t),   a_ck' = λ_k(n) (A_ck(n) + H_ck θ_ambient - a_ck),   x = n / N,   λ_k(n) = (1 + g x^0.7) / τ_k
//
// Over a section at constant speed this is the sum of exponentials of heating and cooling tests, T = Σ A (1 - e^(-t/τ)) + Σ
// B e^(-t/τ). It extends that sum in three ways: states continue when the speed changes; rates grow with speed as forced
// films do (one g for all modes); steady levels A between the tested speeds follow one polynomial of x, with a separate
// level at standstill. Steady levels are linear in the data; τ_k and g are found by variable projection. All channels start
// at 0, in balance with the ambient.
// Source: Polyakov, Marusich & Nikitina (thermal modes); Golub & Pereyra, SIAM J. Numer. Anal. 10 (1973) 413-432.

#include "compensation/predictors/thermal_test.hpp"

namespace driftwright::compensation {

/// The identified model.
struct IdentifiedModes {
  struct Mode {
    double time_constant_s = 0.0;      ///< at standstill
    double low_s = 0.0, high_s = 0.0;  ///< its 95 % interval
    double growth = 0.0;               ///< g: relative increase of its rate at the top speed
  };
  std::vector<Mode> modes;  ///< slowest first
  TestChannels channels;
  std::vector<Eigen::MatrixXd> level;    ///< per mode, n_channels x n_powers
  std::vector<Eigen::VectorXd> ambient;  ///< per mode, H for each channel
  TestedSpeeds tested;                   ///< its top speed is N

  /// Channels at the requested times, n_channels x n_times. @param ambient  minus its temperature at the start [K]
  /// @throws InputError  as require_tested()
  [[nodiscard]] Eigen::MatrixXd predict(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                        const std::vector<double>& output_s, bool extrapolate = false) const;
};

struct IdentificationOptions {
  int most_modes = 4;  ///< modes are added while each reduces the held-out error by at least 3 %
  int powers = 4;      ///< number of levels per mode: one at standstill, the others a polynomial of x of degree powers - 2
  double mean_over_s = 300.0;  ///< readings are averaged over this time before the fit
  bool with_growth = true;     ///< false: one set of time constants for all speeds
};

/// @throws InputError  for fewer speeds above 0 than powers - 1, arrays of different lengths, times that do not increase,
///                     missing readings
/// @throws SolveError  when no time constants are found
[[nodiscard]] IdentifiedModes identify_modes(const std::vector<ThermalTest>& tests, const TestChannels& channels,
                                             const IdentificationOptions& options = {});

}  // namespace driftwright::compensation
