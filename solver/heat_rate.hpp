#pragma once
// The heat into each unknown at a state: f(u) - K(u) θ - r(θ), its tangent, and each flow by name. Time integration and
// steady state both use it.

#include <vector>

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Evaluates these for the current drive and time.
class HeatRate {
 public:
  /// @param system  borrowed
  explicit HeatRate(const FullSystem& system);

  /// Sets drive and time of a stretch in which laws change with temperatures only.
  /// @param time_s  within the stretch, not at its ends
  /// @return true if a power or a coefficient that does not depend on the state has changed
  bool set(const Drive& drive, double time_s, std::string_view run = {});

  /// Net heat into each unknown [W], n long, at θ. Additive, as all flows, where several processes share the system.
  void evaluate(const double* theta, double ambient_K, double* heat_W);

  /// Each flow of flows() [W] at the θ of the last evaluate().
  void flows_W(const double* theta, double ambient_K, double* flows_W) const;
  /// Derivative of the flows along dθ, with the coefficients of films, links and radiation of the last evaluate().
  void flows_along(const double* dtheta, double* dflows_W) const;
  [[nodiscard]] const std::vector<HeatFlow>& flows() const { return flows_; }

  /// Smallest and largest power of any source at the last evaluate() [W]; zero without sources.
  [[nodiscard]] std::pair<double, double> power_range_W() const;

  /// Symmetric tangent -d(heat)/dθ [W/K], with the laws' probes held constant, at the θ of the last evaluate(). Its pattern
  /// is that of K0.
  [[nodiscard]] const SparseRow& tangent(const double* theta, double ambient_K);

  /// Absolute temperature of thermostat i's probe [K].
  [[nodiscard]] double thermostat_probe_K(int i, const double* theta, double ambient_K) const;
  [[nodiscard]] bool thermostat_is_on(int i) const { return thermostat_on_[i]; }
  /// Switches a thermostat; call set() afterwards.
  void set_thermostat(int i, bool on) { thermostat_on_[i] = on; }

 private:
  /// A sparse vector.
  struct Sparse {
    std::vector<int> index;
    std::vector<double> value;
    explicit Sparse(const Eigen::VectorXd& dense);
    [[nodiscard]] double dot(const double* x) const;
    void add_to(double factor, double* y) const;
  };
  struct Source {
    Sparse load;
    double power_W = 0.0;
  };
  struct Crossing {
    Sparse flow, to_ambient, offset;
    std::vector<int> slots;  ///< of the exchange's matrix in the common pattern
    double coefficient = 0.0;
  };
  void look_at_state(const double* theta, double ambient_K);
  [[nodiscard]] double of_probe(std::size_t probe, double mean_K, double ambient_K) const;
  [[nodiscard]] double value_of(const BoundLaw& law) const;

  const FullSystem& system_;
  std::vector<HeatFlow> flows_;  ///< sources, exchanges, nonlinear terms to the ambient; each in the system's order
  std::vector<Sparse> probes_;
  std::vector<Source> sources_;
  std::vector<Crossing> crossings_;
  std::vector<char> thermostat_on_;
  effects::Inputs inputs_;
  std::vector<double> probe_K_;
  bool looks_at_state_ = false;
  bool is_set_ = false;
  // The part that does not depend on the state, summed: heat = steady_load + θ_ambient steady_to_ambient - steady_matrix θ -
  // ...
  SparseRow steady_matrix_, tangent_;
  Eigen::VectorXd steady_load_, steady_to_ambient_, product_;
};

}  // namespace driftwright::solver
