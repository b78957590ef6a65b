#pragma once
// A heat flow that is not linear in the temperatures, such as radiation or conduction with a temperature-dependent
// conductivity.

#include <Eigen/Core>
#include <string>

#include "solver/sparse.hpp"

namespace driftwright::solver {

/// Adds -r(θ) to M dθ/dt: r is the heat [W] that leaves each unknown. θ: temperature minus the reference temperature [K].
class NonlinearTerm {
 public:
  explicit NonlinearTerm(std::string term_name) : name(std::move(term_name)) {}
  virtual ~NonlinearTerm() = default;

  /// r += r(θ).
  virtual void add_heat_out(const double* theta, double ambient_K, double* r_W) const = 0;

  /// k += dr/dθ [W/K] without its antisymmetric part; entries exist in k's pattern.
  virtual void add_tangent(const double* theta, double ambient_K, SparseRow& k) const = 0;

  /// Adds the pairs of unknowns that the tangent couples and the cells may not.
  virtual void add_cliques(Cliques&) const {}

  /// Heat that leaves the surface [W], for a term that is reported as a separate flow (radiation).
  [[nodiscard]] virtual double heat_out_W(const double*, double) const { return 0.0; }
  [[nodiscard]] virtual bool is_flow() const { return false; }
  [[nodiscard]] virtual bool reaches_ambient() const { return false; }

  std::string name;
};

}  // namespace driftwright::solver
