#include "solver/reduced_model.hpp"

#include <Spectra/SymGEigsShiftSolver.h>
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

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

/// (e^{-a} - 1 + a) / a² and (1 - e^{-a}) / a without cancellation near a = 0.
double phi1(double a) {
  return std::abs(a) < 1e-8 ? 1.0 - 0.5 * a : -std::expm1(-a) / a;
}
double phi2(double a) {
  return std::abs(a) < 1e-3 ? 0.5 - a / 6.0 + a * a / 24.0 : (1.0 - phi1(a)) / a;
}

}  // namespace

namespace {

/// All modes of a small system by a dense solver, then the slowest of them.
ThermalModes dense_modes(const FullSystem& system, const effects::Inputs& at, int n_modes) {
  const SparseRow k = stiffness_at(system, at);
  require_way_out(k);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(k), Eigen::MatrixXd(system.mass)};
  ThermalModes modes{eigen.eigenvectors().leftCols(n_modes), {}};
  for (int i = 0; i < n_modes; ++i) modes.time_constant_s.push_back(1.0 / eigen.eigenvalues()[i]);
  return modes;
}

}  // namespace

ThermalModes thermal_modes(const FullSystem& system, const effects::Inputs& at, int n_modes) {
  const int n = system.size();
  constexpr int kDense = 60;  // unknowns up to which a dense solver is no slower, and gives every mode there is
  if (!system.is_linear()) throw std::logic_error("thermal modes are those of a linear system");
  if (n_modes < 1 || n_modes > (n <= kDense ? n : n - 2)) {
    throw InputError(fmt::format("{} thermal modes of {} unknowns cannot be had", n_modes, n));
  }
  if (n <= kDense) return dense_modes(system, at, n_modes);
  const ConductionFactor factor = factor_at(system, at);
  InverseStiffness inverse{factor, n};
  MassProduct mass{system.mass};
  const int n_krylov = std::min(n, std::max(2 * n_modes + 1, 20));
  Spectra::SymGEigsShiftSolver<InverseStiffness, MassProduct, Spectra::GEigsMode::ShiftInvert> solver(inverse, mass, n_modes,
                                                                                                      n_krylov, 0.0);
  // A fixed start makes the modes repeatable; equal weights reach every mode of an irregular machine.
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
  // One more where the air is stratified or a temperature prescribed: what stands beside sources and hall.
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(system.size());
  for (const auto& e : system.exchanges) {
    if (e.offset.size() > 0) offset += e.coefficient(at) * e.offset;
  }
  const bool has_offset = offset.cwiseAbs().maxCoeff() > 0.0;
  Eigen::MatrixXd responses(system.size(), n_sources + (has_offset ? 2 : 1));
  for (Eigen::Index s = 0; s < n_sources; ++s) responses.col(s) = factor.solve(system.sources[s].load);
  Eigen::VectorXd hall = Eigen::VectorXd::Zero(system.size());
  for (const auto& e : system.exchanges) hall += e.coefficient(at) * e.to_hall;
  responses.col(n_sources) = factor.solve(hall);
  if (has_offset) responses.col(n_sources + 1) = factor.solve(offset);
  return responses;
}

Eigen::MatrixXd orthonormalise(const SparseRow& mass, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd basis(columns.rows(), columns.cols()), m_basis(columns.rows(), columns.cols());
  int kept = 0;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    Eigen::VectorXd v = columns.col(c), mv(columns.rows());
    multiply(mass, v.data(), mv.data());
    const double length = std::sqrt(v.dot(mv));
    for (int pass = 0; pass < 2; ++pass)
      v -= basis.leftCols(kept) * (m_basis.leftCols(kept).transpose() * v);  // twice is enough
    multiply(mass, v.data(), mv.data());
    const double rest = std::sqrt(v.dot(mv));
    if (!(rest > 1e-10 * length)) continue;
    basis.col(kept) = v / rest;
    m_basis.col(kept) = mv / rest;
    ++kept;
  }
  return basis.leftCols(kept);
}

