// One class in one file: slopes, implicit stages and heat balances work on the same state of a step.
#include "solver/heat_ode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "solver/share.hpp"

namespace driftwright::solver {
namespace {

constexpr int kMostPcgIterations = 2000;
constexpr double kPcgShareOfTolerance = 0.02;  // errors of linear solves must not affect the step size
// With the diagonal alone the number of iterations grows with the root of γ / (cell size)². A cycle of multigrid costs as
// much as about four of them and keeps the number below ten. The first γ with many iterations turns multigrid on for itself
// and all larger ones.
constexpr int kManyIterations = 24;

bool same_time(double a_s, double b_s) {
  return std::abs(a_s - b_s) <= 1e-12 * std::max(std::abs(a_s), std::abs(b_s));
}

bool is_affine(const FullSystem& system) {
  return system.nonlinear.empty() && !system.capacity && !system.looks_at_state();
}

Eigen::VectorXd ones_where_free(const FullSystem& system) {
  Eigen::VectorXd ones = Eigen::VectorXd::Ones(system.size());
  for (const FixedUnknowns& f : system.fixed) {
    for (int i : f.unknowns) ones[i] = 0.0;
  }
  return ones;
}

Eigen::VectorXd times(const SparseRow& a, const Eigen::VectorXd& x) {
  Eigen::VectorXd y(a.rows());
  multiply(a, x.data(), y.data());
  return y;
}

constexpr double kMostTemperature_K = 5000.0;

/// Lowest and highest temperature of what surrounds the machine at a time.
std::pair<double, double> surroundings_K(const FullSystem& system, const TimeSeries& ambient, double t_s) {
  double low = ambient.at(t_s), high = low;
  for (const FixedUnknowns& f : system.fixed) {
    if (f.follows_ambient) continue;
    low = std::min(low, f.theta.at(t_s));
    high = std::max(high, f.theta.at(t_s));
  }
  return {low, high};
}

}  // namespace

void require_sane(const double* theta, int n, double reference_K, double t_s) {
  for (int i = 0; i < n; ++i) {
    const double t_K = reference_K + theta[i];
    if (t_K >= 0.0 && t_K <= kMostTemperature_K) continue;
    throw TemperatureOutOfBounds(t_K, t_s);
  }
}

TemperatureOutOfBounds::TemperatureOutOfBounds(double temperature, double time)
    : SolveError(
          fmt::format("a source {} than films, links and joints {}: {:.3g} K at t = {:.1f} s; 0 to {:g} K can be computed",
                      temperature > 0.0 ? "heats more" : "cools more", temperature > 0.0 ? "carry away" : "bring",
                      temperature, time, kMostTemperature_K)),
      temperature_K(temperature),
      time_s(time) {}

HeatOde::HeatOde(const FullSystem& system, const TimeSeries& ambient, double absolute_K, int worth_multigrid)
    : system_(system),
      ambient_(ambient),
      share_(system.share.get()),
      tolerance_K_(kPcgShareOfTolerance * absolute_K),
      n_(system.size()),
      n_whole_(share_ ? share_->n_whole_unknowns() : n_),
      worth_multigrid_(worth_multigrid),
      is_affine_(is_affine(system)),
      rate_(system),
      flows_(rate_.flows()),
      slope_K_s_(system.fixed.size(), 0.0),
      mass_(system.mass),
      shifted_(system.mass),
      free_ones_(ones_where_free(system)),
      mass_ones_(times(system.mass, share_ ? Eigen::VectorXd::Ones(n_) : system.ones)),
      mass_free_ones_(times(system.mass, free_ones_)),
      base_(n_),
      gathered_(n_),
      heat_(n_),
      x_(n_),
      residual_(n_),
      work_(n_),
      space_(n_, share_),
      shifted_solver_(shifted_, share_),
      output_entries_(system.outputs.state.cols()),
      watch_(absolute_K, share_) {
  for (const FixedUnknowns& f : system.fixed) {
    flows_.push_back({f.name, FlowKind::kPrescribed});
    is_fixed_.resize(n_, 0);
    Eigen::VectorXd members = Eigen::VectorXd::Zero(n_);
    for (int i : f.unknowns) {
      is_fixed_[i] = 1;
      members[i] = 1.0;
      fixed_unknowns_.push_back(i);
    }
    mass_fixed_ones_.push_back(times(system.mass, members));
  }
  for (Eigen::Index j = 0; j < system.outputs.state.cols(); ++j) {
    for (int i = 0; i < n_; ++i) {
      if (system.outputs.state(i, j) != 0.0) output_entries_[static_cast<std::size_t>(j)].push_back(i);
    }
  }
  flow_W_.resize(n_flows());
  at_start_.value.resize(size());
  latest_.value.resize(size());
  decouple(mass_);
}

void HeatOde::decouple(SparseRow& a) const {
  for (int row : fixed_unknowns_) {
    for (SparseRow::InnerIterator entry(a, row); entry; ++entry) {
      if (entry.col() != row) {  // the pattern is symmetric
        entry.valueRef() = 0.0;
        if (!is_fixed_[entry.col()]) a.coeffRef(entry.col(), row) = 0.0;
      } else {
        entry.valueRef() = 1.0;
      }
    }
  }
}

void HeatOde::zero_fixed(double* x) const {
  for (int i : fixed_unknowns_) x[i] = 0.0;
}

void HeatOde::add_copies(Eigen::VectorXd& x) const {
  if (share_) share_->add_copies(x);
}

double HeatOde::of_all(double own) const {
  return share_ ? share_->sum(own) : own;
}

Eigen::VectorXd HeatOde::state(const double* y) const {
  return share_ ? share_->whole(y) : Eigen::Map<const Eigen::VectorXd>(y, n_);
}

void HeatOde::begin(const Eigen::VectorXd& start, double* y) {
  Eigen::Map<Eigen::VectorXd>(y, n_) = share_ ? share_->part_of(start) : start.head(n_);
  std::fill(y + n_, y + size(), 0.0);
  jump_J_ = Eigen::VectorXd::Zero(n_flows());
  auto flow = static_cast<Eigen::Index>(rate_.flows().size());
  for (const FixedUnknowns& f : system_.fixed) {
    const std::vector<double> before(y, y + n_);
    const double theta_K = (f.follows_ambient ? ambient_ : f.theta).at(0.0);
    for (int i : f.unknowns) y[i] = theta_K;
    jump_J_[flow++] = stored_J(y, before.data());
  }
  began_ = Eigen::Map<const Eigen::VectorXd>(y, n_);
  for (std::size_t i = 0; i < system_.thermostats.size(); ++i) {
    const double probe_K = rate_.thermostat_probe_K(static_cast<int>(i), y, ambient_.at(0.0));
    rate_.set_thermostat(static_cast<int>(i), probe_K > system_.thermostats[i].on_above_K);
  }
}

void HeatOde::tolerances(double absolute_K, double* tolerance) const {
  const int n_held = share_ ? share_->n_held : n_;  // errors of copies count where they are held
  std::fill(tolerance, tolerance + n_held, absolute_K);
  std::fill(tolerance + n_held, tolerance + size(), 1e30);
}

bool HeatOde::begin_stretch(const LinearStretch& stretch, double*) {
  const double length_s = stretch.end_s - stretch.start_s;
  for (std::size_t f = 0; f < system_.fixed.size(); ++f) {
    const TimeSeries& series = system_.fixed[f].follows_ambient ? ambient_ : system_.fixed[f].theta;
    const double slope_K_s = (series.at(stretch.end_s) - series.at(stretch.start_s)) / length_s;
    if (slope_K_s != slope_K_s_[f]) forget_slopes();
    slope_K_s_[f] = slope_K_s;
  }
  const bool jumps = rate_.set(stretch.drive, stretch.law_time_s(), stretch.run);
  gamma_ = -1.0;
  if (jumps) {
    forget_slopes();
    space_.clear();  // K may have changed
  }
  return jumps;
}

void HeatOde::forget_slopes() {
  at_start_.is_known = latest_.is_known = false;
}

void HeatOde::restart(double t_s, const double* y) {
  forget_slopes();
  watch_.begin(t_s, y, n_);
}

void HeatOde::look(double t_s, const double* y) {
  if (share_) {  // all processes fail alike, so that the first one can say why and remove what it has written
    const Eigen::Map<const Eigen::VectorXd> theta(y, n_);
    const double ends[] = {-share_->largest(-theta.minCoeff<Eigen::PropagateNaN>()),
                           share_->largest(theta.maxCoeff<Eigen::PropagateNaN>())};
    require_sane(ends, 2, system_.reference_K, t_s);
  } else {
    require_sane(y, n_, system_.reference_K, t_s);
  }
  if (system_.is_stratified()) return;  // the air itself has a range
  const auto [low_K, high_K] = surroundings_K(system_, ambient_, t_s);
  const auto [least_W, most_W] = rate_.power_range_W();
  watch_.step(t_s, y, n_, low_K, high_K, most_W > 0.0, least_W < 0.0);
}

Eigen::VectorXd HeatOde::observe(const double* y, double ambient_K) const {  // outputs have few or many nonzero entries
  const double own_K = share_ && !share_->is_first ? 0.0 : ambient_K;
  Eigen::VectorXd outputs = own_K * system_.outputs.ambient;
  for (Eigen::Index j = 0; j < outputs.size(); ++j) {
    const double* column = system_.outputs.state.col(j).data();
    const std::vector<int>& entries = output_entries_[static_cast<std::size_t>(j)];
    if (4 * entries.size() > static_cast<std::size_t>(n_)) {
      outputs[j] += dot(column, y, n_);
      continue;
    }
    for (int i : entries) outputs[j] += column[i] * y[i];
  }
  if (share_) share_->sum(outputs.data(), static_cast<int>(outputs.size()));
  return outputs;
}

double HeatOde::distance_to_switch_K(int i, double t_s, const double* y) const {
  const Thermostat& thermostat = system_.thermostats[i];
  return rate_.thermostat_probe_K(i, y, ambient_.at(t_s)) -
         (rate_.thermostat_is_on(i) ? thermostat.off_below_K : thermostat.on_above_K);
}

void HeatOde::evaluate(double t_s, const double* theta) {
  ambient_K_ = ambient_.at(t_s);
  rate_.evaluate(theta, ambient_K_, heat_.data());
  rate_.flows_W(theta, ambient_K_, flow_W_.data());
  if (!system_.capacity) return;
  mass_now_ = system_.mass;
  system_.capacity->add_to(theta, mass_now_);
}

double HeatOde::heat_into_fixed_W(std::size_t f, const double* x) const {
  double heat_W = 0.0;
  for (int row : system_.fixed[f].unknowns) {
    heat_W += heat_[row];
    if (!x) continue;
    for (SparseRow::InnerIterator entry(*stiffness_, row); entry; ++entry) heat_W -= entry.value() * x[entry.col()];
  }
  return heat_W;
}

void HeatOde::slopes(double t_s, const double* y, double* ydot) {
  if (latest_.is_known && same_time(t_s, latest_.t_s)) std::swap(at_start_, latest_);
  latest_.is_known = false;
  if (at_start_.is_known && same_time(t_s, at_start_.t_s)) {
    std::copy(at_start_.value.data(), at_start_.value.data() + size(), ydot);
    return;
  }
  evaluate(t_s, y);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(n_);
  for (std::size_t f = 0; f < system_.fixed.size(); ++f) {
    for (int i : system_.fixed[f].unknowns) slope[i] = slope_K_s_[f];
  }
  const SparseRow* matrix = &mass_;
  SparseRow decoupled;
  if (system_.capacity) {
    decoupled = mass_now_;
    decouple(decoupled);
    matrix = &decoupled;
  }
  residual_ = heat_;
  if (!fixed_unknowns_.empty()) residual_ -= times(mass_here(), slope);
  zero_fixed(residual_.data());
  add_copies(residual_);
  std::fill(x_.begin(), x_.end(), 0.0);
  // A slope counts by its contribution in the first step after a jump, some seconds.
  constexpr double kPerSecond = 0.1;
  Pcg solver(*matrix, share_);
  solver.refresh(free_ones_);
  count(solver.improve(residual_.data(), x_.data(), kPerSecond * tolerance_K_, kMostPcgIterations));
  slope += x_;
  std::copy(slope.begin(), slope.end(), ydot);
  double* of_flow = std::copy(flow_W_.data(), flow_W_.data() + rate_.flows().size(), ydot + n_);
  for (std::size_t f = 0; f < system_.fixed.size(); ++f) *of_flow++ = -heat_into_fixed_W(f, nullptr);
  std::copy(ydot, ydot + size(), at_start_.value.data());
  at_start_.t_s = t_s;
  at_start_.is_known = at_start_.is_rough = true;
  if (is_affine_) space_.add(mass_, rate_.tangent(y, ambient_K_), x_.data());
}

void HeatOde::refresh_shifted(double gamma) {
  stiffness_ = &rate_.tangent(base_.data(), ambient_K_);
  const double* k = stiffness_->valuePtr();
  const double* m = mass_here().valuePtr();
  double* a = shifted_.valuePtr();
  const int n_entries = static_cast<int>(shifted_.nonZeros());
  for_each_index(n_entries, n_entries > kWorthThreads, [=](int i) { a[i] = m[i] + gamma * k[i]; });
  // Residuals are scaled by the heat capacity: A's own diagonal would hide errors of smooth fields where γ K dominates. A
  // tenth of a per cent of the diagonal is added for bodies with almost no capacity.
  constexpr double kLeastShare = 1e-3;
  Eigen::VectorXd of_mass = mass_here().diagonal(), of_sum = shifted_.diagonal();
  add_copies(of_mass);
  add_copies(of_sum);
  residual_scale_ = of_mass.cwiseMax(kLeastShare * of_sum);
  decouple(shifted_);
  shifted_solver_.refresh(free_ones_, residual_scale_);
  gamma_ = gamma;
}

bool HeatOde::solve_stage(double t_s, double gamma, const double* predicted, const double* s, const double* weight,
                          double* c) {
  // Prescribed unknowns are known: c = s + γ slope. They are added to the base, so that x is zero there.
  std::copy(predicted, predicted + n_, base_.data());
  std::copy(s, s + n_, gathered_.data());
  for (std::size_t f = 0; f < system_.fixed.size(); ++f) {
    for (int i : system_.fixed[f].unknowns) {
      base_[i] += s[i] + gamma * slope_K_s_[f];
      gathered_[i] = -gamma * slope_K_s_[f];
    }
  }
  evaluate(t_s, base_.data());
  if (gamma != gamma_) refresh_shifted(gamma);
  if (is_affine_) {
    solve_linear_stage(gamma);
  } else if (!solve_nonlinear_stage(t_s, gamma, weight)) {
    return false;
  }
  // If x has been added to the state of the last evaluation, the flows are linear in it; Newton's iterations end with an
  // evaluation.
  const double* beyond = is_affine_ ? x_.data() : nullptr;
  std::copy(x_.begin(), x_.end(), c);
  for (int i : fixed_unknowns_) c[i] = s[i] - gathered_[i];
  Eigen::VectorXd along = Eigen::VectorXd::Zero(n_flows());
  if (beyond) rate_.flows_along(x_.data(), along.data());
  for (std::size_t j = 0; j < rate_.flows().size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    c[n_ + i] = s[n_ + i] + gamma * (flow_W_[i] + along[i]);
  }
  for (std::size_t f = 0; f < system_.fixed.size(); ++f) {
    const std::size_t i = static_cast<std::size_t>(n_) + rate_.flows().size() + f;
    c[i] = s[i] - gamma * heat_into_fixed_W(f, beyond);
  }
  double* latest = latest_.value.data();
  for (int i = 0; i < size(); ++i) latest[i] = (c[i] - s[i]) / gamma;
  latest_.t_s = t_s;
  latest_.is_known = true;
  latest_.is_rough = false;
  if (is_affine_) {
    std::copy(latest, latest + n_, work_.data());
    zero_fixed(work_.data());
    space_.add(mass_, *stiffness_, work_.data());
  }
  return true;
}

void HeatOde::solve_linear_stage(double gamma) {
  multiply(system_.mass, gathered_.data(), work_.data());
  for_blocks(n_, [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) work_[i] += gamma * heat_[i];
  });
  zero_fixed(work_.data());
  if (space_.empty()) {
    x_.setZero();
    residual_ = work_;
  } else {
    space_.guess(gamma, work_.data(), x_.data(), residual_.data());
    zero_fixed(residual_.data());
  }
  add_copies(residual_);
  const Preconditioner* multigrid = multigrid_for(gamma);
  const PcgOutcome outcome =
      shifted_solver_.improve(residual_.data(), x_.data(), tolerance_K_, kMostPcgIterations, multigrid);
  count(outcome);
  if (!multigrid && outcome.iterations > kManyIterations && n_whole_ > worth_multigrid_) {
    least_multigrid_gamma_ = std::min(least_multigrid_gamma_, gamma);
  }
  if (multigrid && outcome.iterations > kManyIterations) multigrids_.clear();  // K has changed since they were made
  shifted_solver_.conserve(work_.data(), x_.data());
}

