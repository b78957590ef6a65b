#pragma once
// The observer's extended Kalman filter: the equations alone. Which readings it may use is judged elsewhere
// (observer_run.cpp).

#include <map>
#include <span>
#include <vector>

#include "compensation/predictors/observer.hpp"

namespace driftwright::compensation {

/// During one run: a normal distribution over, in this order, the reduced state z, the factors of sources and exchanges
/// (minus 1), the factor on the drift (minus 1), and the offset of the indicator's zero [m]. Equations: Observer.
class ObserverFilter {
 public:
  using Belief = Observer::Belief;

  /// The first three are borrowed for the life of the filter.
  /// @param learned     mean and covariance of the factors at the start, and what their means return to
  /// @param with_drift  the drift is measured: factors walk at random instead of returning to what was learned
  ObserverFilter(const solver::ReducedSystem& system, const ObserverSettings& settings, const Belief& learned,
                 Eigen::Index drift_output, bool with_drift);

  /// Sets the state at the start of the run.
  void begin(const Eigen::VectorXd& state);
  /// Advances by h_s with constant drive and ambient.
  void step(const effects::Inputs& at, double h_s);
  /// The drive of the steps between these two calls is unknown: at the end the state is less certain by all that each source
  /// may have done, between its extremes of rest and of this run. @{
  void begin_gap();
  void end_gap();
  /// @}
  /// A reading with the gradient h over all variables, at this distance from its expected value.
  void correct(const Eigen::VectorXd& h, double innovation, double variance);
  /// A measured drift at this distance [m] from the expected one, before the zero of the indicator. @param variance  [m²]
  void correct_drift(double residual_m, double variance);

  /// Expected reading of an output in K, as a thermometer shows it [degC].
  [[nodiscard]] double reading_C(Eigen::Index output, double ambient_K) const;
  [[nodiscard]] Eigen::VectorXd reading_gradient(Eigen::Index output) const;
  /// All outputs, in K, m, rad.
  [[nodiscard]] Eigen::VectorXd outputs(double ambient_K) const;
  /// Drift since the start of the run: the scale of the displacement does not apply to earlier drift.
  /// @param ambient_rise_K  of the ambient, since the start
  [[nodiscard]] double drift_m(double ambient_rise_K) const;
  [[nodiscard]] double drift_deviation_m() const;
  /// h'P h, the variance of an expected reading.
  [[nodiscard]] double variance_along(const Eigen::VectorXd& h) const;
  /// The factors alone, as `learned`.
  [[nodiscard]] Belief factors() const;

  [[nodiscard]] const Belief& belief() const { return belief_; }
  void restore(const Belief& belief) { belief_ = belief; }

  /// All of its state as numbers, for a file; restored from as many. @{
  [[nodiscard]] std::size_t n_numbers() const;
  void add_numbers(std::vector<double>& numbers) const;
  void take_numbers(std::span<const double> numbers);
  /// @}

 private:
  /// A step with constant drive: z+ = decay z + gain f.
  struct Step {
    Eigen::MatrixXd decay, gain;
    std::vector<double> power_W, coefficient;
  };

  const Step& step_of(const effects::Inputs& u, double h_s);
  void forget_factors(Eigen::Index n_factors, double h_s);
  [[nodiscard]] double unscaled_drift_m() const;
  [[nodiscard]] Eigen::VectorXd drift_gradient() const;

  const solver::ReducedSystem& s_;
  const ObserverSettings& settings_;
  const Belief& learned_;
  Eigen::Index drift_output_;
  bool with_drift_;
  Eigen::Index n_ = 0, n_sources_ = 0, n_exchanges_ = 0;
  Eigen::Index scale_ = 0, zero_ = 0;  // of the drift: its factor, and the indicator's reading at the start of the run
  Belief belief_;
  Eigen::VectorXd start_state_;
  Eigen::VectorXd least_W_, most_W_;  // of each source in this run
  Eigen::MatrixXd unseen_;            // effect of each source's unknown power on the state, during a gap
  std::map<std::vector<double>, Step> steps_;
};

}  // namespace driftwright::compensation
