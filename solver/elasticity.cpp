#include "solver/elasticity.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "solver/conjugate_gradients.hpp"
#include "solver/multigrid.hpp"
#include "solver/rigid_motion.hpp"
#include "solver/share.hpp"
#include "solver/springs.hpp"
#include "solver/stiffness_assembly.hpp"
#include "solver/stiffness_factor.hpp"
#include "solver/thermal_load.hpp"

namespace driftwright::solver {
namespace {

using mesh::Mesh;

constexpr int kMostMultigridIterations = 500;  // some 20 are usual

void check_materials(const Mesh& mesh, const RegionMaterials& materials) {
  for (std::size_t r = 0; r < materials.size(); ++r) {
    const Material& m = materials[r];
    const std::string region = r < mesh.regions.size() ? mesh.regions[r] : "?";
    if (!(m.youngs_modulus_Pa > 0.0 && std::isfinite(m.youngs_modulus_Pa))) {
      throw InputError(
          fmt::format("region '{}': Young's modulus is {:g} Pa; it must be above zero", region, m.youngs_modulus_Pa));
    }
    if (!(m.poisson_ratio > -1.0 && m.poisson_ratio < 0.5)) {
      throw InputError(fmt::format("region '{}': Poisson's ratio is {:g}; -1 to 0.5, both excluded, is allowed", region,
                                   m.poisson_ratio));
    }
    for (double a_1_K : {m.expansion_1_K.x, m.expansion_1_K.y, m.expansion_1_K.z}) {
      if (!std::isfinite(a_1_K)) throw InputError(fmt::format("region '{}': the expansion is no finite number", region));
    }
  }
}

/// Nodes at which springs contribute more than half of the diagonal.
std::vector<int> held_stiffly(const NodeMatrix& k, const std::vector<SpringLayer>& layers) {
  std::vector<double> of_springs(k.n_rows, 0.0);
  for (const SpringLayer& layer : layers) {
    for (const SpringPoint& p : layer) {
      for (std::size_t i = 0; i < p.node.size(); ++i)
        of_springs[p.node[i]] += p.weight[i] * p.weight[i] * p.stiffness_N_m.trace();
    }
  }
  std::vector<int> nodes;
  for (int i = 0; i < k.n_rows; ++i) {
    if (of_springs[i] > 0.5 * k.block(k.find(i, i)).trace()) nodes.push_back(i);
  }
  return nodes;
}

double memory_bytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace

bool factor_pays(int n_unknowns, int n_solves) {
  return n_unknowns <= kMostUnknownsToFactorise || n_solves >= 10.0 * std::pow(n_unknowns / 57e3, 0.44);
}

struct Elasticity::Parts {
  Parts(const Mesh& mesh, const RegionMaterials& materials) : thermal_load(mesh, materials) {}

  ThermalLoad thermal_load;
  std::vector<char> held;  // not 0 for each dof 3 node + direction that cannot move
  mutable ElasticReport report;
  std::unique_ptr<StiffnessFactor> factor;  // either this or the following members
  NodeMatrix k;
  std::unique_ptr<Multigrid> multigrid;
  std::shared_ptr<const Share> share;  // with it, all of the above but the report are of its part, and this one solves
  std::unique_ptr<SharedElasticSolver> shared;

