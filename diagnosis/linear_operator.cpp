#include "diagnosis/linear_operator.hpp"

#include <algorithm>
#include <cmath>

#include "base/dense.hpp"
#include "effects/feed_axis.hpp"
#include "effects/reading_chain.hpp"

namespace driftwright::diagnosis {
double law_value(const solver::BoundLaw& law, const solver::ReducedSystem& system, const effects::Inputs& u,
                 const Eigen::VectorXd& z) {
  if (law.thermostat >= 0) {
    const solver::Thermostat& t = system.thermostats[static_cast<std::size_t>(law.thermostat)];
    const double at_K = system.reference_K + system.probes[static_cast<std::size_t>(t.probe)].theta_K(z, u.ambient_K);
    if (at_K < 0.5 * (t.on_above_K + t.off_below_K)) return 0.0;
  }
  if (!law.looks_at_state()) return law(u);
  effects::Inputs with_probes = u;
  for (int p : law.probes)
    with_probes.probe_K.push_back(system.reference_K + system.probes[static_cast<std::size_t>(p)].theta_K(z, u.ambient_K));
  return law.law(with_probes);
}

LinearOperator::LinearOperator(const Twin& twin, const MeasuredRun& run, const TwinState& state, Twin::Workspace& workspace)
    : twin_(twin), run_(run), time_s_(run.time_s) {
  const Eigen::MatrixXd all = twin.states(state, run, workspace);
  const Twin::Bound bound = twin.bound(state, run, workspace);
  system_ = bound.system;
  weights_ = bound.outputs;
  const Eigen::Index n = n_rows(), size = system_.size();
  z_.resize(size, n);
  ambient_K_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    z_.col(i).head(all.rows()) = all.col(run.row_in_grid[static_cast<std::size_t>(i)]);
    z_.col(i).tail(size - all.rows()).setZero();
    ambient_K_[i] = bound.ambient.at(time_s_[static_cast<std::size_t>(i)]);
  }
  ambient_middle_K_ = 0.5 * (ambient_K_.head(n - 1) + ambient_K_.tail(n - 1));
  const auto n_sources = static_cast<Eigen::Index>(system_.sources.size()),
             n_exchanges = static_cast<Eigen::Index>(system_.exchanges.size()),
             n_channels = static_cast<Eigen::Index>(run.channels.size());
  heats_.setZero(n_sources, n - 1);
  standing_.setZero(n_sources, n - 1);
  coefficients_.resize(n_exchanges, n - 1);
  observe_ = Eigen::MatrixXd::Zero(size, n_channels);
  for (Eigen::Index c = 0; c < n_channels; ++c) {
    const int o = run.channels[static_cast<std::size_t>(c)].output;
    observe_.col(c).head(bound.outputs.rows()) = bound.outputs.col(o);
  }
  middle_ = 0.5 * (z_.leftCols(n - 1) + z_.rightCols(n - 1));
  predicted_ = observe_.transpose() * z_;
  for (Eigen::Index c = 0; c < predicted_.rows(); ++c)
    predicted_.row(c) += twin_.outputs().ambient[run_.channels[static_cast<std::size_t>(c)].output] * ambient_K_;
  if (std::any_of(state.begin(), state.end(), effects::follows_positions))
    read_at_positions(state, twin.outputs_of(state, run, all));
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const double middle_s = 0.5 * (time_s_[static_cast<std::size_t>(i)] + time_s_[static_cast<std::size_t>(i + 1)]);
    effects::Inputs u{
        .drive = bound.cyclogram.drive(middle_s), .ambient_K = ambient_middle_K_[i], .time_s = middle_s, .run = run.name};
    drive_.push_back(u.drive);
    const Eigen::VectorXd at = middle_.col(i);
    for (Eigen::Index e = 0; e < n_exchanges; ++e)
      coefficients_(e, i) = law_value(system_.exchanges[static_cast<std::size_t>(e)].coefficient, system_, u, at);
    for (Eigen::Index s = 0; s < n_sources; ++s)
      heats_(s, i) = law_value(system_.sources[static_cast<std::size_t>(s)].power_W, system_, u, at);
    if (u.drive.speed_rpm == 0.0) continue;
    effects::Inputs still = u;
    still.drive.speed_rpm = 0.0;
    for (Eigen::Index s = 0; s < n_sources; ++s) {
      const solver::BoundLaw& law = system_.sources[static_cast<std::size_t>(s)].power_W;
      standing_(s, i) = law_value(law, system_, still, at) - heats_(s, i);
    }
  }
  Eigen::VectorXd held;
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const Eigen::VectorXd now = coefficients_.col(i);
    const double tiny = 1e-9 * std::max(1e-300, n_exchanges > 0 ? now.cwiseAbs().maxCoeff() : 0.0);
    const bool is_same = !modes_.empty() && ((now - held).array().abs() <= kSameModes * held.array().abs() + tiny).all();
    if (!is_same) {
      Eigen::MatrixXd k = system_.conduction;
      for (Eigen::Index e = 0; e < n_exchanges; ++e) k += now[e] * system_.exchanges[static_cast<std::size_t>(e)].matrix;
      const dense::GeneralizedSymmetricEigen eigen(0.5 * (k + k.transpose()), system_.mass);
      Modes m{.rate_1_s = eigen.eigenvalues(), .vectors = eigen.eigenvectors(), .observe = {}, .from = {}};
      m.observe = m.vectors.transpose() * observe_;
      if (!modes_.empty()) m.from = m.vectors.transpose() * system_.mass * modes_.back().vectors;
      held = now;
      modes_.push_back(std::move(m));
    }
    of_interval_.push_back(modes_.size() - 1);
  }
}

