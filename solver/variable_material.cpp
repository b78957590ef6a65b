#include "solver/variable_material.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "mesh/shape.hpp"

namespace driftwright::solver {
namespace {

struct ConductingCell {
  std::vector<int> nodes;
  int curve = 0;
  std::vector<double> volume_m3;           // of each quadrature point
  Eigen::MatrixXd N;                       // n_points x n_nodes
  std::vector<Eigen::Matrix3Xd> gradient;  // of each point, 3 x n_nodes
};

Eigen::VectorXd gather(const std::vector<int>& nodes, const double* theta) {
  Eigen::VectorXd local(static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) local[static_cast<Eigen::Index>(i)] = theta[nodes[i]];
  return local;
}

class VariableConduction : public NonlinearTerm {
 public:
  explicit VariableConduction(double reference_K)
      : NonlinearTerm("conductivity over temperature"), reference_K_(reference_K) {}

  void add_heat_out(const double* theta, double, double* r_W) const override {
    for (const ConductingCell& cell : cells_) {
      const Eigen::VectorXd local = gather(cell.nodes, theta), out = tangent(cell, local) * local;
      for (std::size_t i = 0; i < cell.nodes.size(); ++i) r_W[cell.nodes[i]] += out[static_cast<Eigen::Index>(i)];
    }
  }
  void add_tangent(const double* theta, double, SparseRow& k) const override {
    for (const ConductingCell& cell : cells_) scatter_add(k, cell.nodes, tangent(cell, gather(cell.nodes, theta)));
  }

  std::vector<PropertyCurve> curves;
  void add(ConductingCell cell) { cells_.push_back(std::move(cell)); }

 private:
  /// ∫ (k(T) - k(T_ref)) ∇N_i·∇N_j dV: r is this times θ; also its derivative, without the change of k.
  [[nodiscard]] Eigen::MatrixXd tangent(const ConductingCell& cell, const Eigen::VectorXd& local) const {
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(local.size(), local.size());
    const PropertyCurve& curve = curves[cell.curve];
    const double at_reference = curve.at(reference_K_);
    for (std::size_t p = 0; p < cell.gradient.size(); ++p) {
      const double t_K = reference_K_ + cell.N.row(static_cast<Eigen::Index>(p)).dot(local);
      k += cell.volume_m3[p] * (curve.at(t_K) - at_reference) * cell.gradient[p].transpose() * cell.gradient[p];
    }
    return k;
  }

  std::vector<ConductingCell> cells_;
  double reference_K_;
};

}  // namespace

std::shared_ptr<const NonlinearTerm> variable_conduction(const mesh::Mesh& mesh, const std::vector<Material>& materials,
                                                         double reference_K) {
  auto term = std::make_shared<VariableConduction>(reference_K);
  for (const Material& m : materials) term->curves.push_back(m.conductivity_curve);
  if (std::all_of(materials.begin(), materials.end(), [](const Material& m) { return m.conductivity_curve.empty(); }))
    return nullptr;
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const int group = mesh.cells.group[c];
    if (term->curves[group].empty()) continue;
    const mesh::CellShape shape = mesh.cells.shape[c];
    const auto nodes = mesh.cells.nodes(c);
    const auto x = mesh::cell_coords(mesh, nodes);
    const auto rule = mesh::mass_rule(shape);  // finer than for a constant k, because the curve bends within a cell
    ConductingCell cell{{nodes.begin(), nodes.end()}, group, {}, Eigen::MatrixXd(rule.size(), nodes.size()), {}};
    for (std::size_t p = 0; p < rule.size(); ++p) {
      const mesh::ShapeValues s = mesh::shape_values(shape, rule[p].xi);
      const mesh::Jacobian j = mesh::jacobian(s, x, shape);
      cell.volume_m3.push_back(rule[p].weight * j.det);
      cell.N.row(static_cast<Eigen::Index>(p)) = s.N.head(s.n);
      cell.gradient.emplace_back(j.dx_dxi.inverse().transpose() * s.dN.leftCols(s.n));
    }
    term->add(std::move(cell));
  }
  return term;
}

std::shared_ptr<const VariableCapacity> VariableCapacity::of(const mesh::Mesh& mesh, const std::vector<Material>& materials,
                                                             double reference_K) {
  if (std::all_of(materials.begin(), materials.end(), [](const Material& m) { return m.heat_capacity_curve.empty(); }))
    return nullptr;
  auto capacity = std::make_shared<VariableCapacity>();
  capacity->reference_K_ = reference_K;
  for (const Material& m : materials) capacity->curves_.push_back(m.heat_capacity_curve);
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const int group = mesh.cells.group[c];
    if (capacity->curves_[group].empty()) continue;
    const mesh::CellShape shape = mesh.cells.shape[c];
    const auto nodes = mesh.cells.nodes(c);
    const auto x = mesh::cell_coords(mesh, nodes);
    const auto rule = mesh::mass_rule(shape);
    Cell cell{{nodes.begin(), nodes.end()}, group, {}, Eigen::MatrixXd(rule.size(), nodes.size())};
    for (std::size_t p = 0; p < rule.size(); ++p) {
      const mesh::ShapeValues s = mesh::shape_values(shape, rule[p].xi);
      cell.mass_kg.push_back(materials[group].density_kg_m3 * rule[p].weight * mesh::jacobian(s, x, shape).det);
      cell.N.row(static_cast<Eigen::Index>(p)) = s.N.head(s.n);
    }
    capacity->cells_.push_back(std::move(cell));
  }
  return capacity;
}

void VariableCapacity::add_to(const double* theta, SparseRow& mass) const {
  for (const Cell& cell : cells_) {
    const PropertyCurve& curve = curves_[cell.curve];
    const double at_reference = curve.at(reference_K_);
    const Eigen::VectorXd theta_at = cell.N * gather(cell.nodes, theta);
    Eigen::VectorXd gain(theta_at.size());
    for (Eigen::Index p = 0; p < gain.size(); ++p) {
      gain[p] = cell.mass_kg[p] * (curve.at(reference_K_ + theta_at[p]) - at_reference);
    }
    scatter_add(mass, cell.nodes, cell.N.transpose() * gain.asDiagonal() * cell.N);
  }
}

Eigen::VectorXd VariableCapacity::heat_content_J(const double* theta, int n) const {
  Eigen::VectorXd content_J = Eigen::VectorXd::Zero(n);
  for (const Cell& cell : cells_) {
    const PropertyCurve& curve = curves_[cell.curve];
    const double at_reference = curve.at(reference_K_);
    const Eigen::VectorXd theta_at = cell.N * gather(cell.nodes, theta);
    for (Eigen::Index p = 0; p < theta_at.size(); ++p) {
      const double heat_J =
          cell.mass_kg[p] * (curve.integral(reference_K_, reference_K_ + theta_at[p]) - at_reference * theta_at[p]);
      for (std::size_t i = 0; i < cell.nodes.size(); ++i)
        content_J[cell.nodes[i]] += heat_J * cell.N(p, static_cast<Eigen::Index>(i));
    }
  }
  return content_J;
}

}  // namespace driftwright::solver
