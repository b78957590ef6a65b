#pragma once
// Quasi-static thermo-elasticity: K u = G θ, with small strains and the free strain α θ.
//
//     K = ∫ B'D B dV + springs of joints and supports,   G θ = ∫ B'D ε_th dV,   ε_th = θ (α_x, α_y, α_z, 0, 0, 0)
//
// θ is the temperature above that at which the machine is straight and free of stress. Outputs d = l'u become influence
// vectors g = G'K⁻¹l: one solve per output, then one dot product per time.
// Source of the formulas: Zienkiewicz, Taylor & Zhu, The Finite Element Method, vol. 1, ch. 2 and 6.

#include <memory>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/heat_assembly.hpp"
#include "solver/mechanics.hpp"

namespace driftwright::solver {

/// Σ weight u(node) along a direction: a displacement, a difference of two, or an angle.
struct DisplacementFunctional {
  struct Term {
    int node;
    Eigen::Vector3d weight;
  };
  std::vector<Term> terms;
};

/// How K u = f is solved.
enum class ElasticMethod { kAutomatic, kFactor, kMultigrid };

/// Largest number of unknowns at which a Cholesky factor is always used. Up to here it takes a fraction of a second, and
/// each further solve is cheap. Above, multigrid takes less time in total for few solves, and far less memory. A factor is
/// faster from 10 solves at 57 000 unknowns and from 20 at 279 000 (docs/theory/performance.md), if it fits into half of the
/// memory.
inline constexpr int kMostUnknownsToFactorise = 20000;
[[nodiscard]] bool factor_pays(int n_unknowns, int n_solves);

/// Relative tolerance of multigrid solutions in the norm of K. The error of a displacement d = l'K⁻¹f is then below this
/// times sqrt(l'K⁻¹l f'K⁻¹f): for a machine of 1e8 N/m that is strained by 10 K, 1e-10 x 1e-4 x 20 = 2e-13 m. The required
/// accuracy is 1e-10 m; the margin covers parts on springs that are a million times softer than the parts.
inline constexpr double kElasticTolerance = 1e-10;

/// The method of an Elasticity and its cost.
struct ElasticReport {
  ElasticMethod method = ElasticMethod::kAutomatic;  ///< the method used
  int n_unknowns = 0;
  double factor_bytes = 0.0;  ///< of the factor, if there is one
  int most_iterations = 0;    ///< of multigrid, in the solves so far
  std::string text;           ///< for the user
};

/// The elastic machine, ready for any number of loads. Not thread-safe.
class Elasticity {
 public:
  /// @param joints    those that are not tied
  /// @param n_solves  expected number of solves, influence vectors and fields; used to choose the method
  /// @param share     the part of this process; null: it computes everything. The mesh is the whole one
  /// @throws SolveError  when the factorisation fails for lack of memory; later, when multigrid does not converge
  /// @throws InputError  when supports and joints leave a part free to move (it names part and motion), for unknown joints
  ///                     and joints whose sides do not touch, and for an invalid material: E > 0, -1 < nu < 0.5, finite
  ///                     expansion
  Elasticity(const mesh::Mesh& mesh, const RegionMaterials& materials, const std::vector<Support>& supports,
             const std::vector<JointMechanics>& joints = {}, ElasticMethod method = ElasticMethod::kAutomatic,
             int n_solves = 3, std::shared_ptr<const Share> share = nullptr);
  ~Elasticity();
  Elasticity(Elasticity&&) noexcept;

  [[nodiscard]] const ElasticReport& report() const;

  /// K⁻¹l, 3 n_nodes; ThermalLoad::transposed() turns it into an influence vector. With a share: of the nodes of its part.
  [[nodiscard]] Eigen::VectorXd response(const DisplacementFunctional& functional) const;
  /// Influence vector over the mesh's nodes [unit of the functional per K].
  [[nodiscard]] Eigen::VectorXd influence(const DisplacementFunctional& functional) const;

  /// Displacement of all nodes, 3 x n_nodes [m], for temperatures θ of the nodes [K] (of longer vectors only the first
  /// n_nodes are used). Nodes in no cell do not move.
  [[nodiscard]] Eigen::Matrix3Xd displacement(const Eigen::VectorXd& theta) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