  Eigen::VectorXd solve(Eigen::VectorXd force) const {  // full length in, full length out, zero where fixed
    for (Eigen::Index i = 0; i < force.size(); ++i) {
      if (held[i]) force[i] = 0.0;
    }
    if (shared) {
      int iterations = 0;
      Eigen::VectorXd u = shared->solve(std::move(force), iterations);
      report.most_iterations = std::max(report.most_iterations, iterations);
      return u;
    }
    if (factor) return factor->solve(force);
    Eigen::VectorXd u(force.size());
    const CgOutcome outcome = conjugate_gradients(
        static_cast<int>(force.size()), [&](const double* x, double* y) { multiply(k, x, y); },
        [&](const double* r, double* z) { multigrid->precondition(r, z); }, force.data(), u.data(), kElasticTolerance,
        kMostMultigridIterations);
    report.most_iterations = std::max(report.most_iterations, outcome.iterations);
    if (!outcome.converged) {
      throw SolveError(
          fmt::format("elastic displacements: multigrid came to a relative error of {:.1e} in {} iterations, but {:.0e} is "
                      "required. Springs or materials differ too much in stiffness, or cells have almost no volume",
                      outcome.error, outcome.iterations, kElasticTolerance));
    }
    return u;
  }
};

Elasticity::~Elasticity() = default;
Elasticity::Elasticity(Elasticity&&) noexcept = default;

Elasticity::Elasticity(const Mesh& mesh, const RegionMaterials& materials, const std::vector<Support>& supports,
                       const std::vector<JointMechanics>& joints, ElasticMethod method, int n_solves,
                       std::shared_ptr<const Share> share) {
  check_materials(mesh, materials);
  parts_ = std::make_unique<Parts>(share ? share->mesh : mesh, materials);
  Parts& p = *parts_;
  const auto [fixed, layers] = holding(mesh, materials, supports, joints);
  p.held.assign(fixed.size(), 1);  // nodes in no cell have no stiffness
  for (int node : mesh.cells.node) {
    for (int i = 0; i < 3; ++i) p.held[3 * static_cast<std::size_t>(node) + i] = fixed[3 * node + i] ? 1 : 0;
  }
  ElasticReport& report = p.report;
  report.n_unknowns = static_cast<int>(std::count(p.held.begin(), p.held.end(), 0));
  if (share) {
    report.method = ElasticMethod::kFactor;
    report.text = fmt::format("elastic displacements by a factor over all processes: {} unknowns", report.n_unknowns);
    const std::vector<char> held = std::move(p.held);
    p.held.clear();
    for (int node : share->whole_node) p.held.insert(p.held.end(), &held[3 * node], &held[3 * node] + 3);
    p.shared = share->elastic_solver(assemble_stiffness(share->mesh, materials, {}, p.held), layers, held);
    p.share = std::move(share);
    return;
  }
  p.k = assemble_stiffness(mesh, materials, layers, p.held);
  report.method = method;
  if (method == ElasticMethod::kAutomatic) {
    report.method = factor_pays(report.n_unknowns, n_solves) ? ElasticMethod::kFactor : ElasticMethod::kMultigrid;
  }
  std::string instead;
  if (report.method == ElasticMethod::kFactor) {
    p.factor = std::make_unique<StiffnessFactor>(p.k);
    report.factor_bytes = p.factor->predicted_bytes();
    if (method == ElasticMethod::kAutomatic && report.factor_bytes > 0.5 * memory_bytes()) {
      instead = fmt::format("; a factor would take {:.1f} of {:.1f} GB", 1e-9 * report.factor_bytes, 1e-9 * memory_bytes());
      report.method = ElasticMethod::kMultigrid;
      p.factor.reset();
    }
  }
  if (report.method == ElasticMethod::kFactor) {
    p.k = {};
    p.factor->factorise();
    report.text = fmt::format("elastic displacements by a factor: {} unknowns, {:.1f} GB", report.n_unknowns,
                              1e-9 * report.factor_bytes);
  } else {
    p.multigrid = std::make_unique<Multigrid>(p.k, mesh.coords, held_stiffly(p.k, layers));
    report.text = fmt::format("elastic displacements by multigrid: {} unknowns{}", report.n_unknowns, instead);
  }
}

const ElasticReport& Elasticity::report() const {
  return parts_->report;
}

Eigen::VectorXd Elasticity::response(const DisplacementFunctional& functional) const {
  Eigen::VectorXd l = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parts_->held.size()));
  for (const auto& [node, weight] : functional.terms) {
    const int at = parts_->share ? parts_->share->held_index(node) : node;
    if (at >= 0) l.segment<3>(3 * static_cast<Eigen::Index>(at)) += weight;
  }
  return parts_->solve(std::move(l));
}
Eigen::VectorXd Elasticity::influence(const DisplacementFunctional& functional) const {
  return parts_->thermal_load.transposed(response(functional));
}

Eigen::Matrix3Xd Elasticity::displacement(const Eigen::VectorXd& theta) const {
  const Share* share = parts_->share.get();
  Eigen::VectorXd u = parts_->solve(parts_->thermal_load.forces_N(share ? share->part_of(theta) : theta));
  if (share) u = share->whole(u.data(), 3);
  return Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, u.size() / 3);
}

}  // namespace driftwright::solver
