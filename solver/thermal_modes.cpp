#include "solver/thermal_modes.hpp"

#include <Spectra/SymGEigsShiftSolver.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "base/dense.hpp"
#include "base/errors.hpp"
#include "solver/conduction_factor.hpp"

namespace driftwright::solver {
namespace {

SparseRow stiffness_at(const FullSystem& system, const effects::Inputs& at) {
  SparseRow k = system.conduction;
  for (const auto& e : system.exchanges) k += e.coefficient(at) * e.matrix;
  return k;
}

/// K(u)⁻¹ of a linear system.
ConductionFactor factor_at(const FullSystem& system, const effects::Inputs& at) {
  if (!system.is_linear()) throw std::logic_error("thermal modes and steady responses are those of a linear system");
  const SparseRow k = stiffness_at(system, at);
  require_way_out(k);
  return ConductionFactor(k);
}

// Spectra's two operators: x -> K⁻¹ x (shift zero) and x -> M x.
struct InverseStiffness {
  using Scalar = double;
  const ConductionFactor& factor;
  int n;
  [[nodiscard]] Eigen::Index rows() const { return n; }
  [[nodiscard]] Eigen::Index cols() const { return n; }
  void set_shift(double) {}
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, n) = factor.solve(Eigen::Map<const Eigen::VectorXd>(x, n));
  }
};
struct MassProduct {
  using Scalar = double;
  const SparseRow& mass;
  [[nodiscard]] Eigen::Index rows() const { return mass.rows(); }
  [[nodiscard]] Eigen::Index cols() const { return mass.cols(); }
  void perform_op(const double* x, double* y) const { multiply(mass, x, y); }
};

/// All modes of a small system by a dense solver, reduced to the slowest.
ThermalModes dense_modes(const FullSystem& system, const effects::Inputs& at, int n_modes) {
  const SparseRow k = stiffness_at(system, at);
  require_way_out(k);
  const dense::GeneralizedSymmetricEigen eigen(Eigen::MatrixXd(k), Eigen::MatrixXd(system.mass));
  ThermalModes modes{eigen.eigenvectors().leftCols(n_modes), {}};
  for (int i = 0; i < n_modes; ++i) modes.time_constant_s.push_back(1.0 / eigen.eigenvalues()[i]);
  return modes;
}

}  // namespace

ThermalModes thermal_modes(const FullSystem& system, const effects::Inputs& at, int n_modes) {
  const int n = system.size();
  constexpr int kDense = 60;  // largest number of unknowns for which a dense solver is as fast; it gives all modes
  if (!system.is_linear()) throw std::logic_error("thermal modes are those of a linear system");
  if (n_modes < 1 || n_modes > (n <= kDense ? n : n - 2)) {
    throw InputError(fmt::format("{} thermal modes of {} unknowns cannot be computed", n_modes, n));
  }
  if (n <= kDense) return dense_modes(system, at, n_modes);
  const ConductionFactor factor = factor_at(system, at);
  InverseStiffness inverse{factor, n};
  MassProduct mass{system.mass};
  const int n_krylov = std::min(n, std::max(2 * n_modes + 1, 20));
  Spectra::SymGEigsShiftSolver<InverseStiffness, MassProduct, Spectra::GEigsMode::ShiftInvert> solver(inverse, mass, n_modes,
                                                                                                      n_krylov, 0.0);
  // A fixed start vector makes the modes repeatable; equal weights reach every mode of an irregular machine.
  Eigen::VectorXd start(n);
  for (int i = 0; i < n; ++i) start[i] = std::sin(1.0 + i);
  solver.init(start.data());
  const auto n_found = solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-10);
  if (solver.info() != Spectra::CompInfo::Successful || n_found < n_modes) {
    throw SolveError(fmt::format("{} of {} thermal modes converged; ask for fewer", n_found, n_modes));
  }
  ThermalModes modes;
  modes.shapes.resize(n, n_modes);
  std::vector<int> order(n_modes);
  std::iota(order.begin(), order.end(), 0);
  const Eigen::VectorXd lambda = solver.eigenvalues();
  std::sort(order.begin(), order.end(), [&](int a, int b) { return lambda[a] < lambda[b]; });
  const Eigen::MatrixXd vectors = solver.eigenvectors();
  for (int i = 0; i < n_modes; ++i) {
    modes.time_constant_s.push_back(1.0 / lambda[order[i]]);
    Eigen::VectorXd m_phi(n);
    multiply(system.mass, vectors.col(order[i]).data(), m_phi.data());
    modes.shapes.col(i) = vectors.col(order[i]) / std::sqrt(m_phi.dot(vectors.col(order[i])));
  }
  return modes;
}

Eigen::MatrixXd steady_responses(const FullSystem& system, const effects::Inputs& at) {
  const ConductionFactor factor = factor_at(system, at);
  const auto n_sources = static_cast<Eigen::Index>(system.sources.size());
  // One more column if the air is stratified or a temperature prescribed: loads other than sources and ambient.
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(system.size());
  for (const auto& e : system.exchanges) {
    if (e.offset.size() > 0) offset += e.coefficient(at) * e.offset;
  }
  const bool has_offset = offset.cwiseAbs().maxCoeff() > 0.0;
  Eigen::MatrixXd responses(system.size(), n_sources + (has_offset ? 2 : 1));
  for (Eigen::Index s = 0; s < n_sources; ++s) responses.col(s) = factor.solve(system.sources[s].load);
  Eigen::VectorXd ambient = Eigen::VectorXd::Zero(system.size());
  for (const auto& e : system.exchanges) ambient += e.coefficient(at) * e.to_ambient;
  responses.col(n_sources) = factor.solve(ambient);
  if (has_offset) responses.col(n_sources + 1) = factor.solve(offset);
  return responses;
}

}  // namespace driftwright::solver