const Preconditioner* HeatOde::multigrid_for(double gamma) {
  if (gamma < least_multigrid_gamma_) return nullptr;
  constexpr double kBand =
      2.0;  // a multigrid made for a γ within this factor is almost as good; a new one costs some ten iterations
  constexpr std::size_t kMost = 4;  // stored: after each jump γ grows again through the same values
  for (const auto& [of_gamma, multigrid] : multigrids_) {
    if (gamma <= kBand * of_gamma && of_gamma <= kBand * gamma) return multigrid.get();
  }
  if (multigrids_.size() == kMost) multigrids_.erase(multigrids_.begin());
  multigrids_.emplace_back(gamma, share_ ? share_->preconditioner(shifted_) : std::make_unique<Multigrid>(shifted_));
  return multigrids_.back().second.get();
}

bool HeatOde::solve_nonlinear_stage(double t_s, double gamma, const double* weight) {
  constexpr int kMostNewton = 10;
  constexpr double kShareOfError = 0.1, kDiverging = 2.3, kSlowest = 0.3;  // ARKODE's values
  x_.setZero();
  Eigen::VectorXd step(n_);
  double last = 0.0, rate = 1.0;
  for (int iteration = 0; iteration < kMostNewton; ++iteration) {
    if (iteration > 0) {
      work_ = base_ + x_;
      evaluate(t_s, work_.data());
    }
    work_ = gathered_ - x_;
    multiply(mass_here(), work_.data(), residual_.data());
    residual_ += gamma * heat_;
    zero_fixed(residual_.data());
    add_copies(residual_);
    step.setZero();
    // The first correction is computed even if it is below the tolerance, as that of a very short step is. Otherwise
    // close_balance() would spread its heat over the whole machine, step after step.
    count(shifted_solver_.improve(residual_.data(), step.data(), tolerance_K_, kMostPcgIterations, nullptr,
                                  iteration == 0 ? 1 : 0));
    x_ += step;
    double sum = 0.0;
    for (int i = 0; i < n_; ++i) sum += step[i] * step[i] * weight[i] * weight[i];
    const double size = std::sqrt(of_all(sum) / n_whole_);  // copies have no weight
    if (iteration > 0) rate = std::max(kSlowest * rate, size / last);
    if (size * std::min(rate, 1.0) <= kShareOfError) {
      close_balance(t_s, gamma);
      return true;
    }
    if (iteration > 0 && size > kDiverging * last) return false;
    last = size;
  }
  return false;
}

