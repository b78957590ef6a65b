#pragma once
// Temperature-dependent conductivity and heat capacity: their difference from the matrices at the reference temperature.

#include <memory>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/material.hpp"
#include "solver/nonlinear_term.hpp"
#include "solver/sparse.hpp"

namespace driftwright::solver {

/// The term r_i = ∫ (k(T) - k(T_ref)) ∇T·∇N_i dV over the cells whose conductivity varies; null if none does.
[[nodiscard]] std::shared_ptr<const NonlinearTerm> variable_conduction(const mesh::Mesh& mesh,
                                                                       const std::vector<Material>& materials,
                                                                       double reference_K);

/// The cells whose material has a temperature-dependent heat capacity.
class VariableCapacity {
 public:
  /// Null if no material has one. Copies the needed parts of the mesh.
  [[nodiscard]] static std::shared_ptr<const VariableCapacity> of(const mesh::Mesh& mesh,
                                                                  const std::vector<Material>& materials,
                                                                  double reference_K);

  /// mass += ∫ ρ (c(T) - c(T_ref)) N_i N_j dV.
  void add_to(const double* theta, SparseRow& mass) const;
  /// ∫ N_i ρ ∫_{T_ref}^{T} (c - c(T_ref)) dT dV for each of n unknowns [J]: the heat content that belongs to add_to().
  [[nodiscard]] Eigen::VectorXd heat_content_J(const double* theta, int n) const;

  struct Cell {
    std::vector<int> nodes;
    int curve = 0;
    std::vector<double> mass_kg;  ///< of each quadrature point
    Eigen::MatrixXd N;            ///< n_points x n_nodes
  };

 private:
  std::vector<PropertyCurve> curves_;
  std::vector<Cell> cells_;
  double reference_K_ = 293.15;
};

}  // namespace driftwright::solver
