#pragma once
// The full model as SUNDIALS sees it: slopes and implicit stages. The state is θ followed by the heats Q of the flows, so that
// heat is integrated with the stage weights and balances to rounding:
//
//     dθ/dt = M⁻¹ heat(θ, t),   dQ/dt = flows(θ, t)
//
// A stage z = y + c wants c = s + γ dθ/dt(z) with s from the stages before, which is solved as M (c - s) = γ heat(y + c): a system
// with M + γ K, and no M⁻¹. The slope of a stage then is (c - s) / γ. Only a restart takes a solve with M itself.
//
// Unknowns of prescribed temperature g(t) are rows dθ/dt = dg/dt; the heat that holds them there is
// ∫ -1'heat dt + 1'M (θ - θ_0) over those rows. Where heat capacity varies, M is M(θ).

#include <limits>
#include <utility>
#include <vector>

#include "base/cyclogram.hpp"
#include "solver/heat_rate.hpp"
#include "solver/multigrid.hpp"
#include "solver/pcg.hpp"
#include "solver/slope_space.hpp"

namespace driftwright::solver {

class HeatOde {
 public:
  /// @param system, hall  borrowed
  /// @param tolerance_K   about the largest error of a linear solve
  HeatOde(const FullSystem& system, const TimeSeries& hall, double tolerance_K);

  /// Unknowns and flows.
  [[nodiscard]] int size() const { return n_ + n_flows(); }
  [[nodiscard]] int n_flows() const { return static_cast<int>(flows_.size()); }
  [[nodiscard]] const std::vector<HeatFlow>& flows() const { return flows_; }

  /// Sets prescribed unknowns of a state to their temperature at t. @return the heat that takes, per flow [J]
  Eigen::VectorXd prescribe(double t_s, double* y) const;
  /// Begins a stretch of constant drive and linear hall. @return true when some power or coefficient jumps
  bool begin_stretch(const LinearStretch& stretch);
  /// Call when the next state is not the end of the last step.
  void forget_slopes();
  /// Thermostats at the start: on where the probe is above on_above_K. Call begin_stretch() afterwards.
  void set_thermostats(double t_s, const double* y);
  /// Zero where thermostat i switches next [K].
  [[nodiscard]] double distance_to_switch_K(int i, double t_s, const double* y) const;
  /// Smallest and largest power of any source at the last evaluation [W].
  [[nodiscard]] std::pair<double, double> power_range_W() const { return rate_.power_range_W(); }
  void toggle(int i) { rate_.set_thermostat(i, !rate_.thermostat_is_on(i)); }

  /// dy/dt at the start of a step: that of the stage which ended the last one, else by a solve with M.
  void slopes(double t_s, const double* y, double* ydot);
  /// Solves a stage for c = s + γ dy/dt(predicted + c).
  /// @param weight  1 over the error allowed of each unknown, for Newton's iterations
  /// @return false where these do not converge
  [[nodiscard]] bool solve_stage(double t_s, double gamma, const double* predicted, const double* s, const double* weight,
                                 double* c);

  /// dy/dt where the last step began and where it ended, by what has been computed for it.
  [[nodiscard]] const double* slope_at_start() const { return at_start_.value.data(); }
  [[nodiscard]] bool starts_rough() const { return at_start_.is_rough; }
  [[nodiscard]] const double* slope_at_end() const { return latest_.value.data(); }

  /// Heats of all flows since the start [J].
  [[nodiscard]] Eigen::VectorXd heats_J(const double* y, const double* start) const;
  /// Change of the stored heat since the start [J].
  [[nodiscard]] double stored_J(const double* y, const double* start) const;

  [[nodiscard]] int n_solves() const { return n_solves_; }
  [[nodiscard]] int n_iterations() const { return n_iterations_; }

 private:
  struct Slope {
    double t_s = 0.0;
    bool is_known = false;
    bool is_rough = false;  ///< by a solve with M: whatever has just jumped or bent is still sharp in it
    Eigen::VectorXd value;  ///< of unknowns and flows
  };

  void count(const PcgOutcome& outcome);
  /// Rows and columns of prescribed unknowns become those of the identity.
  void decouple(SparseRow& a) const;
  void zero_fixed(double* x) const;
  void evaluate(double t_s, const double* theta);
  void refresh_shifted(double gamma);
  void solve_linear_stage(double gamma);
  /// What conditions M + γ K; nullptr where its diagonal does.
  [[nodiscard]] const Multigrid* multigrid_for(double gamma);
  [[nodiscard]] bool solve_nonlinear_stage(double t_s, double gamma, const double* weight);
  void close_balance(double t_s, double gamma);
  /// Heat into the prescribed unknowns of set f at the state evaluated last plus x [W].
  [[nodiscard]] double heat_into_fixed_W(std::size_t f, const double* x) const;
  [[nodiscard]] const SparseRow& mass_here() const { return system_.capacity ? mass_now_ : system_.mass; }

  const FullSystem& system_;
  const TimeSeries& hall_;
  double tolerance_K_;
  int n_;
  bool is_affine_;
  HeatRate rate_;
  std::vector<HeatFlow> flows_;      ///< of the rate, then of prescribed unknowns
  std::vector<char> is_fixed_;       ///< per unknown; empty where none is
  std::vector<int> fixed_unknowns_;  ///< of all sets
  std::vector<double> slope_K_s_;    ///< of each set of prescribed unknowns, in the present stretch
  SparseRow mass_;                   ///< at the reference temperature, decoupled
  SparseRow mass_now_;               ///< M(θ); used where heat capacity varies
  SparseRow shifted_;
  const SparseRow* stiffness_ = nullptr;  ///< the tangent in shifted_; owned by rate_
  double gamma_ = -1.0;
  Eigen::VectorXd free_ones_, mass_ones_, mass_free_ones_;  ///< mass_ones_ = M 1, mass_free_ones_ = M free_ones_
  std::vector<Eigen::VectorXd> mass_fixed_ones_;            ///< M times the members of each prescribed set
  Eigen::VectorXd residual_scale_;
  Eigen::VectorXd base_, gathered_, heat_, x_, residual_, work_, flow_W_;  ///< of the present stage
  double hall_K_ = 0.0;                                                    ///< of the last evaluation
  Slope at_start_, latest_;
  SlopeSpace space_;
  Pcg shifted_solver_;
  std::vector<std::pair<double, Multigrid>> multigrids_;  ///< γ, and the one made for it
  double least_multigrid_gamma_ = std::numeric_limits<double>::infinity();
  int n_solves_ = 0, n_iterations_ = 0;
};

}  // namespace driftwright::solver