void LinearOperator::read_at_positions(const TwinState& state, const Eigen::MatrixXd& outputs) {
  constexpr double kStep_K = 1e-3;  // the readings are linear in the temperatures, but for a screw that loses its stretch
  TwinState alone;                  // without other effects on readings, as the rest of the operator
  std::vector<effects::Body> bodies;
  for (const effects::Effect& e : state) {
    if (effects::changes_readings(e) && !effects::follows_positions(e)) continue;
    alone.push_back(e);
    if (!effects::follows_positions(e)) continue;
    for (const effects::Body& body : effects::bodies_read(e)) {
      if (!(body == effects::ambient_node()) && std::find(bodies.begin(), bodies.end(), body) == bodies.end())
        bodies.push_back(body);
    }
  }
  const Eigen::MatrixXd read = twin_.read(alone, run_, outputs);
  const auto& names = twin_.outputs().name;
  const auto n_channels = static_cast<Eigen::Index>(run_.channels.size());
  for (Eigen::Index c = 0; c < n_channels; ++c)
    predicted_.row(c) = read.row(run_.channels[static_cast<std::size_t>(c)].output);
  for (const effects::Body& body : bodies) {
    const auto found = std::find(names.begin(), names.end(), effects::mean_output(body.name));
    if (found == names.end()) continue;  // a body without heat capacity has no mean temperature
    const auto o = static_cast<Eigen::Index>(found - names.begin());
    Eigen::MatrixXd warmer = outputs;
    warmer.row(o).array() += kStep_K;
    const Eigen::MatrixXd slope = (twin_.read(alone, run_, std::move(warmer)) - read) / kStep_K;
    const Eigen::Index seen = observe_.cols();
    for (Eigen::Index c = 0; c < n_channels; ++c) {
      const Eigen::Index output = run_.channels[static_cast<std::size_t>(c)].output;
      if (output != o && slope.row(output).cwiseAbs().maxCoeff() > 0.0) at_position_.push_back({c, seen, slope.row(output)});
    }
    if (at_position_.empty() || at_position_.back().seen != seen) continue;
    observe_.conservativeResize(Eigen::NoChange, seen + 1);
    observe_.col(seen).setZero();
    observe_.col(seen).head(weights_.rows()) = weights_.col(o);
  }
}

const Eigen::VectorXd* LinearOperator::load_of(const effects::Body& body) const {
  for (const solver::HeatSource& s : system_.sources) {
    if (s.body == body) return &s.load;
  }
  return nullptr;
}

