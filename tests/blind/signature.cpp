#include "blind/signature.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace driftwright::blind {
namespace {

constexpr double kBeyond_s = 600.0;

bool acts_in(const Hidden& h, const CasePlan& plan, std::size_t record) {
  const bool is_holdout = record + 1 == plan.records.size();
  return h.record < 0 || (!is_holdout && static_cast<std::size_t>(h.record) == record);
}

}  // namespace

Readings readings_of(const Subject& s, const Values& scattered, const std::vector<Hidden>& all, const CasePlan& plan,
                     std::size_t record, double step_s, bool is_full) {
  const RecordPlan& planned = plan.records[record];
  std::vector<Hidden> hidden;
  for (const Hidden& h : all) {
    if (acts_in(h, plan, record)) hidden.push_back(h);
  }
  std::stable_sort(hidden.begin(), hidden.end(),
                   [](const Hidden& a, const Hidden& b) { return reading_order(a.what) < reading_order(b.what); });
  Run run{.drive = planned.drive, .ambient_K = {}, .duration_s = planned.drive.duration_s() + kBeyond_s, .step_s = step_s};
  run.drive.sections.back().duration_s += kBeyond_s;
  Values values = scattered;
  for (const Hidden& h : hidden) {
    run.drive = true_drive(h, run.drive);
    hide_in_values(h, s, values);
  }
  effects::HeatBalance balance = balance_of(s, values);
  for (const Hidden& h : hidden) hide_in_heat(h, s, run.drive, balance);
  run.ambient_K = [&](double t_s) {
    double ambient_K = planned.ambient.at(t_s);
    for (const Hidden& h : hidden) ambient_K += ambient_error_K(h, t_s);
    return ambient_K;
  };
  const Laws laws = laws_of(balance);
  Readings r{.step_s = step_s, .name = {}, .value = {}, .ambient_K = {}};
  for (std::size_t i = 0; i < s.n_outputs(); ++i) r.name.push_back(s.output_name(i));
  r.value = is_full ? integrate(full_network(s, values), laws, run) : integrate(small_network(s, values), laws, run);
  r.ambient_K.resize(r.value.cols());
  for (Eigen::Index k = 0; k < r.ambient_K.size(); ++k) r.ambient_K[k] = run.ambient_K(r.time_s(k));
  for (const Hidden& h : hidden) hide_in_readings(h, run.drive, s.top_speed_rpm, r);
  return r;
}

Loudness::Loudness(const Subject& s, const CasePlan& plan) : subject_(s), plan_(plan) {
  const Values nominal = nominal_values(s);
  nominal_ = rows(nominal, {});
  jacobian_.resize(nominal_.size(), static_cast<Eigen::Index>(s.scatter.size()));
  for (std::size_t p = 0; p < s.scatter.size(); ++p) {
    Values values = nominal;
    scale(values, s.scatter[p], std::exp(s.scatter[p].sigma));
    jacobian_.col(static_cast<Eigen::Index>(p)) = rows(values, {}) - nominal_;
  }
  const Eigen::Index n = jacobian_.cols();
  inverse_ =
      (jacobian_.transpose() * jacobian_ + Eigen::MatrixXd::Identity(n, n)).llt().solve(Eigen::MatrixXd::Identity(n, n));
}

Eigen::VectorXd Loudness::rows(const Values& values, const std::vector<Hidden>& hidden) const {
  std::vector<double> list;
  for (std::size_t record = 0; record < plan_.n_measured(); ++record) {
    const Readings r = readings_of(subject_, values, hidden, plan_, record, kRow_s, false);
    const auto n = static_cast<Eigen::Index>(plan_.records[record].drive.duration_s() / kRow_s) + 1;
    for (Eigen::Index i = 0; i < r.value.rows(); ++i) {
      const bool is_temperature = static_cast<std::size_t>(i) < subject_.n_sensors();
      if (is_temperature && plan_.displacements_only) continue;
      const double unit = is_temperature ? 1.0 : 1e6;
      const double noise = plan_.noise[static_cast<std::size_t>(i)].against_slow(kRow_s);
      for (Eigen::Index k = 0; k < n; ++k) list.push_back(unit * r.value(i, k) / noise);
    }
  }
  return Eigen::Map<Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

Eigen::VectorXd Loudness::signature(const std::vector<Hidden>& hidden) const {
  return rows(nominal_values(subject_), hidden) - nominal_;
}

double Loudness::product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  return a.dot(b) - (jacobian_.transpose() * a).dot(inverse_ * (jacobian_.transpose() * b));
}

double Loudness::d_prime(const Hidden& hidden) const {
  const Eigen::VectorXd s = signature({hidden});
  return std::sqrt(std::max(0.0, product(s, s)));
}

double tune(const Loudness& loudness, Hidden& h, double wanted) {
  double d = loudness.d_prime(h);
  if (!has_size(h.what)) return d;
  double power = 1.0;  // d' ~ size^power, as the last two say
  for (int round = 0; round < 6 && std::abs(std::log(d / wanted)) > 0.05; ++round) {
    const double size_before = h.size, d_before = d;
    const double change = std::clamp(std::pow(wanted / std::max(d, 1e-9), 1.0 / power), 0.05, 20.0);
    const double size = std::clamp(std::abs(h.size) * change, h.low, h.high);
    h.size = std::copysign(h.what == Hide::kMissingStop ? 60.0 * std::round(size / 60.0) : size, h.size);
    if (h.size == size_before) break;
    d = loudness.d_prime(h);
    const double seen = std::log(std::max(d, 1e-9) / std::max(d_before, 1e-9)) / std::log(h.size / size_before);
    power = std::clamp(seen, 0.3, 3.0);
  }
  return d;
}

}  // namespace driftwright::blind