ReducedSystem project(const FullSystem& system, const Eigen::MatrixXd& basis) {
  if (!system.is_linear()) throw std::logic_error("project: only a linear system has a reduced one");
  const auto reduce = [&](const SparseRow& a) -> Eigen::MatrixXd {
    const Eigen::MatrixXd r = basis.transpose() * (a * basis);
    return 0.5 * (r + r.transpose());
  };
  ReducedSystem reduced;
  reduced.reference_K = system.reference_K;
  reduced.change_times_s = system.change_times_s;
  reduced.mass = reduce(system.mass);
  reduced.conduction = reduce(system.conduction);
  for (const HeatSource& s : system.sources) reduced.sources.push_back({s.name, basis.transpose() * s.load, s.power_W});
  for (const auto& e : system.exchanges) {
    reduced.exchanges.push_back(
        {.name = e.name,
         .matrix = reduce(e.matrix),
         .to_hall = basis.transpose() * e.to_hall,
         .hall_sum = e.hall_sum,
         .coefficient = e.coefficient,
         .flow = basis.transpose() * e.flow,
         .offset = e.offset.size() > 0 ? Eigen::VectorXd(basis.transpose() * e.offset) : Eigen::VectorXd(),
         .offset_sum = e.offset_sum});
  }
  reduced.outputs = {system.outputs.name, system.outputs.unit, basis.transpose() * system.outputs.state,
                     system.outputs.hall};
  Eigen::VectorXd m_ones(system.size());
  multiply(system.mass, system.ones.data(), m_ones.data());
  reduced.ones = basis.transpose() * m_ones;
  return reduced;
}

Trajectory evolve(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& hall,
                  const std::vector<double>& output_s, const Eigen::VectorXd& start) {
  Trajectory run;
  run.time_s = output_s;
  run.outputs.resize(system.outputs.state.cols(), static_cast<Eigen::Index>(output_s.size()));
  Eigen::VectorXd state = start;
  std::size_t next = 0;
  bool first = true;
  Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  Eigen::MatrixXd to_modes;
  std::vector<double> knots_s = hall.time_s;
  knots_s.insert(knots_s.end(), system.change_times_s.begin(), system.change_times_s.end());
  for (const LinearStretch& stretch : linear_stretches(cyclogram, knots_s)) {
    const double length_s = stretch.end_s - stretch.start_s;
    effects::Inputs at_start{
        .drive = stretch.drive, .hall_K = hall.at(stretch.start_s), .time_s = 0.5 * (stretch.start_s + stretch.end_s)};
    effects::Inputs at_end = at_start;
    at_end.hall_K = hall.at(stretch.end_s);
    if (first || stretch.drive_changed || !system.change_times_s.empty()) {
      Eigen::MatrixXd k = system.conduction;
      for (const auto& e : system.exchanges) k += e.coefficient(at_start) * e.matrix;
      eigen.compute(k, system.mass);
      to_modes = eigen.eigenvectors().transpose() * system.mass;  // x = V z, V'MV = 1
      first = false;
    }
    const Eigen::VectorXd z0 = to_modes * state;
    const Eigen::VectorXd f0 = eigen.eigenvectors().transpose() * system.load(at_start);
    const Eigen::VectorXd slope = (eigen.eigenvectors().transpose() * system.load(at_end) - f0) / length_s;
    const auto state_after = [&](double dt_s) -> Eigen::VectorXd {  // z' = -λ z + f0 + slope t
      Eigen::VectorXd z(z0.size());
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        const double a = eigen.eigenvalues()[i] * dt_s;
        z[i] = std::exp(-a) * z0[i] + dt_s * phi1(a) * f0[i] + dt_s * dt_s * phi2(a) * slope[i];
      }
      return eigen.eigenvectors() * z;
    };
    for (; next < output_s.size() && output_s[next] <= stretch.end_s; ++next) {
      run.outputs.col(static_cast<Eigen::Index>(next)) =
          system.observe(state_after(output_s[next] - stretch.start_s), hall.at(output_s[next]));
    }
    state = state_after(length_s);
  }
  return run;
}

}  // namespace driftwright::solver
