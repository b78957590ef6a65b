#include "identification/foster_network.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "identification/non_negative.hpp"

namespace driftwright::identification {
namespace {

// Weight of the constraint that a thermometer's shares sum to at most 1, relative to the largest of its normal equations.
constexpr double kMeanOne = 1e4;
constexpr double kTiny = 1e-12;
constexpr double kNothing = 1e9;  // a penalty that forces a coefficient to zero

/// Inverse of normal equations of the numbers that are above 0; 0 for the others, which are at their limit.
Eigen::MatrixXd inverse_of_free(const Eigen::MatrixXd& normal, const Eigen::VectorXd& numbers) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    if (numbers[i] > 0.0) free.push_back(i);
  }
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(numbers.size(), numbers.size());
  if (free.empty()) return inverse;
  const auto n = static_cast<Eigen::Index>(free.size());
  const Eigen::MatrixXd of_free = normal(free, free), inverse_of_them = of_free.llt().solve(Eigen::MatrixXd::Identity(n, n));
  inverse(free, free) = inverse_of_them;
  return inverse;
}

}  // namespace

std::size_t Structure::n_heated() const {
  std::size_t n = 0;
  for (const Pole& p : poles) n += p.laws.size();
  return n;
}

ChannelFit mean_fit(std::span<const ChannelFit> fits) {
  ChannelFit mean = fits.front();
  const auto n = static_cast<double>(fits.size());
  for (const ChannelFit& f : fits.subspan(1)) {
    mean.weight += f.weight;
    mean.of_ambient += f.of_ambient;
    mean.kept += f.kept;
    mean.offset += f.offset;
    mean.of_records += f.of_records;
    if (mean.covariance.size() == 0)
      mean.covariance = f.covariance;
    else if (f.covariance.size() > 0)
      mean.covariance += f.covariance;
  }
  mean.weight /= n;
  mean.of_ambient /= n;
  mean.kept /= n;
  mean.offset /= n;
  mean.of_records /= n;
  mean.covariance /= n;
  return mean;
}

Eigen::MatrixXd spread(std::span<const ChannelFit> fits) {
  const Eigen::VectorXd mean = mean_fit(fits).weight;
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(mean.size(), mean.size());
  for (const ChannelFit& f : fits) squares += (f.weight - mean) * (f.weight - mean).transpose();
  return squares / static_cast<double>(fits.size());
}

std::vector<NetworkBody> bodies_of(const Structure& structure, bool has_ambient, double rise_K) {
  std::vector<NetworkBody> bodies;
  for (const Pole& p : structure.poles) {
    for (std::size_t law : p.laws) bodies.push_back({p.tau_s, law, rise_K});
  }
  for (const Pole& p : structure.poles) {
    if (has_ambient) bodies.push_back({p.tau_s, std::nullopt, 0.0});
  }
  return bodies;
}

