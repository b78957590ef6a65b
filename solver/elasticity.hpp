#pragma once
// Quasi-static thermo-elasticity: K u = G θ, with small strains, isotropic materials and strain α θ.
//
//     K = ∫ B'D B dV + joints,   G θ = ∫ B'D ε_th dV,   ε_th = α θ (1,1,1,0,0,0)
//
// Outputs d = l'u become influence vectors g = G'K⁻¹l: one solve per output, then a dot product per time.
// Source of the formulas: Zienkiewicz, Taylor & Zhu, The Finite Element Method, vol. 1, ch. 2 and 6.

#include <array>
#include <memory>

#include "mesh/mesh.hpp"
#include "solver/heat_assembly.hpp"

namespace driftwright::solver {

/// A surface held in some directions.
struct Support {
  std::string surface;
  std::array<bool, 3> fixed = {true, true, true};  ///< x, y, z
};

/// Σ weight u(node) along a direction: a displacement, a difference of two, or an angle.
struct DisplacementFunctional {
  struct Term {
    int node;
    Eigen::Vector3d weight;
  };
  std::vector<Term> terms;
};

/// The factorised elastic machine. Joints are tied: springs a thousand times stiffer than the parts over one facet.
class Elasticity {
 public:
  /// @throws SolveError  when the factorisation fails for want of memory
  /// @throws InputError  when the supports leave a part free to move
  Elasticity(const mesh::Mesh& mesh, const RegionMaterials& materials, const std::vector<Support>& supports);
  ~Elasticity();
  Elasticity(Elasticity&&) noexcept;

  /// Influence vector over the mesh's nodes [unit of the functional per K].
  [[nodiscard]] Eigen::VectorXd influence(const DisplacementFunctional& functional) const;

  /// Displacement of all nodes, 3 x n_nodes [m], under temperatures θ of the nodes [K] (longer vectors: the head counts).
  [[nodiscard]] Eigen::Matrix3Xd displacement(const Eigen::VectorXd& theta) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
