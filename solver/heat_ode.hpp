#pragma once
// The full model in the form that SUNDIALS needs: slopes and implicit stages. The state is θ followed by the heats Q of the
// flows, so that heat is integrated with the stage weights and balances to rounding:
//
//     dθ/dt = M⁻¹ heat(θ, t),   dQ/dt = flows(θ, t)
//
// A stage z = y + c requires c = s + γ dθ/dt(z), with s from the stages before. It is solved as M (c - s) = γ heat(y + c): a
// system with M + γ K, without M⁻¹. The slope of a stage is then (c - s) / γ. Only a restart needs a solve with M itself.
//
// Unknowns with a prescribed temperature g(t) are rows dθ/dt = dg/dt; the heat that holds them at g is
// ∫ -1'heat dt + 1'M (θ - θ_0) over those rows. Where heat capacity varies, M is M(θ).
//
// Where several processes share a system (share.hpp), each integrates the unknowns of its part, with copies, and its own
// part of each flow; steps and iterations are the same on all.

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "solver/heat_rate.hpp"
#include "solver/multigrid.hpp"
#include "solver/overshoot.hpp"
#include "solver/pcg.hpp"
#include "solver/slope_space.hpp"
#include "solver/stage_ode.hpp"

namespace driftwright::solver {

class HeatOde : public StageOde {
 public:
  /// @param system, ambient  borrowed
  /// @param absolute_K    allowed error of a step; linear solves use a small share of it
  /// @param worth_multigrid  with more unknowns than this, multigrid is the preconditioner if the diagonal needs many
  ///                     iterations
  HeatOde(const FullSystem& system, const TimeSeries& ambient, double absolute_K, int worth_multigrid = kWorthMultigrid);
  static constexpr int kWorthMultigrid = 5000;

  [[nodiscard]] int size() const override { return n_ + n_flows(); }
  [[nodiscard]] const std::vector<HeatFlow>& flows() const override { return flows_; }
  [[nodiscard]] const std::vector<Thermostat>& thermostats() const override { return system_.thermostats; }
  /// A prescribed temperature that differs from its start value jumps at once; the heat of this jump is part of the balance.
  void begin(const Eigen::VectorXd& start, double* y) override;
  void tolerances(double absolute_K, double* tolerance) const override;
  bool begin_stretch(const LinearStretch& stretch, double* y) override;
  void restart(double t_s, const double* y) override;
  [[nodiscard]] double distance_to_switch_K(int i, double t_s, const double* y) const override;
  void toggle(int i) override { rate_.set_thermostat(i, !rate_.thermostat_is_on(i)); }
  /// The slope of the stage that ended the last step, if known, else from a solve with M.
  void slopes(double t_s, const double* y, double* ydot) override;
  [[nodiscard]] bool solve_stage(double t_s, double gamma, const double* predicted, const double* s, const double* weight,
                                 double* c) override;
  [[nodiscard]] const double* slope_at_start() const override { return at_start_.value.data(); }
  [[nodiscard]] bool starts_rough() const override { return at_start_.is_rough; }
  [[nodiscard]] const double* slope_at_end() const override { return latest_.value.data(); }
  void look(double t_s, const double* y) override;
  [[nodiscard]] std::vector<Overshoot> overshoots() const override { return watch_.result(); }
  [[nodiscard]] Eigen::VectorXd observe(const double* y, double ambient_K) const override;
  [[nodiscard]] Eigen::VectorXd state(const double* y) const override;
  [[nodiscard]] Eigen::VectorXd heats_J(const double* y) const override;
  [[nodiscard]] double stored_J(const double* y) const override;
  [[nodiscard]] const Share* share() const override { return share_; }
  [[nodiscard]] int n_solves() const override { return n_solves_; }
  [[nodiscard]] int n_iterations() const override { return n_iterations_; }

 private:
  struct Slope {
    double t_s = 0.0;
    bool is_known = false;
    bool is_rough = false;  ///< from a solve with M: it contains jumps and bends unsmoothed
    Eigen::VectorXd value;  ///< of unknowns and flows
  };

  [[nodiscard]] int n_flows() const { return static_cast<int>(flows_.size()); }
  void forget_slopes();
  [[nodiscard]] double stored_J(const double* y, const double* start) const;
  void count(const PcgOutcome& outcome);
  /// Rows and columns of prescribed unknowns become those of the identity.
  void decouple(SparseRow& a) const;
  void zero_fixed(double* x) const;
  void evaluate(double t_s, const double* theta);
  void refresh_shifted(double gamma);
  void solve_linear_stage(double gamma);
  /// The preconditioner for M + γ K; nullptr if its diagonal is used.
  [[nodiscard]] const Preconditioner* multigrid_for(double gamma);
  /// An additive vector made consistent, and a sum over all processes.
  void add_copies(Eigen::VectorXd& x) const;
  [[nodiscard]] double of_all(double own) const;
  [[nodiscard]] bool solve_nonlinear_stage(double t_s, double gamma, const double* weight);
  void close_balance(double t_s, double gamma);
  /// Heat into the prescribed unknowns of set f at the state of the last evaluation plus x [W].
  [[nodiscard]] double heat_into_fixed_W(std::size_t f, const double* x) const;
  [[nodiscard]] const SparseRow& mass_here() const { return system_.capacity ? mass_now_ : system_.mass; }

  const FullSystem& system_;
  const TimeSeries& ambient_;
  const Share* share_;  ///< null: this process has the whole system. Else n_ is the number of unknowns of its part
  double tolerance_K_;
  int n_, n_whole_;
  int worth_multigrid_ = kWorthMultigrid;
  bool is_affine_;
  HeatRate rate_;
  std::vector<HeatFlow> flows_;      ///< of the rate, then of prescribed unknowns
  std::vector<char> is_fixed_;       ///< per unknown; empty where none is
  std::vector<int> fixed_unknowns_;  ///< of all sets
  std::vector<double> slope_K_s_;    ///< of each set of prescribed unknowns, in the current stretch
  SparseRow mass_;                   ///< at the reference temperature, decoupled
  SparseRow mass_now_;               ///< M(θ); used if heat capacity varies
  SparseRow shifted_;
  const SparseRow* stiffness_ = nullptr;  ///< the tangent in shifted_; owned by rate_
  double gamma_ = -1.0;
  Eigen::VectorXd free_ones_, mass_ones_, mass_free_ones_;  ///< mass_ones_ = M 1, mass_free_ones_ = M free_ones_
  std::vector<Eigen::VectorXd> mass_fixed_ones_;            ///< M times the members of each prescribed set
  Eigen::VectorXd residual_scale_;
  Eigen::VectorXd base_, gathered_, heat_, x_, residual_, work_, flow_W_;  ///< of the current stage
  double ambient_K_ = 0.0;                                                 ///< of the last evaluation
  Slope at_start_, latest_;
  SlopeSpace space_;
  Pcg shifted_solver_;
  std::vector<std::pair<double, std::unique_ptr<Preconditioner>>> multigrids_;  ///< γ, and the multigrid made for it
  double least_multigrid_gamma_ = std::numeric_limits<double>::infinity();
  Eigen::VectorXd began_, jump_J_;                ///< the state at t = 0, and the heat of each flow in the jump to it
  std::vector<std::vector<int>> output_entries_;  ///< indices of the nonzero entries, per output
  OvershootWatch watch_;
  int n_solves_ = 0, n_iterations_ = 0;
};

}  // namespace driftwright::solver