FosterProblem::FosterProblem(std::span<const Record> records, const RecordRoles& roles, Structure structure, double rise_K,
                             const std::vector<std::size_t>& blocks, std::span<const Record> simulated)
    : structure_(std::move(structure)), has_ambient_(!roles.ambient.empty()) {
  bodies_ = bodies_of(structure_, has_ambient_, rise_K);
  channels_ = roles.thermometers;
  n_thermometers_ = channels_.size();
  channels_.insert(channels_.end(), roles.displacements.begin(), roles.displacements.end());
  for (const std::string& c : channels_) counts_from_start_.push_back(records[0].at(c).unit != "degC");
  first_row_ = {0};
  for (std::size_t r = 0; r < records.size(); ++r)
    first_row_.push_back(first_row_.back() + records[r].n_samples() / blocks[r]);
  const auto n = static_cast<Eigen::Index>(first_row_.back()), n_poles = static_cast<Eigen::Index>(structure_.poles.size());
  n_heated_ = static_cast<Eigen::Index>(structure_.n_heated());
  n_ambient_ = has_ambient_ ? n_poles : 0;
  n_direct_ = has_ambient_ ? 1 : 0;
  n_scenario_ = simulated.empty() ? 0 : 1;
  n_records_ = static_cast<Eigen::Index>(records.size());
  n_starts_ = n_records_ * n_poles;
  columns_.setZero(n, first_of_records() + n_records_ + n_starts_);
  body_columns_.setZero(n, static_cast<Eigen::Index>(bodies_.size()));
  ambient_K_.setZero(n);
  readings_.setConstant(n, static_cast<Eigen::Index>(channels_.size()), std::numeric_limits<double>::quiet_NaN());
  if (extends_scenario()) simulated_.setZero(n, readings_.cols());
  if (has_ambient_) reference_degC_ = held(records[0].at(roles.ambient))[0];
  for (std::size_t p = 0; p < structure_.poles.size(); ++p) {
    pole_of_heated_.insert(pole_of_heated_.end(), structure_.poles[p].laws.size(), p);
  }
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Record& record = records[r];
    const auto at = static_cast<Eigen::Index>(first_row_[r]), rows = static_cast<Eigen::Index>(first_row_[r + 1]) - at;
    const auto block = static_cast<Eigen::Index>(blocks[r]);
    const auto means = [&](const Eigen::VectorXd& v) {
      return Eigen::VectorXd(v.head(rows * block).reshaped(block, rows).colwise().mean());
    };
    std::vector<Eigen::VectorXd> laws;
    for (const Law& law : structure_.laws) laws.push_back(values_of(law, record));
    Eigen::VectorXd ambient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(record.n_samples()));
    double first_degC = reference_degC_;
    if (has_ambient_) {
      ambient = held(record.at(roles.ambient));
      first_degC = ambient[0];
      ambient.array() -= first_degC;
      ambient_K_.segment(at, rows) = means(ambient);
    }
    Eigen::Index heated = 0;
    for (std::size_t p = 0; p < structure_.poles.size(); ++p) {
      const Pole& pole = structure_.poles[p];
      Eigen::VectorXd slow = Eigen::VectorXd::Zero(rows);
      if (has_ambient_) slow = means(lagged_ramps(record.time_s, ambient, pole.tau_s));
      for (std::size_t law : pole.laws) {
        columns_.col(heated).segment(at, rows) = rise_K * means(lagged_steps(record.time_s, laws[law], pole.tau_s));
        body_columns_.col(heated).segment(at, rows) = columns_.col(heated).segment(at, rows);
        if (!extends_scenario()) body_columns_.col(heated).segment(at, rows) += slow;
        ++heated;
      }
      if (has_ambient_) {
        const auto a = n_heated_ + static_cast<Eigen::Index>(p);
        columns_.col(a).segment(at, rows) = slow;
        body_columns_.col(a).segment(at, rows) = slow;
      }
      Eigen::VectorXd start(static_cast<Eigen::Index>(record.n_samples()));
      for (Eigen::Index i = 0; i < start.size(); ++i)
        start[i] = std::exp(-(record.time_s[static_cast<std::size_t>(i)] - record.time_s[0]) / pole.tau_s);
      columns_.col(first_of_records() + n_records_ + static_cast<Eigen::Index>(r) * n_poles + static_cast<Eigen::Index>(p))
          .segment(at, rows) = means(start);
    }
    if (has_ambient_) columns_.col(n_heated_ + n_ambient_).segment(at, rows) = ambient_K_.segment(at, rows);
    columns_.col(first_of_records() + static_cast<Eigen::Index>(r)).segment(at, rows).setOnes();
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const std::vector<double>& values = record.at(channels_[c]).values;
      const double less = counts_from_start_[c] ? 0.0 : first_degC;
      if (extends_scenario()) {
        const std::vector<double>& said = simulated[r].at(channels_[c]).values;
        const double from = counts_from_start_[c] ? said.front() : first_degC;
        simulated_.col(static_cast<Eigen::Index>(c)).segment(at, rows) =
            means(Eigen::Map<const Eigen::VectorXd>(said.data(), static_cast<Eigen::Index>(said.size())).array() - from);
      }
      for (Eigen::Index i = 0; i < rows; ++i) {
        double sum = 0.0, there = 0.0;
        for (Eigen::Index k = i * block; k < (i + 1) * block; ++k) {
          const double v = values[static_cast<std::size_t>(k)];
          if (!std::isfinite(v)) continue;
          sum += v - less;
          there += 1.0;
        }
        if (there > 0.0) readings_(at + i, static_cast<Eigen::Index>(c)) = sum / there;
      }
    }
  }
}

