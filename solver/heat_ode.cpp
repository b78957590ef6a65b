#include "solver/heat_ode.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.hpp"

namespace driftwright::solver {
namespace {

Eigen::VectorXd ones_where_free(const FullSystem& system) {
  Eigen::VectorXd ones = Eigen::VectorXd::Ones(system.size());
  for (const FixedUnknowns& f : system.fixed) {
    for (int i : f.unknowns) ones[i] = 0.0;
  }
  return ones;
}

}  // namespace

HeatOde::HeatOde(const FullSystem& system, const TimeSeries& hall, double pcg_tolerance_K)
    : system_(system),
      hall_(hall),
      tolerance_K_(pcg_tolerance_K),
      n_(system.size()),
      rate_(system),
      flows_(rate_.flows()),
      slope_K_s_(system.fixed.size(), 0.0),
      mass_(system.mass),
      shifted_(system.mass),
      last_theta_(Eigen::VectorXd::Zero(n_)),
      free_ones_(ones_where_free(system)),
      mass_warm_(Eigen::VectorXd::Zero(n_)),
      work_(n_),
      shifted_solver_(shifted_),
      mass_solver_(mass_),
      mass_now_solver_(mass_now_) {
  for (const FixedUnknowns& f : system.fixed) {
    flows_.push_back({f.name, FlowKind::kPrescribed});
    is_fixed_.resize(n_, 0);
    for (int i : f.unknowns) is_fixed_[i] = 1;
  }
  decouple(mass_);
  mass_solver_.refresh(free_ones_);
}

void HeatOde::decouple(SparseRow& a) const {
  if (is_fixed_.empty()) return;
  for (int row = 0; row < n_; ++row) {
    for (SparseRow::InnerIterator entry(a, row); entry; ++entry) {
      if (is_fixed_[row] || is_fixed_[entry.col()]) entry.valueRef() = entry.col() == row ? 1.0 : 0.0;
    }
  }
}

Eigen::VectorXd HeatOde::prescribe(double t_s, double* y) const {
  Eigen::VectorXd heat_J = Eigen::VectorXd::Zero(n_flows());
  auto flow = static_cast<Eigen::Index>(rate_.flows().size());
  for (const FixedUnknowns& f : system_.fixed) {
    const std::vector<double> before(y, y + n_);
    const double theta_K = (f.follows_hall ? hall_ : f.theta).at(t_s);
    for (int i : f.unknowns) y[i] = theta_K;
    heat_J[flow++] = stored_J(y, before.data());
  }
  return heat_J;
}

bool HeatOde::begin_stretch(const LinearStretch& stretch) {
  const double length_s = stretch.end_s - stretch.start_s;
  if (!is_fixed_.empty()) {
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(n_);
    for (std::size_t f = 0; f < system_.fixed.size(); ++f) {
      const TimeSeries& series = system_.fixed[f].follows_hall ? hall_ : system_.fixed[f].theta;
      slope_K_s_[f] = (series.at(stretch.end_s) - series.at(stretch.start_s)) / length_s;
      for (int i : system_.fixed[f].unknowns) slope[i] = slope_K_s_[f];
    }
    mass_slope_ = system_.mass * slope;
  }
  const bool jumps = rate_.set(stretch.drive, 0.5 * (stretch.start_s + stretch.end_s));
  gamma_ = -1.0;
  return jumps;
}

void HeatOde::set_thermostats(double t_s, const double* y) {
  for (std::size_t i = 0; i < system_.thermostats.size(); ++i) {
    const double probe_K = rate_.thermostat_probe_K(static_cast<int>(i), y, hall_.at(t_s));
    rate_.set_thermostat(static_cast<int>(i), probe_K > system_.thermostats[i].on_above_K);
  }
}

double HeatOde::distance_to_switch_K(int i, double t_s, const double* y) const {
  const Thermostat& thermostat = system_.thermostats[i];
  return rate_.thermostat_probe_K(i, y, hall_.at(t_s)) -
         (rate_.thermostat_is_on(i) ? thermostat.off_below_K : thermostat.on_above_K);
}

void HeatOde::update_mass(const double* theta) {
  mass_now_ = system_.mass;
  system_.capacity->add_to(theta, mass_now_);
  if (!is_fixed_.empty()) {
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(n_);
    for (std::size_t f = 0; f < system_.fixed.size(); ++f) {
      for (int i : system_.fixed[f].unknowns) slope[i] = slope_K_s_[f];
    }
    mass_slope_ = mass_now_ * slope;
    decouple(mass_now_);
  }
  mass_now_solver_.refresh(free_ones_);
}

void HeatOde::rhs(double t_s, const double* y, double* ydot) {
  const double hall_K = hall_.at(t_s);
  rate_.evaluate(y, hall_K, ydot);
  rate_.flows_W(y, hall_K, ydot + n_);
  std::copy(y, y + n_, last_theta_.data());
  last_hall_K_ = hall_K;
  if (system_.capacity) update_mass(y);
  double* of_fixed = ydot + n_ + rate_.flows().size();
  for (std::size_t f = 0; f < system_.fixed.size(); ++f) {
    *of_fixed = 0.0;
    for (int i : system_.fixed[f].unknowns) *of_fixed -= ydot[i];
    ++of_fixed;
  }
  if (!is_fixed_.empty()) {
    for (int i = 0; i < n_; ++i) ydot[i] -= mass_slope_[i];
    for (std::size_t f = 0; f < system_.fixed.size(); ++f) {
      for (int i : system_.fixed[f].unknowns) ydot[i] = slope_K_s_[f];
    }
  }
  if (system_.capacity) {
    work_ = mass_warm_;
    run(mass_now_solver_, ydot, work_.data());
    mass_warm_ = work_;
    multiply(mass_, work_.data(), ydot);
  }
}

void HeatOde::multiply_mass(const double* x, double* mx) const {
  multiply(mass_, x, mx);
  std::copy(x + n_, x + size(), mx + n_);
}

void HeatOde::refresh_shifted(double gamma) {
  const SparseRow& stiffness = rate_.tangent(last_theta_.data(), last_hall_K_);
  const double* k = stiffness.valuePtr();
  const double* m = (system_.capacity ? mass_now_ : mass_).valuePtr();
  double* a = shifted_.valuePtr();
  const auto n_entries = shifted_.nonZeros();
#pragma omp parallel for simd schedule(static) if (n_entries > kWorthThreads)
  for (Eigen::Index i = 0; i < n_entries; ++i) a[i] = m[i] + gamma * k[i];
  decouple(shifted_);
  shifted_stiffness_ = &stiffness;
  shifted_solver_.refresh(free_ones_);
  gamma_ = gamma;
}

void HeatOde::solve_shifted(double gamma, const double* b, double* x) {
  if (gamma != gamma_) refresh_shifted(gamma);
  work_ = Eigen::Map<const Eigen::VectorXd>(b, n_);
  if (system_.capacity) {  // (M_ref + γ M_ref M⁻¹ K) x = b
    Eigen::VectorXd rate = Eigen::VectorXd::Zero(n_);
    run(mass_solver_, b, rate.data());
    multiply(mass_now_, rate.data(), work_.data());
  }
  Eigen::VectorXd fixed = Eigen::VectorXd::Zero(is_fixed_.empty() ? 0 : n_), pull = fixed;
  if (!is_fixed_.empty()) {  // what the prescribed unknowns do to the free ones
    for (int i = 0; i < n_; ++i) fixed[i] = is_fixed_[i] ? work_[i] : 0.0;
    multiply(*shifted_stiffness_, fixed.data(), pull.data());
    for (int i = 0; i < n_; ++i) {
      if (!is_fixed_[i]) work_[i] -= gamma * pull[i];
    }
  }
  std::fill(x, x + n_, 0.0);
  run(shifted_solver_, work_.data(), x);
  rate_.flows_along(x, x + n_);
  double* of_flow = x + n_ + rate_.flows().size();
  if (!is_fixed_.empty()) {
    multiply(*shifted_stiffness_, x, pull.data());
    for (const FixedUnknowns& f : system_.fixed) {
      *of_flow = 0.0;
      for (int i : f.unknowns) *of_flow += pull[i];
      ++of_flow;
    }
  }
  for (int j = n_; j < size(); ++j) x[j] = b[j] + gamma * x[j];
}

void HeatOde::solve_mass(const double* b, double* x) {
  std::copy(mass_warm_.data(), mass_warm_.data() + n_, x);  // the last rate is near this one
  run(mass_solver_, b, x);
  std::copy(x, x + n_, mass_warm_.data());
  std::copy(b + n_, b + size(), x + n_);
}

void HeatOde::run(Pcg& solver, const double* b, double* x) {
  for (std::size_t i = 0; i < is_fixed_.size(); ++i) {
    if (is_fixed_[i]) x[i] = b[i];  // a row of the identity: without a residual from the start it stays exact
  }
  const PcgOutcome outcome = solver.solve(b, x, tolerance_K_, 2000);
  ++n_solves_;
  n_iterations_ += outcome.iterations;
  if (!outcome.converged) {
    throw SolveError(
        fmt::format("PCG stopped after {} iterations at a residual of {:.2e} K (wanted {:.2e} K); is a film, "
                    "joint or material value extreme?",
                    outcome.iterations, outcome.residual, tolerance_K_));
  }
  // Rows of prescribed unknowns are those of the identity. Solved to the tolerance only, they would leave their curve, and the
  // heat that M couples to them would be missing in the balance.
  if (is_fixed_.empty()) return;
  for (int i = 0; i < n_; ++i) {
    if (is_fixed_[i]) x[i] = b[i];
  }
}

Eigen::VectorXd HeatOde::heats_J(const double* y, const double* start) const {
  Eigen::VectorXd heats = Eigen::Map<const Eigen::VectorXd>(y + n_, n_flows());
  if (is_fixed_.empty()) return heats;
  const Eigen::VectorXd rise = Eigen::Map<const Eigen::VectorXd>(y, n_) - Eigen::Map<const Eigen::VectorXd>(start, n_);
  Eigen::VectorXd content_J = system_.mass * rise;
  if (system_.capacity) content_J += system_.capacity->heat_content_J(y, n_) - system_.capacity->heat_content_J(start, n_);
  auto j = static_cast<Eigen::Index>(rate_.flows().size());
  for (const FixedUnknowns& f : system_.fixed) {
    for (int i : f.unknowns) heats[j] += content_J[i];
    ++j;
  }
  return heats;
}

double HeatOde::stored_J(const double* y, const double* start) const {
  const Eigen::VectorXd rise = Eigen::Map<const Eigen::VectorXd>(y, n_) - Eigen::Map<const Eigen::VectorXd>(start, n_);
  double stored = system_.ones.dot(system_.mass * rise);
  if (system_.capacity) {
    stored += (system_.capacity->heat_content_J(y, n_) - system_.capacity->heat_content_J(start, n_)).sum();
  }
  return stored;
}

}  // namespace driftwright::solver