/// Evaluates the flows at the state itself, then adds a constant to it until its heat equals theirs up to rounding.
void HeatOde::close_balance(double t_s, double gamma) {
  constexpr int kMostPasses = 8;
  const double of_stiffness = of_all(free_ones_.dot(times(*stiffness_, free_ones_)));
  const double largest_K = base_.cwiseAbs().maxCoeff();
  const double least_K = 1e-15 * (1.0 + (share_ ? share_->largest(largest_K) : largest_K));
  for (int pass = 0; pass < kMostPasses; ++pass) {
    work_ = base_ + x_;
    evaluate(t_s, work_.data());
    if (system_.capacity) mass_free_ones_ = times(mass_now_, free_ones_);
    const double ones_a_ones = of_all(mass_free_ones_.dot(free_ones_)) + gamma * of_stiffness;
    if (!(ones_a_ones > 0.0)) return;  // every unknown is prescribed
    work_ = gathered_ - x_;
    const double shift_K = of_all(gamma * free_ones_.dot(heat_) + mass_free_ones_.dot(work_)) / ones_a_ones;
    x_ += shift_K * free_ones_;
    if (std::abs(shift_K) <= least_K) return;
  }
}

void HeatOde::count(const PcgOutcome& outcome) {
  ++n_solves_;
  n_iterations_ += outcome.iterations;
  if (outcome.converged) return;
  throw SolveError(
      fmt::format("PCG stopped after {} iterations at a residual of {:.2e} K (required: {:.2e} K); is a film, "
                  "joint or material value extreme?",
                  outcome.iterations, outcome.residual, tolerance_K_));
}