FosterProblem::Normal FosterProblem::normal(const std::vector<bool>& hidden) const {
  Normal result;
  result.c.setZero(columns_.cols(), readings_.cols());
  result.with_scenario.setZero(columns_.cols(), readings_.cols());
  result.scenario_squares.setZero(readings_.cols());
  std::map<std::vector<bool>, std::size_t> known;
  for (Eigen::Index c = 0; c < readings_.cols(); ++c) {
    std::vector<bool> counts(n_rows());
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < n_rows(); ++i) {
      counts[i] = !hidden[i] && std::isfinite(readings_(static_cast<Eigen::Index>(i), c));
      if (counts[i]) rows.push_back(static_cast<Eigen::Index>(i));
    }
    const Eigen::MatrixXd x = columns_(rows, Eigen::all);
    const Eigen::VectorXd y = readings_.col(c)(rows);
    result.c.col(c) = x.transpose() * y;
    if (extends_scenario()) {
      const Eigen::VectorXd said = simulated_.col(c)(rows);
      result.with_scenario.col(c) = x.transpose() * said;
      result.scenario_squares[c] = said.squaredNorm();
      result.c(first_of_records() - 1, c) = said.dot(y);
    }
    result.n.push_back(static_cast<double>(rows.size()));
    const auto [entry, is_new] = known.emplace(counts, result.own.size());
    if (is_new) result.own.emplace_back(x.transpose() * x);
    result.of.push_back(entry->second);
  }
  return result;
}

std::vector<ChannelFit> FosterProblem::fits(const Normal& normal, std::size_t channel,
                                            std::span<const Smoothness> members) const {
  std::vector<ChannelFit> list;
  for (const Smoothness& s : members) list.push_back(fit(normal, channel, s));
  return list;
}

ChannelFit FosterProblem::fit(const Normal& normal, std::size_t channel, const Smoothness& smoothness) const {
  if (smoothness.is_scenario_alone) return scenario_alone(normal, channel, smoothness);
  Eigen::MatrixXd g = normal.own[normal.of[channel]];
  const auto at = static_cast<Eigen::Index>(channel);
  if (extends_scenario()) {
    const Eigen::Index scenario = first_of_records() - 1;
    g.col(scenario) = normal.with_scenario.col(at);
    g.row(scenario) = normal.with_scenario.col(at).transpose();
    g(scenario, scenario) = normal.scenario_squares[at];
  }
  const Eigen::VectorXd c = normal.c.col(at);
  return channel < n_thermometers_ ? fit_thermometer(g, c, normal.n[channel], counts_from_start_[channel] != 0, smoothness)
                                   : fit_displacement(g, c, normal.n[channel], smoothness);
}

