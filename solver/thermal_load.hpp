#pragma once
// G θ = ∫ B'D ε_th dV and G' u, computed cell by cell: only the mesh is stored.
//
// With an isotropic D the stress that suppresses a free strain is normal, s_i = λ (α_x + α_y + α_z) + 2 μ α_i along axis i.
// So (G θ)_3a+i = ∫ s_i θ dN_a/dx_i dV, (G' u)_a = ∫ N_a Σ_i s_i du_i/dx_i dV.
// Source: Zienkiewicz, Taylor & Zhu, The Finite Element Method, vol. 1, ch. 2.

#include <Eigen/Core>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/heat_assembly.hpp"

namespace driftwright::solver {

/// The operators G and G' of a mesh.
class ThermalLoad {
 public:
  /// Copies coordinates and cells.
  ThermalLoad(const mesh::Mesh& mesh, const RegionMaterials& materials);
  /// G θ: 3 n_nodes [N] from n_nodes [K].
  [[nodiscard]] Eigen::VectorXd forces_N(const Eigen::VectorXd& theta_K) const;
  /// G' u: n_nodes from 3 n_nodes; u [m] gives [N m/K].
  [[nodiscard]] Eigen::VectorXd transposed(const Eigen::VectorXd& u) const;

 private:
  template <int From, int To, class Cell>
  Eigen::VectorXd gather(const Eigen::VectorXd& from, const Cell& of_cell) const;

  mesh::Mesh mesh_;                           // coordinates and cells alone
  std::vector<Eigen::Vector3d> stress_Pa_K_;  // s, per region
};

}  // namespace driftwright::solver
