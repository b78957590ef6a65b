#include "solver/reduced_model.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

namespace driftwright::solver {

Eigen::MatrixXd orthonormalise(const SparseRow& mass, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd basis(columns.rows(), columns.cols()), m_basis(columns.rows(), columns.cols());
  int kept = 0;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    Eigen::VectorXd v = columns.col(c), mv(columns.rows());
    multiply(mass, v.data(), mv.data());
    const double length = std::sqrt(v.dot(mv));
    for (int pass = 0; pass < 2; ++pass)
      v -= basis.leftCols(kept) * (m_basis.leftCols(kept).transpose() * v);  // two passes are enough
    multiply(mass, v.data(), mv.data());
    const double rest = std::sqrt(v.dot(mv));
    if (!(rest > 1e-10 * length)) continue;
    basis.col(kept) = v / rest;
    m_basis.col(kept) = mv / rest;
    ++kept;
  }
  return basis.leftCols(kept);
}

namespace {

Eigen::VectorXd times_ones(const SparseRow& mass, const Eigen::VectorXd& ones) {
  Eigen::VectorXd m_ones(ones.size());
  multiply(mass, ones.data(), m_ones.data());
  return m_ones;
}
Eigen::VectorXd times_ones(const Eigen::MatrixXd&, const Eigen::VectorXd& ones) {
  return ones;  // M = 1, and `ones` is already projected
}

template <class Matrix>
ReducedSystem projected(const ThermalSystem<Matrix>& system, const Eigen::MatrixXd& basis) {
  if (!system.nonlinear.empty() || system.capacity || !system.fixed.empty()) {
    throw std::logic_error("project: nonlinear terms, varying capacity and prescribed unknowns have no projection");
  }
  const auto reduce = [&](const Matrix& a) -> Eigen::MatrixXd {
    const Eigen::MatrixXd r = basis.transpose() * (a * basis);
    return 0.5 * (r + r.transpose());
  };
  ReducedSystem reduced;
  reduced.reference_K = system.reference_K;
  reduced.change_times_s = system.change_times_s;
  reduced.thermostats = system.thermostats;
  reduced.mass = Eigen::MatrixXd::Identity(basis.cols(), basis.cols());
  reduced.conduction = reduce(system.conduction);
  for (const Probe& p : system.probes)
    reduced.probes.push_back({p.body, p.before, basis.transpose() * p.weights, p.ambient_share, p.offset_K});
  for (const HeatSource& s : system.sources)
    reduced.sources.push_back({s.name, s.body, basis.transpose() * s.load, s.power_W});
  for (const auto& e : system.exchanges) {
    reduced.exchanges.push_back(
        {.name = e.name,
         .place = e.place,
         .matrix = reduce(e.matrix),
         .to_ambient = basis.transpose() * e.to_ambient,
         .ambient_sum = e.ambient_sum,
         .coefficient = e.coefficient,
         .flow = basis.transpose() * e.flow,
         .offset = e.offset.size() > 0 ? Eigen::VectorXd(basis.transpose() * e.offset) : Eigen::VectorXd(),
         .offset_sum = e.offset_sum,
         .medium = e.medium.size() > 0 ? Eigen::VectorXd(basis.transpose() * e.medium) : Eigen::VectorXd(),
         .medium_sum = e.medium_sum,
         .prescribes = e.prescribes,
         .slope_of = e.slope_of});
  }
  for (const auto& p : system.parts) {
    reduced.parts.push_back({p.body, reduce(p.conduction), reduce(p.mass), basis.transpose() * p.outputs});
  }
  reduced.outputs = {system.outputs.name, system.outputs.unit, basis.transpose() * system.outputs.state,
                     system.outputs.ambient};
  reduced.ones = basis.transpose() * times_ones(system.mass, system.ones);
  return reduced;
}

}  // namespace

ReducedSystem project(const FullSystem& system, const Eigen::MatrixXd& basis) {
  return projected(system, basis);
}

ReducedSystem project(const ReducedSystem& system, const Eigen::MatrixXd& basis) {
  return projected(system, basis);
}

ReducedSystem with_unit_mass(const ReducedSystem& system, Eigen::VectorXd& start) {
  const Eigen::LLT<Eigen::MatrixXd> factor(system.mass);
  const auto c = factor.matrixL();
  ReducedSystem unit = system;
  const auto matrix = [&](Eigen::MatrixXd& a) {
    c.solveInPlace(a);
    a.transposeInPlace();
    c.solveInPlace(a);
  };
  const auto vector = [&](Eigen::VectorXd& v) {
    if (v.size() > 0) c.solveInPlace(v);
  };
  matrix(unit.conduction);
  for (auto& e : unit.exchanges) {
    matrix(e.matrix);
    vector(e.to_ambient);
    vector(e.flow);
    vector(e.offset);
    vector(e.medium);
  }
  for (auto& s : unit.sources) vector(s.load);
  for (auto& p : unit.probes) vector(p.weights);
  for (auto& p : unit.parts) {
    matrix(p.conduction);
    matrix(p.mass);
    c.solveInPlace(p.outputs);
  }
  c.solveInPlace(unit.outputs.state);
  vector(unit.ones);
  unit.mass.setIdentity();
  start = (factor.matrixU() * start).eval();
  return unit;
}

}  // namespace driftwright::solver