ChannelFit FosterProblem::fit_thermometer(const Eigen::MatrixXd& g, const Eigen::VectorXd& c, double n, bool is_rise,
                                          const Smoothness& smoothness) const {
  // Columns with shares: bodies, then the ambient itself, the scenario. Other columns: one constant, or one per record, and
  // starts.
  const Eigen::Index n_constants = is_rise ? n_records_ : 1;
  const Eigen::Index n_bodies = n_heated_ + n_ambient_, n_shares = first_of_records(), n_beside = n_constants + n_starts_;
  Eigen::MatrixXd to = Eigen::MatrixXd::Zero(g.rows(), n_shares + n_beside);
  for (Eigen::Index b = 0; b < n_heated_; ++b) {
    to(b, b) = 1.0;
    if (has_ambient_ && !extends_scenario())
      to(n_heated_ + static_cast<Eigen::Index>(pole_of_heated_[static_cast<std::size_t>(b)]), b) = 1.0;
  }
  for (Eigen::Index b = n_heated_; b < n_shares; ++b) to(b, b) = 1.0;
  for (Eigen::Index r = 0; r < n_records_; ++r) to(n_shares + r, n_shares + (is_rise ? r : 0)) = 1.0;
  for (Eigen::Index s = 0; s < n_starts_; ++s) to(n_shares + n_records_ + s, n_shares + n_constants + s) = 1.0;
  Eigen::MatrixXd all = to.transpose() * g * to;
  const Eigen::VectorXd right = to.transpose() * c;
  Eigen::MatrixXd beside = all.bottomRightCorner(n_beside, n_beside);
  beside.diagonal().tail(n_starts_).array() += smoothness.start_of_thermometers * n;
  beside.diagonal().array() += kTiny * n;
  if (!is_rise) beside(0, 0) += smoothness.offset * n;
  const Eigen::LLT<Eigen::MatrixXd> factor(beside);
  const Eigen::MatrixXd cross = all.bottomLeftCorner(n_beside, n_shares), solved = factor.solve(cross);
  Eigen::MatrixXd reduced = all.topLeftCorner(n_shares, n_shares) - cross.transpose() * solved;
  Eigen::VectorXd target = right.head(n_shares) - solved.transpose() * right.tail(n_beside);
  const double largest = std::max(reduced.diagonal().maxCoeff(), kTiny);
  Eigen::VectorXd penalty = smoothness.thermometers * (reduced.diagonal().array() + kTiny * largest);
  if (extends_scenario()) penalty[n_shares - 1] *= smoothness.scenario_of_thermometers / smoothness.thermometers;
  reduced.diagonal() += penalty;
  reduced.diagonal().array() += 1e-9 * largest;
  if (extends_scenario()) target[n_shares - 1] += penalty[n_shares - 1];  // the penalty draws it to 1
  Eigen::VectorXd shares = non_negative_least_squares(reduced, target);
  const Eigen::Index first_of_mean = extends_scenario() ? n_heated_ : 0, n_mean = n_shares - first_of_mean;
  if ((has_ambient_ || extends_scenario()) && shares.tail(n_mean).sum() > 1.0) {
    reduced.bottomRightCorner(n_mean, n_mean).array() += kMeanOne * largest;
    target.tail(n_mean).array() += kMeanOne * largest;
    shares = non_negative_least_squares(reduced, target);
  }
  ChannelFit fit;
  fit.kept = extends_scenario() ? shares[n_shares - 1] : 0.0;
  fit.weight = shares.head(n_bodies);
  fit.covariance = inverse_of_free(reduced, shares).topLeftCorner(n_bodies, n_bodies);
  fit.of_ambient = has_ambient_ ? shares[n_bodies] : 0.0;
  const Eigen::VectorXd rest = factor.solve(right.tail(n_beside) - cross * shares);
  fit.offset = is_rise ? 0.0 : rest[0];
  fit.of_records = Eigen::VectorXd::Zero(n_records_ + n_starts_);
  if (is_rise) fit.of_records.head(n_records_) = rest.head(n_records_);
  fit.of_records.tail(n_starts_) = rest.tail(n_starts_);
  return fit;
}

