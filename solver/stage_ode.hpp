#pragma once
// A thermal system in the form that integrate() needs: slopes, and implicit stages that it solves itself. The state consists
// of the unknowns and the heats of the flows, which are integrated with the same stage weights, so that heat balances.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Interface of the full and the reduced model.
class StageOde {
 public:
  virtual ~StageOde() = default;

  /// Number of unknowns and flows.
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] virtual const std::vector<HeatFlow>& flows() const = 0;
  [[nodiscard]] virtual const std::vector<Thermostat>& thermostats() const = 0;

  /// Puts the state at t = 0 into y and sets thermostats: on where the probe is above on_above_K.
  virtual void begin(const Eigen::VectorXd& start, double* y) = 0;
  /// Allowed error of each entry of the state for an allowed temperature error. Heats do not affect the step size.
  virtual void tolerances(double absolute_K, double* tolerance) const = 0;
  /// Begins a stretch of constant drive and linear ambient. May change the meaning of the state's unknowns and convert y; it
  /// then returns true.
  /// @return true if some power or coefficient jumps
  virtual bool begin_stretch(const LinearStretch& stretch, double* y) = 0;
  /// Call if the next state is not the end of the last step.
  virtual void restart(double t_s, const double* y) = 0;

  /// Distance of thermostat i's probe from its next switching point [K]; zero at the switch.
  [[nodiscard]] virtual double distance_to_switch_K(int i, double t_s, const double* y) const = 0;
  /// Switches a thermostat; call begin_stretch() afterwards.
  virtual void toggle(int i) = 0;

  /// dy/dt at the start of a step.
  virtual void slopes(double t_s, const double* y, double* ydot) = 0;
  /// Solves a stage for c = s + γ dy/dt(predicted + c).
  /// @param weight  1 / allowed error of each entry
  /// @return false if its iterations do not converge
  [[nodiscard]] virtual bool solve_stage(double t_s, double gamma, const double* predicted, const double* s,
                                         const double* weight, double* c) = 0;
  /// dy/dt at the start and end of the last step, from values that are already computed.
  [[nodiscard]] virtual const double* slope_at_start() const = 0;
  [[nodiscard]] virtual const double* slope_at_end() const = 0;
  /// True if slope_at_start() is a slope right after a jump, accurate only to its solve's tolerance.
  [[nodiscard]] virtual bool starts_rough() const { return false; }

  /// Checks the state after a step. @throws SolveError  at temperatures that no machine has
  virtual void look(double t_s, const double* y) = 0;
  [[nodiscard]] virtual std::vector<Overshoot> overshoots() const { return {}; }

  /// The outputs of a state.
  [[nodiscard]] virtual Eigen::VectorXd observe(const double* y, double ambient_K) const = 0;
  /// The unknowns in the caller's coordinates.
  [[nodiscard]] virtual Eigen::VectorXd state(const double* y) const = 0;
  /// Heats of all flows and change of the stored heat since the start [J].
  [[nodiscard]] virtual Eigen::VectorXd heats_J(const double* y) const = 0;
  [[nodiscard]] virtual double stored_J(const double* y) const = 0;

  /// Of a state that several processes share; null: one has all of it.
  [[nodiscard]] virtual const Share* share() const { return nullptr; }
  [[nodiscard]] virtual int n_solves() const { return 0; }
  [[nodiscard]] virtual int n_iterations() const { return 0; }
};

/// @throws SolveError  at temperatures that no machine has: below absolute zero, or above the melting point of every part
void require_sane(const double* theta, int n, double reference_K, double t_s);
/// The exception of require_sane(): first the reason, then temperature and time.
class TemperatureOutOfBounds : public SolveError {
 public:
  TemperatureOutOfBounds(double temperature_K, double time_s);
  double temperature_K, time_s;
};

}  // namespace driftwright::solver
