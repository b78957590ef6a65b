#pragma once
// The full model as SUNDIALS sees it: right-hand side, mass matrix and linear solves. The state is θ followed by the heats Q
// of the flows, so that heat is integrated with the stage weights and balances to rounding:
//
//     M dθ/dt = heat(θ, t),   dQ/dt = flows(θ, t)
//
// Unknowns of prescribed temperature g(t) are rows dθ/dt = dg/dt; the heat that holds them there is
// ∫ -1'heat dt + 1'M (θ - θ_0) over those rows. Where heat capacity varies, M(θ) dθ/dt = heat is handed over as
// M_ref dθ/dt = M_ref M(θ)⁻¹ heat, since ARKODE's mass matrix may not depend on the state.

#include "base/cyclogram.hpp"
#include "solver/heat_rate.hpp"
#include "solver/pcg.hpp"

namespace driftwright::solver {

class HeatOde {
 public:
  /// @param system, hall  borrowed
  HeatOde(const FullSystem& system, const TimeSeries& hall, double pcg_tolerance_K);

  /// Unknowns and flows.
  [[nodiscard]] int size() const { return n_ + n_flows(); }
  [[nodiscard]] int n_flows() const { return static_cast<int>(flows_.size()); }
  [[nodiscard]] const std::vector<HeatFlow>& flows() const { return flows_; }

  /// Sets prescribed unknowns of a state to their temperature at t. @return the heat that takes, per flow [J]
  Eigen::VectorXd prescribe(double t_s, double* y) const;
  /// Begins a stretch of constant drive and linear hall. @return true when some power or coefficient jumps
  bool begin_stretch(const LinearStretch& stretch);
  /// Thermostats at the start: on where the probe is above on_above_K. Call begin_stretch() afterwards.
  void set_thermostats(double t_s, const double* y);
  /// Zero where thermostat i switches next [K].
  [[nodiscard]] double distance_to_switch_K(int i, double t_s, const double* y) const;
  /// Smallest and largest power of any source at the last rhs [W].
  [[nodiscard]] std::pair<double, double> power_range_W() const { return rate_.power_range_W(); }
  void toggle(int i) { rate_.set_thermostat(i, !rate_.thermostat_is_on(i)); }

  void rhs(double t_s, const double* y, double* ydot);
  void multiply_mass(const double* x, double* mx) const;
  /// (M + γ K) x = b.
  void solve_shifted(double gamma, const double* b, double* x);
  void solve_mass(const double* b, double* x);

  /// Heats of all flows since the start [J].
  [[nodiscard]] Eigen::VectorXd heats_J(const double* y, const double* start) const;
  /// Change of the stored heat since the start [J].
  [[nodiscard]] double stored_J(const double* y, const double* start) const;

  [[nodiscard]] int n_solves() const { return n_solves_; }
  [[nodiscard]] int n_iterations() const { return n_iterations_; }

 private:
  void run(Pcg& solver, const double* b, double* x);
  /// Rows and columns of prescribed unknowns become those of the identity.
  void decouple(SparseRow& a) const;
  /// mass_now_ = M(θ), and what prescribed slopes take from it.
  void update_mass(const double* theta);
  void refresh_shifted(double gamma);

  const FullSystem& system_;
  const TimeSeries& hall_;
  double tolerance_K_;
  int n_;
  HeatRate rate_;
  std::vector<HeatFlow> flows_;    ///< of the rate, then of prescribed unknowns
  std::vector<char> is_fixed_;     ///< per unknown; empty where none is
  std::vector<double> slope_K_s_;  ///< of each set of prescribed unknowns, in the present stretch
  Eigen::VectorXd mass_slope_;     ///< M dg/dt
  SparseRow mass_;                 ///< at the reference temperature, decoupled
  SparseRow mass_now_;             ///< M(θ), decoupled; used where heat capacity varies
  SparseRow shifted_;
  const SparseRow* shifted_stiffness_ = nullptr;  ///< the tangent in shifted_; owned by rate_
  double gamma_ = -1.0;
  Eigen::VectorXd last_theta_;  ///< of the last rhs: where the tangent is taken
  double last_hall_K_ = 0.0;
  Eigen::VectorXd free_ones_, mass_warm_, work_;
  Pcg shifted_solver_, mass_solver_, mass_now_solver_;
  int n_solves_ = 0, n_iterations_ = 0;
};

}  // namespace driftwright::solver
