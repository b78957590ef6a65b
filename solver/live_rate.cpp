#include "solver/live_rate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace driftwright::solver {

LiveRate::LiveRate(const ReducedSystem& system, const TimeSeries& ambient)
    : system_(system),
      ambient_(ambient),
      is_on_(system.thermostats.size(), 0),
      probe_K_(system.probes.size()),
      changes_(system.change_times_s) {
  if (!system.mass.isIdentity(1e-12))
    per_mass_ = system.mass.llt().solve(Eigen::MatrixXd::Identity(system.size(), system.size()));
  const auto over_mass = [&](const auto& x) { return per_mass_.size() > 0 ? (per_mass_ * x).eval() : x; };
  for (const HeatSource& s : system.sources) {
    if (s.power_W.looks_at_state()) sources_.push_back({&s.power_W, over_mass(s.load)});
  }
  for (const auto& e : system.exchanges) {
    if (!e.coefficient.looks_at_state()) continue;
    exchanges_.push_back({&e.coefficient, over_mass(e.matrix), over_mass(e.to_ambient),
                          e.offset.size() > 0 ? over_mass(e.offset) : Eigen::VectorXd::Zero(system.size())});
  }
  const auto look_at = [&](const BoundLaw& law) {
    for (int p : law.probes) looked_at_.push_back(static_cast<std::size_t>(p));
  };
  for (const Source& s : sources_) look_at(*s.law);
  for (const Exchange& e : exchanges_) look_at(*e.law);
  std::sort(looked_at_.begin(), looked_at_.end());
  looked_at_.erase(std::unique(looked_at_.begin(), looked_at_.end()), looked_at_.end());
}

bool LiveRate::enter(const LinearStretch& stretch) {
  inputs_.time_s = stretch.law_time_s();
  start_s_ = stretch.start_s;
  start_ambient_K_ = inputs_.ambient_K = ambient_.at(stretch.start_s);
  ambient_K_s_ = (ambient_.at(stretch.end_s) - start_ambient_K_) / (stretch.end_s - stretch.start_s);
  const bool has_changed = changes_.at(stretch);
  if (!has_changed && !has_toggled_) return false;
  has_toggled_ = false;
  inputs_.drive = stretch.drive;
  inputs_.run = stretch.run;
  inputs_.probe_K.clear();
  std::vector<double> followed;
  followed.reserve(followed_.size());
  for (const HeatSource& s : system_.sources) {
    if (!s.power_W.looks_at_state()) followed.push_back(is_off(s.power_W) ? 0.0 : s.power_W(inputs_));
  }
  for (const auto& e : system_.exchanges) {
    if (!e.coefficient.looks_at_state()) followed.push_back(is_off(e.coefficient) ? 0.0 : e.coefficient(inputs_));
  }
  if (has_entered_ && followed == followed_) return false;
  has_entered_ = true;
  followed_ = std::move(followed);
  conduction_ = system_.conduction;
  load_ = to_ambient_ = Eigen::VectorXd::Zero(system_.size());
  auto next = followed_.begin();
  for (const HeatSource& s : system_.sources) {
    if (!s.power_W.looks_at_state()) load_ += *next++ * s.load;
  }
  for (const auto& e : system_.exchanges) {
    if (e.coefficient.looks_at_state()) continue;
    const double c = *next++;
    if (c == 0.0) continue;
    conduction_ += c * e.matrix;
    to_ambient_ += c * e.to_ambient;
    if (e.offset.size() > 0) load_ += c * e.offset;
  }
  if (per_mass_.size() > 0) {
    conduction_ = (per_mass_ * conduction_).eval();
    load_ = (per_mass_ * load_).eval();
    to_ambient_ = (per_mass_ * to_ambient_).eval();
  }
  return true;
}

double LiveRate::value(const BoundLaw& law) {
  if (is_off(law)) return 0.0;
  inputs_.probe_K.clear();
  for (int p : law.probes) inputs_.probe_K.push_back(probe_K_[static_cast<std::size_t>(p)]);
  return law.law(inputs_);
}

void LiveRate::look(double t_s, const Eigen::VectorXd& z) {
  inputs_.ambient_K = start_ambient_K_ + ambient_K_s_ * (t_s - start_s_);
  for (std::size_t p : looked_at_) probe_K_[p] = system_.reference_K + system_.probes[p].theta_K(z, inputs_.ambient_K);
}

void LiveRate::rate(double t_s, const Eigen::VectorXd& z, Eigen::VectorXd& dz_dt) {
  look(t_s, z);
  dz_dt = load_ + inputs_.ambient_K * to_ambient_;
  dz_dt.noalias() -= conduction_ * z;
  for (const Source& s : sources_) dz_dt += value(*s.law) * s.load;
  for (const Exchange& e : exchanges_) {
    const double c = value(*e.law);
    dz_dt.noalias() -= c * (e.matrix * z);
    dz_dt += c * (inputs_.ambient_K * e.to_ambient + e.offset);
  }
}

Eigen::MatrixXd LiveRate::tangent(double t_s, const Eigen::VectorXd& z) {
  constexpr double kHalfStep_K = 0.01;
  look(t_s, z);
  Eigen::MatrixXd slope = -conduction_;
  const auto along_probes = [&](const BoundLaw& law, const Eigen::VectorXd& what) {
    for (int p : law.probes) {
      double& probe_K = probe_K_[static_cast<std::size_t>(p)];
      const double here_K = probe_K;
      probe_K = here_K + kHalfStep_K;
      const double above = value(law);
      probe_K = here_K - kHalfStep_K;
      const double below = value(law);
      probe_K = here_K;
      slope +=
          (above - below) / (2.0 * kHalfStep_K) * what * system_.probes[static_cast<std::size_t>(p)].weights.transpose();
    }
  };
  for (const Source& s : sources_) along_probes(*s.law, s.load);
  for (const Exchange& e : exchanges_) {
    slope -= value(*e.law) * e.matrix;
    along_probes(*e.law, inputs_.ambient_K * e.to_ambient + e.offset - e.matrix * z);
  }
  return slope;
}

}  // namespace driftwright::solver
