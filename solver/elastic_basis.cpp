#include "solver/elastic_basis.hpp"

#include "solver/stiffness_assembly.hpp"

namespace driftwright::solver {
namespace {

constexpr double kNothingNew = 1e-8;  // of a column's length: rounding of elastic solutions

std::vector<char> not_free(const mesh::Mesh& mesh, const std::vector<bool>& fixed) {
  std::vector<char> held(fixed.size(), 1);  // nodes in no cell
  for (const int node : mesh.cells.node) {
    for (int i = 0; i < 3; ++i) held[static_cast<std::size_t>(3 * node + i)] = fixed[static_cast<std::size_t>(3 * node + i)];
  }
  return held;
}

}  // namespace

RowMatrix turned(const mesh::Mesh& mesh, const std::vector<mesh::Motion>& motions, const RowMatrix& vectors) {
  RowMatrix result = vectors;
  std::vector<char> is_done(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const Eigen::Matrix3d& turn = motions[static_cast<std::size_t>(mesh.cells.group[cell])].turn;
    if (turn == Eigen::Matrix3d::Identity()) continue;
    for (const int node : mesh.cells.nodes(cell)) {
      if (is_done[static_cast<std::size_t>(node)]++) continue;
      result.middleRows<3>(3 * node) = turn * vectors.middleRows<3>(3 * node);
    }
  }
  return result;
}

Eigen::MatrixXd stiffness_with(const ElasticBasis& basis, const RowMatrix& w, std::span<const SpringLayer> layers) {
  Eigen::MatrixXd k = basis.stiffness;
  for (const SpringLayer& layer : layers) {
    RowMatrix jump = RowMatrix::Zero(3 * static_cast<Eigen::Index>(layer.size()), w.cols()), force = jump;
    for (std::size_t p = 0; p < layer.size(); ++p) {
      const SpringPoint& point = layer[p];
      auto of_point = jump.middleRows<3>(3 * static_cast<Eigen::Index>(p));
      for (std::size_t i = 0; i < point.node.size(); ++i) of_point += point.weight[i] * w.middleRows<3>(3 * point.node[i]);
      force.middleRows<3>(3 * static_cast<Eigen::Index>(p)) = point.stiffness_N_m * of_point;
    }
    k.noalias() += jump.transpose() * force;
  }
  return 0.5 * (k + k.transpose());
}

Eigen::MatrixXd projected(const RowMatrix& w, std::span<const DisplacementFunctional> functionals) {
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(w.cols(), static_cast<Eigen::Index>(functionals.size()));
  for (std::size_t i = 0; i < functionals.size(); ++i) {
    for (const auto& [node, weight] : functionals[i].terms)
      loads.col(static_cast<Eigen::Index>(i)) += w.middleRows<3>(3 * node).transpose() * weight;
  }
  return loads;
}

ElasticBasisMaker::ElasticBasisMaker(const mesh::Mesh& mesh, const RegionMaterials& materials,
                                     const std::vector<bool>& fixed)
    : cells_(assemble_stiffness(mesh, materials, {}, not_free(mesh, fixed))),
      load_(mesh, materials),
      basis_{RowMatrix(3 * mesh.n_nodes(), 0), Eigen::MatrixXd(0, 0)},
      force_(0, mesh.n_nodes()) {}

void ElasticBasisMaker::add(const Eigen::MatrixXd& columns) {
  const Eigen::Index before = basis_.displacement.cols();
  Eigen::MatrixXd w = basis_.displacement;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    Eigen::VectorXd v = columns.col(c);
    const double length = v.norm();
    for (int pass = 0; pass < 3; ++pass) v -= w * (w.transpose() * v);
    const double rest = v.norm();
    if (!(rest > kNothingNew * length)) continue;
    w.conservativeResize(Eigen::NoChange, w.cols() + 1);
    w.rightCols(1) = v / rest;
  }
  const Eigen::Index size = w.cols(), fresh = size - before;
  if (fresh == 0) return;
  Eigen::MatrixXd kw(w.rows(), fresh);
  force_.conservativeResize(size, Eigen::NoChange);
  for (Eigen::Index c = 0; c < fresh; ++c) {
    multiply(cells_, w.col(before + c).data(), kw.col(c).data());
    force_.row(before + c) = load_.transposed(w.col(before + c)).transpose();
  }
  basis_.displacement = w;
  const Eigen::MatrixXd border = w.transpose() * kw;
  Eigen::MatrixXd& k = basis_.stiffness;
  k.conservativeResize(size, size);
  k.rightCols(fresh) = border;
  k.bottomRows(fresh) = border.transpose();
  k.bottomRightCorner(fresh, fresh) = 0.5 * (border.bottomRows(fresh) + border.bottomRows(fresh).transpose());
}

}  // namespace driftwright::solver