ChannelFit FosterProblem::fit_displacement(const Eigen::MatrixXd& g, const Eigen::VectorXd& c, double n,
                                           const Smoothness& smoothness) const {
  // The effects of heat and of the ambient on a body have one weight each, the scenario has one; the ambient itself has
  // none.
  std::vector<Eigen::Index> parts_at, beside_at;
  for (Eigen::Index i = 0; i < n_heated_ + n_ambient_; ++i) parts_at.push_back(i);
  if (extends_scenario()) parts_at.push_back(first_of_records() - 1);
  for (Eigen::Index i = first_of_records(); i < g.rows(); ++i) beside_at.push_back(i);
  const auto n_parts = static_cast<Eigen::Index>(parts_at.size());
  Eigen::MatrixXd beside = g(beside_at, beside_at);
  beside.diagonal().tail(n_starts_).array() += smoothness.start_of_displacements * n;
  beside.diagonal().array() += kTiny * n + 1e-9;
  const Eigen::LLT<Eigen::MatrixXd> factor(beside);
  const Eigen::MatrixXd cross = g(beside_at, parts_at), solved = factor.solve(cross);
  Eigen::MatrixXd reduced = Eigen::MatrixXd(g(parts_at, parts_at)) - cross.transpose() * solved;
  Eigen::VectorXd target = Eigen::VectorXd(c(parts_at)) - solved.transpose() * Eigen::VectorXd(c(beside_at));
  const double largest = std::max(reduced.diagonal().maxCoeff(), kTiny);
  for (Eigen::Index i = 0; i < n_heated_ + n_ambient_; ++i)
    reduced(i, i) += (i < n_heated_ ? smoothness.drive : smoothness.ambient) * reduced(i, i) + 1e-9 * largest;
  if (extends_scenario()) {  // the penalty draws it to 1
    const double penalty = smoothness.scenario_of_displacements * reduced(n_parts - 1, n_parts - 1) + 1e-9 * largest;
    reduced(n_parts - 1, n_parts - 1) += penalty;
    target[n_parts - 1] += penalty;
  }
  Eigen::LLT<Eigen::MatrixXd> parts(reduced);
  Eigen::VectorXd part = parts.solve(target);
  if (extends_scenario() && (part[n_parts - 1] < 0.0 || part[n_parts - 1] > 1.0)) {
    const double kept = std::clamp(double(part[n_parts - 1]), 0.0, 1.0), firm = 1e6 * reduced(n_parts - 1, n_parts - 1);
    reduced(n_parts - 1, n_parts - 1) += firm;
    target[n_parts - 1] += firm * kept;
    parts.compute(reduced);
    part = parts.solve(target);
  }
  ChannelFit fit;
  fit.weight = part.head(n_heated_ + n_ambient_);
  fit.kept = extends_scenario() ? part[n_parts - 1] : 0.0;
  fit.of_records = factor.solve(Eigen::VectorXd(c(beside_at)) - cross * part);
  fit.covariance = Eigen::MatrixXd(parts.solve(Eigen::MatrixXd::Identity(n_parts, n_parts)))
                       .topLeftCorner(n_heated_ + n_ambient_, n_heated_ + n_ambient_);
  if (has_ambient_ && !extends_scenario()) {
    for (Eigen::Index b = 0; b < n_heated_; ++b)
      fit.weight[n_heated_ + static_cast<Eigen::Index>(pole_of_heated_[static_cast<std::size_t>(b)])] -= part[b];
  }
  return fit;
}

ChannelFit FosterProblem::scenario_alone(const Normal& normal, std::size_t channel, Smoothness smoothness) const {
  smoothness.is_scenario_alone = false;
  smoothness.thermometers = smoothness.drive = smoothness.ambient = kNothing;
  smoothness.scenario_of_thermometers = smoothness.scenario_of_displacements = smoothness.offset = kNothing;
  ChannelFit alone = fit(normal, channel, smoothness);
  alone.weight.setZero();
  alone.of_ambient = alone.offset = 0.0;
  alone.kept = 1.0;
  alone.covariance.resize(0, 0);
  return alone;
}

