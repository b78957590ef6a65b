#pragma once
// dz/dt of a reduced system whose laws look at temperatures, at any state and time:
//
//     M dz/dt = f + θ_ambient h - K z + Σ_s P_s(z) b_s - Σ_e c_e(z) (G_e z - θ_ambient g_e - o_e)
//
// with sums over the laws that look at the state; those that follow drive and time alone are within f, h and K.

#include "base/cyclogram.hpp"
#include "solver/stretches.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

class LiveRate {
 public:
  /// @param system  borrowed, as is the ambient; its thermostats are off
  LiveRate(const ReducedSystem& system, const TimeSeries& ambient);

  [[nodiscard]] bool is_on(std::size_t thermostat) const { return is_on_[thermostat] != 0; }
  /// Call enter() afterwards.
  void toggle(std::size_t thermostat) {
    is_on_[thermostat] ^= 1;
    has_toggled_ = true;
  }

  /// Takes over drive and time of a stretch, the same one or the next. @return true when a power or a coefficient that does not look at the state is another one
  bool enter(const LinearStretch& stretch);
  /// dz/dt in the stretch entered last.
  void rate(double t_s, const Eigen::VectorXd& z, Eigen::VectorXd& dz_dt);
  /// Its derivative by z.
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
  double start_s_ = 0.0, start_ambient_K_ = 0.0, ambient_K_s_ = 0.0;  ///< of the stretch, in which the ambient is a line
  std::vector<double> probe_K_;
  std::vector<double> followed_;  ///< values of the laws that do not look at the state, 0 where a thermostat has them off
  std::vector<std::size_t> looked_at_;  ///< probes of the laws that do
  LawChanges changes_;
  bool has_entered_ = false, has_toggled_ = false;
  Eigen::MatrixXd conduction_;
  Eigen::VectorXd load_, to_ambient_;
};

}  // namespace driftwright::solver
