#pragma once
// dz/dt of a reduced system whose laws depend on temperatures, at any state and time:
//
//     M dz/dt = f + θ_ambient h - K z + Σ_s P_s(z) b_s - Σ_e c_e(z) (G_e z - θ_ambient g_e - o_e)
//
// with sums over the laws that depend on the state; f, h and K contain those that depend on drive and time alone.

#include "base/cyclogram.hpp"
#include "solver/stretches.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Evaluates dz/dt and its tangent.
class LiveRate {
 public:
  /// @param system  borrowed, like the ambient; its thermostats are off at first
  LiveRate(const ReducedSystem& system, const TimeSeries& ambient);

  [[nodiscard]] bool is_on(std::size_t thermostat) const { return is_on_[thermostat] != 0; }
  /// Call enter() afterwards.
  void toggle(std::size_t thermostat) {
    is_on_[thermostat] ^= 1;
    has_toggled_ = true;
  }

  /// Sets drive and time of a stretch, the same one or the next. @return true if a power or coefficient that does not depend
  /// on the state has changed
  bool enter(const LinearStretch& stretch);
  /// dz/dt in the current stretch.
  void rate(double t_s, const Eigen::VectorXd& z, Eigen::VectorXd& dz_dt);
  /// Derivative of rate() with respect to z.
  [[nodiscard]] Eigen::MatrixXd tangent(double t_s, const Eigen::VectorXd& z);

 private:
  struct Source {
    const BoundLaw* law;
    Eigen::VectorXd load;
  };
  struct Exchange {
    const BoundLaw* law;
    Eigen::MatrixXd matrix;
    Eigen::VectorXd to_ambient, offset;
  };
  [[nodiscard]] bool is_off(const BoundLaw& law) const {
    return law.thermostat >= 0 && is_on_[static_cast<std::size_t>(law.thermostat)] == 0;
  }
  [[nodiscard]] double value(const BoundLaw& law);
  void look(double t_s, const Eigen::VectorXd& z);

  const ReducedSystem& system_;
  const TimeSeries& ambient_;
  Eigen::MatrixXd per_mass_;  ///< M⁻¹; empty where M = 1
  std::vector<char> is_on_;
  std::vector<Source> sources_;
  std::vector<Exchange> exchanges_;
  effects::Inputs inputs_;
  double start_s_ = 0.0, start_ambient_K_ = 0.0, ambient_K_s_ = 0.0;  ///< of the stretch, in which the ambient is linear
  std::vector<double> probe_K_;
  std::vector<double> followed_;        ///< values of the laws that do not depend on the state, 0 where a thermostat is off
  std::vector<std::size_t> looked_at_;  ///< probes of the laws that depend on the state
  LawChanges changes_;
  bool has_entered_ = false, has_toggled_ = false;
  Eigen::MatrixXd conduction_;
  Eigen::VectorXd load_, to_ambient_;
};

}  // namespace driftwright::solver
