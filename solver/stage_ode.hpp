#pragma once
// A thermal system as integrate() sees it: slopes, and implicit stages that it solves by its own means. The state is the unknowns
// followed by the heats of the flows, which are integrated with the same stage weights so that heat balances.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

class StageOde {
 public:
  virtual ~StageOde() = default;

  /// Unknowns and flows.
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] virtual const std::vector<HeatFlow>& flows() const = 0;
  [[nodiscard]] virtual const std::vector<Thermostat>& thermostats() const = 0;

  /// Puts the state at t = 0 into y and sets thermostats: on where the probe is above on_above_K.
  virtual void begin(const Eigen::VectorXd& start, double* y) = 0;
  /// Error allowed of each entry of the state, where this much is allowed of a temperature. Heats follow, they do not steer.
  virtual void tolerances(double absolute_K, double* tolerance) const = 0;
  /// Begins a stretch of constant drive and linear ambient. May change what the state's unknowns mean, and y with them: then it returns true.
  /// @return true when some power or coefficient jumps
  virtual bool begin_stretch(const LinearStretch& stretch, double* y) = 0;
  /// Call when the next state is not the end of the last step.
  virtual void restart(double t_s, const double* y) = 0;

  /// Zero where thermostat i switches next [K].
  [[nodiscard]] virtual double distance_to_switch_K(int i, double t_s, const double* y) const = 0;
  /// Call begin_stretch() afterwards.
  virtual void toggle(int i) = 0;

  /// dy/dt at the start of a step.
  virtual void slopes(double t_s, const double* y, double* ydot) = 0;
  /// Solves a stage for c = s + γ dy/dt(predicted + c).
  /// @param weight  1 over the error allowed of each entry
  /// @return false where its iterations do not converge
  [[nodiscard]] virtual bool solve_stage(double t_s, double gamma, const double* predicted, const double* s,
                                         const double* weight, double* c) = 0;
  /// dy/dt where the last step began and where it ended, by what has been computed for it.
  [[nodiscard]] virtual const double* slope_at_start() const = 0;
  [[nodiscard]] virtual const double* slope_at_end() const = 0;
  /// Whether slope_at_start() is that of a jump, by no more than its solve's tolerance.
  [[nodiscard]] virtual bool starts_rough() const { return false; }

  /// Looks at the state after a step. @throws SolveError  at temperatures that no machine has
  virtual void look(double t_s, const double* y) = 0;
  [[nodiscard]] virtual std::vector<Overshoot> overshoots() const { return {}; }

  /// What is read off a state.
  [[nodiscard]] virtual Eigen::VectorXd observe(const double* y, double ambient_K) const = 0;
  /// The unknowns as the caller knows them.
  [[nodiscard]] virtual Eigen::VectorXd state(const double* y) const = 0;
  /// Heats of all flows and change of the stored heat since the start [J].
  [[nodiscard]] virtual Eigen::VectorXd heats_J(const double* y) const = 0;
  [[nodiscard]] virtual double stored_J(const double* y) const = 0;

  [[nodiscard]] virtual int n_solves() const { return 0; }
  [[nodiscard]] virtual int n_iterations() const { return 0; }
};

/// @throws SolveError  at temperatures that no machine has: below absolute zero, or above what melts any part of it
void require_sane(const double* theta, int n, double reference_K, double t_s);
/// What it throws: why first, then temperature and time.
class TemperatureOutOfBounds : public SolveError {
 public:
  TemperatureOutOfBounds(double temperature_K, double time_s);
  double temperature_K, time_s;
};

}  // namespace driftwright::solver