Eigen::VectorXd HeatOde::heats_J(const double* y) const {
  const double* start = began_.data();
  Eigen::VectorXd heats = jump_J_ + Eigen::Map<const Eigen::VectorXd>(y + n_, n_flows());
  if (share_) share_->sum(heats.data(), static_cast<int>(heats.size()));
  if (is_fixed_.empty()) return heats;
  const Eigen::VectorXd rise = Eigen::Map<const Eigen::VectorXd>(y, n_) - Eigen::Map<const Eigen::VectorXd>(start, n_);
  Eigen::VectorXd beyond_J = Eigen::VectorXd::Zero(system_.capacity ? n_ : 0);
  if (system_.capacity) beyond_J = system_.capacity->heat_content_J(y, n_) - system_.capacity->heat_content_J(start, n_);
  auto j = static_cast<Eigen::Index>(rate_.flows().size());
  for (std::size_t f = 0; f < system_.fixed.size(); ++f, ++j) {
    heats[j] += mass_fixed_ones_[f].dot(rise);
    if (!system_.capacity) continue;
    for (int i : system_.fixed[f].unknowns) heats[j] += beyond_J[i];
  }
  return heats;
}

double HeatOde::stored_J(const double* y) const {
  return of_all(jump_J_.sum() + stored_J(y, began_.data()));
}

double HeatOde::stored_J(const double* y, const double* start) const {
  const Eigen::VectorXd rise = Eigen::Map<const Eigen::VectorXd>(y, n_) - Eigen::Map<const Eigen::VectorXd>(start, n_);
  double stored = mass_ones_.dot(rise);
  if (system_.capacity) {
    stored += (system_.capacity->heat_content_J(y, n_) - system_.capacity->heat_content_J(start, n_)).sum();
  }
  return stored;
}

}  // namespace driftwright::solver
