#pragma once
// One thermal system, two sizes. The finite-element model (sparse) and its reduced model (dense) are both
//
//     M dθ/dt = -K(u) θ + f(u),    y = L'θ + l_hall θ_hall
//     K(u) = K0 + Σ_e c_e(u) G_e,  f(u) = Σ_s P_s(u) b_s + θ_hall Σ_e c_e(u) g_e,   g_e = G_e 1
//
// θ: temperature minus the reference temperature [K]. u: effects::Inputs. Everything that may change (films, joints, links)
// is an Exchange whose matrix is fixed and whose coefficient is a number: nothing is assembled twice.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "effects/heat_balance.hpp"
#include "solver/sparse.hpp"

namespace driftwright::solver {

/// Heat P(u) [W] spread over the unknowns by b (sums to one in the finite-element model).
struct HeatSource {
  std::string name;
  Eigen::VectorXd load;
  effects::Law power_W;
};

/// Heat flow c(u) G θ between unknowns, or from them to the hall where G 1 != 0.
template <class Matrix>
struct Exchange {
  std::string name;
  Matrix matrix;             ///< G, symmetric, in [m^2] for films and joints and [1] for links
  Eigen::VectorXd to_hall;   ///< g = G 1 of the finite-element model (projected in a reduced one)
  double hall_sum = 0.0;     ///< 1'G 1: surface exposed to the hall [m^2]
  effects::Law coefficient;  ///< c(u) [W/(m^2 K)], or [W/K] for links
};

/// What is read off the state: sensor temperatures, displacements, tilts. Column j of `state` is output j.
struct Outputs {
  std::vector<std::string> name;
  std::vector<std::string> unit;  ///< "K", "m" or "rad"
  Eigen::MatrixXd state;          ///< n_unknowns x n_outputs
  Eigen::VectorXd hall;           ///< n_outputs; share of the hall's temperature
};

template <class Matrix>
struct ThermalSystem {
  Matrix mass;        ///< M [J/K]
  Matrix conduction;  ///< K0 [W/K]
  std::vector<HeatSource> sources;
  std::vector<Exchange<Matrix>> exchanges;
  Outputs outputs;
  Eigen::VectorXd ones;  ///< the state "1 K everywhere" (projected in a reduced system), for the energy balance

  [[nodiscard]] int size() const { return static_cast<int>(mass.rows()); }

  /// f(u) [W].
  [[nodiscard]] Eigen::VectorXd load(const effects::Inputs& u) const {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(size());
    for (const HeatSource& s : sources) f += s.power_W(u) * s.load;
    for (const auto& e : exchanges) {
      if (e.hall_sum != 0.0) f += e.coefficient(u) * u.hall_K * e.to_hall;
    }
    return f;
  }
  /// Outputs of a state.
  [[nodiscard]] Eigen::VectorXd observe(const Eigen::VectorXd& state, double hall_K) const {
    return outputs.state.transpose() * state + hall_K * outputs.hall;
  }
};

using FullSystem = ThermalSystem<SparseRow>;
using ReducedSystem = ThermalSystem<Eigen::MatrixXd>;

/// A simulated run: outputs at the times asked for, and the heat that flowed.
struct Trajectory {
  std::vector<double> time_s;
  Eigen::MatrixXd outputs;  ///< n_outputs x n_times, in K, m, rad
  /// Heat since t = 0 [J], n_flows x n_times: sources first (> 0 heats), then exchanges with the hall (> 0 leaves).
  Eigen::MatrixXd heat_J;
  std::vector<std::string> flow_names;
  int n_sources = 0;
  Eigen::VectorXd stored_J;  ///< change of the heat stored since t = 0, per time

  int n_steps = 0, n_solves = 0, n_iterations = 0;

  /// |heat in - stored - lost| at the last time over the largest of the three [-].
  [[nodiscard]] double energy_gap() const;
};

}  // namespace driftwright::solver
