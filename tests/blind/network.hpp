#pragma once
// The thermal matrices of a machine and, separately, its laws, for the blind cases' own time integration.
//
//     M dθ/dt = -K(u) θ + f(u),   K = K0 + Σ_e c_e G_e,   f = Σ_s P_s b_s + Σ_e c_e (θ_ambient g_e + gradient o_e)
//
// The matrices come from the solver; laws, steps and stages do not.

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"
#include "effects/heat_balance.hpp"
#include "solver/sparse.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::blind {

template <class Matrix>
struct Network {
  double reference_K = 293.15;
  Matrix mass, conduction;
  std::vector<Eigen::VectorXd> sources;  ///< b_s
  struct Exchange {
    Matrix matrix;            ///< G_e
    Eigen::VectorXd ambient;  ///< g_e
    Eigen::VectorXd offset;   ///< o_e [m^2 m] for a gradient of 1 K/m of the ambient air, or empty
  };
  std::vector<Exchange> exchanges;
  std::map<std::string, Eigen::VectorXd> means;  ///< weights of the mean temperature of regions and nodes
  Eigen::MatrixXd outputs;                       ///< size x n_outputs
  Eigen::VectorXd outputs_ambient;               ///< share of the ambient temperature

  [[nodiscard]] Eigen::Index size() const { return mass.rows(); }
};
using FullNetwork = Network<solver::SparseRow>;
using SmallNetwork = Network<Eigen::MatrixXd>;

/// Laws in the order of the network's sources and exchanges, as in a heat balance: films, links, contacts.
struct Laws {
  std::vector<effects::Law> powers_W, coefficients;
  double gradient_K_m = 0.0;  ///< of the ambient air
};
[[nodiscard]] Laws laws_of(const effects::HeatBalance& balance);

/// Surroundings and drive of a run.
struct Run {
  Cyclogram drive;                          ///< the true one; sections begin at multiples of the step
  std::function<double(double)> ambient_K;  ///< true ambient temperature minus the reference at a time [s]
  double duration_s = 0.0;
  double step_s = 20.0;
};

/// Outputs at 0, step, 2 step, ... (n_outputs x n_times), from the reference temperature.
///
/// SDIRK of order 2 with two stages, γ = 1 - 1/√2, L-stable (Alexander, SIAM J. Numer. Anal. 14 (1977) 1006-1021), with
/// constant steps, divided by four for two minutes after each change of drive or coefficients, since an air pocket
/// responds within seconds. Powers are evaluated at the stages; powers that depend on temperatures use those of the
/// stage, by two rounds of substitution. Coefficients are those of the middle of the step and must not depend on
/// temperatures.
/// @throws std::logic_error  for a coefficient that depends on temperatures
[[nodiscard]] Eigen::MatrixXd integrate(const FullNetwork& network, const Laws& laws, const Run& run);
[[nodiscard]] Eigen::MatrixXd integrate(const SmallNetwork& network, const Laws& laws, const Run& run);

}  // namespace driftwright::blind
