#pragma once
// Thermal modes from tests alone: each channel is a sum of first-order states that all channels share.
//
//     y_c(t) = Σ_k a_ck(t),   a_ck' = λ_k(n) (A_ck(n) + H_ck θ_ambient - a_ck),   x = n / N,   λ_k(n) = (1 + g x^0.7) / τ_k
//
// Over a section at constant speed that is the sum of exponentials of heating and cooling tests, T = Σ A (1 - e^(-t/τ)) + Σ B e^(-t/τ); what goes
// beyond it is that states live on when the speed changes, that rates grow with speed as forced films do (one g for all modes), and that steady
// levels A between the tested speeds follow one polynomial of x, with a level of its own at standstill. Steady levels are linear in the data;
// τ_k and g are found by variable projection. All channels start at 0, in balance with the ambient.
// Source: Polyakov, Marusich & Nikitina (thermal modes); Golub & Pereyra, SIAM J. Numer. Anal. 10 (1973) 413-432.

#include "compensation/predictors/thermal_test.hpp"

namespace driftwright::compensation {

struct IdentifiedModes {
  struct Mode {
    double time_constant_s = 0.0;      ///< at standstill
    double low_s = 0.0, high_s = 0.0;  ///< 95 % confidence of it
    double growth = 0.0;               ///< g: by how much its rate is larger at the top speed
  };
  std::vector<Mode> modes;  ///< slowest first
  TestChannels channels;
  std::vector<Eigen::MatrixXd> level;    ///< per mode, n_channels x n_powers
  std::vector<Eigen::VectorXd> ambient;  ///< per mode, H of each channel
  TestedSpeeds tested;                   ///< its top is N
  double held_out_error = 0.0;  ///< root mean square in units of the noise, speeds left out of the fit one at a time

  /// Channels at the times asked for, n_channels x n_times. @param ambient  minus its temperature at the start [K]
  /// @throws InputError  as require_tested()
  [[nodiscard]] Eigen::MatrixXd predict(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                        const std::vector<double>& output_s, bool extrapolate = false) const;
};

struct IdentificationOptions {
  int most_modes = 4;          ///< one more as long as it takes 3 % off the held-out error
  int powers = 4;              ///< levels a mode has: one at standstill, the others a polynomial of x of degree powers - 2
  double mean_over_s = 300.0;  ///< readings are averaged over so long before the fit
  bool with_growth = true;     ///< false: one set of time constants for all speeds
};

/// @throws InputError  for fewer speeds above 0 than powers - 1, rows that do not fit, times that do not increase, missing readings
/// @throws SolveError  when no time constants are found
[[nodiscard]] IdentifiedModes identify_modes(const std::vector<ThermalTest>& tests, const TestChannels& channels,
                                             const IdentificationOptions& options = {});

}  // namespace driftwright::compensation