Eigen::VectorXd FosterProblem::predicted(std::size_t channel, const ChannelFit& fit, bool in_records) const {
  Eigen::VectorXd y = body_columns_ * fit.weight;
  if (channel < n_thermometers_) y += fit.of_ambient * ambient_K_ + Eigen::VectorXd::Constant(y.size(), fit.offset);
  if (extends_scenario()) y += fit.kept * simulated(channel);
  if (in_records) y += columns_.rightCols(n_records_ + n_starts_) * fit.of_records;
  return y;
}

Eigen::VectorXd FosterProblem::heated_K(std::size_t body) const {
  const auto b = static_cast<Eigen::Index>(body);
  return b < n_heated_ ? Eigen::VectorXd(columns_.col(b)) : Eigen::VectorXd::Zero(columns_.rows());
}

double FosterProblem::zero_of(std::size_t record, std::size_t channel, const ChannelFit& fit, bool in_records) const {
  if (!counts_from_start_[channel] || (in_records && fit.of_records[static_cast<Eigen::Index>(record)] != 0.0)) return 0.0;
  const auto c = static_cast<Eigen::Index>(channel);
  for (auto i = static_cast<Eigen::Index>(first_row_[record]); i < static_cast<Eigen::Index>(first_row_[record + 1]); ++i) {
    if (!std::isfinite(readings_(i, c))) continue;
    double e = readings_(i, c) - body_columns_.row(i).dot(fit.weight);
    if (channel < n_thermometers_) e -= fit.of_ambient * ambient_K_[i] + fit.offset;
    if (extends_scenario()) e -= fit.kept * simulated_(i, c);
    if (in_records) e -= columns_.row(i).tail(n_records_ + n_starts_).dot(fit.of_records);
    return e;
  }
  return 0.0;
}

Eigen::VectorXd FosterProblem::misses(std::size_t channel, const ChannelFit& fit, bool in_records) const {
  Eigen::VectorXd e = measured(channel) - predicted(channel, fit, in_records);
  for (std::size_t r = 0; r + 1 < first_row_.size(); ++r)
    e.segment(static_cast<Eigen::Index>(first_row_[r]), static_cast<Eigen::Index>(first_row_[r + 1] - first_row_[r]))
        .array() -= zero_of(r, channel, fit, in_records);
  return e;
}

FosterProblem::Part FosterProblem::part(const std::vector<bool>& rows) const {
  Part p;
  std::vector<Eigen::Index> at;
  for (std::size_t r = 0; r + 1 < first_row_.size(); ++r) {
    for (std::size_t i = first_row_[r]; i < first_row_[r + 1]; ++i) {
      if (!rows[i]) continue;
      at.push_back(static_cast<Eigen::Index>(i));
      p.records.push_back(r);
    }
  }
  p.bodies = body_columns_(at, Eigen::all);
  p.of_records = columns_.rightCols(n_records_ + n_starts_)(at, Eigen::all);
  p.readings = readings_(at, Eigen::all);
  p.ambient_K = ambient_K_(at);
  if (extends_scenario()) p.simulated = simulated_(at, Eigen::all);
  return p;
}

double FosterProblem::rms(const Part& part, std::size_t channel, const ChannelFit& fit, bool in_records) const {
  const auto c = static_cast<Eigen::Index>(channel);
  Eigen::VectorXd e = part.readings.col(c) - part.bodies * fit.weight;
  if (channel < n_thermometers_) e -= fit.of_ambient * part.ambient_K + Eigen::VectorXd::Constant(e.size(), fit.offset);
  if (extends_scenario()) e -= fit.kept * part.simulated.col(c);
  if (in_records) e -= part.of_records * fit.of_records;
  std::vector<double> zero(static_cast<std::size_t>(n_records_));
  for (std::size_t r = 0; r < zero.size(); ++r) zero[r] = zero_of(r, channel, fit, in_records);
  double squares = 0.0, n = 0.0;
  for (Eigen::Index i = 0; i < e.size(); ++i) {
    const double value = e[i] - zero[part.records[static_cast<std::size_t>(i)]];
    if (!std::isfinite(value)) continue;
    squares += value * value;
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(squares / n) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace driftwright::identification