LinearOperator::Load LinearOperator::in_modes(const Eigen::MatrixXd& load) const {
  Load l(load.rows(), load.cols());
  for (Eigen::Index from = 0; from < load.cols();) {
    const std::size_t m = of_interval_[static_cast<std::size_t>(from)];
    Eigen::Index to = from;
    while (to < load.cols() && of_interval_[static_cast<std::size_t>(to)] == m) ++to;
    l.middleCols(from, to - from).noalias() = modes_[m].vectors.transpose() * load.middleCols(from, to - from);
    from = to;
  }
  for (Eigen::Index k = 0; k < load.cols(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double dt_s = time_s_[i + 1] - time_s_[i];
    const Eigen::ArrayXd x = dt_s * modes_[of_interval_[i]].rate_1_s.array();
    l.col(k).array() *= dt_s * (x.abs() < 1e-9).select(1.0, (1.0 - (-x).exp()) / x);
  }
  return l;
}

LinearOperator::Load LinearOperator::heat(const effects::Body& body) const {
  const Eigen::VectorXd* load = load_of(body);
  if (!load) return {};
  return in_modes(load->replicate(1, n_rows() - 1));
}

Eigen::RowVectorXd LinearOperator::temperature(const effects::Body& body) const {
  if (body == effects::ambient_node()) return ambient_K_;
  const auto& names = twin_.outputs().name;
  for (std::size_t o = 0; o < names.size(); ++o) {
    if (names[o] == effects::mean_output(body.name))
      return weights_.col(static_cast<Eigen::Index>(o)).transpose() * z_.topRows(weights_.rows());
  }
  return {};
}

LinearOperator::Load LinearOperator::conductance(const effects::Body& a, const effects::Body& b) const {
  const Eigen::VectorXd* into_a = load_of(a);
  if (!into_a) return {};
  const Eigen::RowVectorXd t_a = temperature(a), t_b = temperature(b);
  if (t_a.size() == 0 || t_b.size() == 0) return {};
  const Eigen::RowVectorXd difference = t_b - t_a;
  const Eigen::RowVectorXd middle = 0.5 * (difference.head(n_rows() - 1) + difference.tail(n_rows() - 1));
  const Eigen::VectorXd* into_b = b == effects::ambient_node() ? nullptr : load_of(b);
  return in_modes((into_b ? Eigen::VectorXd(*into_a - *into_b) : *into_a) * middle);
}

LinearOperator::Load LinearOperator::exchange(std::size_t e) const {
  const auto& x = system_.exchanges[e];
  Eigen::MatrixXd load = -x.matrix * middle_ + x.to_ambient * ambient_middle_K_;
  if (x.offset.size() > 0) load.colwise() += x.offset;
  return in_modes(load);
}

LinearOperator::Load LinearOperator::conduction(std::size_t part) const {
  const Eigen::MatrixXd& of = twin_.machine().system.parts[part].conduction;
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(system_.size(), n_rows() - 1);
  load.topRows(of.rows()) = -of * middle_.topRows(of.rows());
  return in_modes(load);
}

double LinearOperator::coefficient(std::size_t e) const {
  return coefficients_.row(static_cast<Eigen::Index>(e)).mean();
}

LinearOperator::Load LinearOperator::of_sources(const Eigen::MatrixXd& courses_W) const {
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(system_.size(), n_rows() - 1);
  for (std::size_t s = 0; s < system_.sources.size(); ++s)
    load += system_.sources[s].load * courses_W.row(static_cast<Eigen::Index>(s));
  return in_modes(load);
}

LinearOperator::Load LinearOperator::standing() const {
  return of_sources(standing_);
}

LinearOperator::Load LinearOperator::all_heat() const {
  return of_sources(heats_);
}

LinearOperator::Load LinearOperator::all_loss() const {
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(system_.size(), n_rows() - 1);
  for (std::size_t e = 0; e < system_.exchanges.size(); ++e) {
    const auto& x = system_.exchanges[e];
    if (!x.reaches_ambient()) continue;
    const auto c = coefficients_.row(static_cast<Eigen::Index>(e));
    load += (-x.matrix * middle_ + x.to_ambient * ambient_middle_K_) * c.asDiagonal();
  }
  return in_modes(load);
}

LinearOperator::Load LinearOperator::ambient() const {
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(system_.size(), n_rows() - 1);
  for (std::size_t e = 0; e < system_.exchanges.size(); ++e) {
    if (system_.exchanges[e].reaches_ambient())
      load += system_.exchanges[e].to_ambient * coefficients_.row(static_cast<Eigen::Index>(e));
  }
  return in_modes(load);
}

LinearOperator::Load LinearOperator::capacity(const effects::Body& body, double lag_s) const {
  const Eigen::VectorXd* load = load_of(body);
  Eigen::RowVectorXd t = temperature(body);
  if (!load || t.size() == 0) return {};
  t.array() -= t[0];
  if (lag_s > 0.0) effects::lag_behind(t, time_s_, lag_s);
  Eigen::RowVectorXd heat(n_rows() - 1);
  for (Eigen::Index k = 0; k < heat.size(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    heat[k] = -(t[k + 1] - t[k]) / (time_s_[i + 1] - time_s_[i]);
  }
  return in_modes(*load * heat);
}

Eigen::RowVectorXd LinearOperator::own_heat(const effects::Body& body) const {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(n_rows() - 1);
  for (std::size_t s = 0; s < system_.sources.size(); ++s) {
    if (system_.sources[s].body == body) sum += heats_.row(static_cast<Eigen::Index>(s));
  }
  return sum;
}

Eigen::MatrixXd LinearOperator::expansion(std::size_t part) const {
  const auto& outputs = twin_.machine().system.parts[part].outputs;
  Eigen::MatrixXd of_channels(static_cast<Eigen::Index>(run_.channels.size()), n_rows());
  for (std::size_t c = 0; c < run_.channels.size(); ++c) {
    const Eigen::Index o = run_.channels[c].output;
    if (o < outputs.cols())
      of_channels.row(static_cast<Eigen::Index>(c)) = outputs.col(o).transpose() * z_.topRows(outputs.rows());
    else
      of_channels.row(static_cast<Eigen::Index>(c)).setZero();
  }
  return of_channels;
}

template <class Of>
void LinearOperator::run_modes(const Load& load, const Eigen::RowVectorXd& course, double before, Of of) const {
  const Eigen::Index n = n_rows();
  Eigen::MatrixXd a(load.rows(), n);
  Eigen::VectorXd state = Eigen::VectorXd::Zero(load.rows());
  if (before != 0.0) {
    const Eigen::ArrayXd left = 1.0 - (-(time_s_[1] - time_s_[0]) * modes_.front().rate_1_s.array()).exp();
    state = before * (left.abs() > 1e-9).select(load.col(0).array() / left, 0.0);
  }
  a.col(0) = state;
  Eigen::VectorXd decay;
  double decay_dt_s = -1.0;
  std::size_t decay_of = modes_.size();
  Eigen::Index stretch = 0;  // first row of the current modes
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const std::size_t m = of_interval_[i];
    if (k > 0 && m != of_interval_[i - 1]) {
      of(modes_[of_interval_[i - 1]], a, stretch, k + 1 - stretch);
      stretch = k + 1;
      state = (modes_[m].from * state).eval();
    }
    const double dt_s = time_s_[i + 1] - time_s_[i];
    if (m != decay_of || dt_s != decay_dt_s) {
      decay = (-dt_s * modes_[m].rate_1_s).array().exp();
      decay_of = m;
      decay_dt_s = dt_s;
    }
    state.array() *= decay.array();
    if (course[k] != 0.0) state += course[k] * load.col(k);
    a.col(k + 1) = state;
  }
  of(modes_[of_interval_.back()], a, stretch, n - stretch);
}

Eigen::MatrixXd LinearOperator::response(const Load& load, const Eigen::RowVectorXd& course, double before) const {
  Eigen::MatrixXd seen(observe_.cols(), n_rows());
  run_modes(load, course, before, [&](const Modes& m, const Eigen::MatrixXd& a, Eigen::Index first, Eigen::Index n) {
    seen.middleCols(first, n).noalias() = m.observe.transpose() * a.middleCols(first, n);
  });
  if (at_position_.empty()) return seen;
  for (const AtPosition& at : at_position_) seen.row(at.channel) += at.per_K.cwiseProduct(seen.row(at.seen));
  return seen.topRows(static_cast<Eigen::Index>(run_.channels.size()));
}

}  // namespace driftwright::diagnosis
