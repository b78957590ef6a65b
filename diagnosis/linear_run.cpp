#include "diagnosis/linear_run.hpp"

#include <algorithm>
#include <cmath>

#include "base/dense.hpp"
#include "diagnosis/linear_operator.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kStart_K = 0.3;     // to which the start of a body is known

/// Coefficients of a system's exchanges at a state.
Eigen::VectorXd coefficients(const solver::ReducedSystem& system, const effects::Inputs& u, const Eigen::VectorXd& z) {
  Eigen::VectorXd c(static_cast<Eigen::Index>(system.exchanges.size()));
  for (std::size_t e = 0; e < system.exchanges.size(); ++e)
    c[static_cast<Eigen::Index>(e)] = law_value(system.exchanges[e].coefficient, system, u, z);
  return c;
}

/// Heat of each body that is there because the spindle turns [W].
Eigen::VectorXd turning_heat_W(const solver::ReducedSystem& system, const std::vector<effects::Body>& bodies,
                               const effects::Inputs& u, const Eigen::VectorXd& z) {
  Eigen::VectorXd heat_W = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(bodies.size()));
  if (u.drive.speed_rpm == 0.0) return heat_W;
  effects::Inputs standing = u;
  standing.drive.speed_rpm = 0.0;
  for (const solver::HeatSource& s : system.sources) {
    const auto body = std::find(bodies.begin(), bodies.end(), s.body);
    if (body != bodies.end())
      heat_W[body - bodies.begin()] += law_value(s.power_W, system, u, z) - law_value(s.power_W, system, standing, z);
  }
  return heat_W;
}

}  // namespace

std::vector<effects::Body> bodies_of(const effects::DoubtScene& scene) {
  std::vector<effects::Body> bodies;
  for (const effects::Body& body : scene.bodies) {
    if (!(body == effects::ambient_node())) bodies.push_back(body);
  }
  return bodies;
}

LinearRun linear_run(const Twin& twin, const MeasuredRun& run, const TwinState& state,
                     const std::vector<effects::Body>& bodies, const std::vector<Eigen::Index>& rows,
                     const Eigen::VectorXd& scale, Twin::Workspace& workspace) {
  const Eigen::MatrixXd z = twin.states(state, run, workspace);
  const Twin::Bound bound = twin.bound(state, run, workspace);
  const solver::ReducedSystem& system = bound.system;
  LinearRun l;
  const auto n_rows = static_cast<Eigen::Index>(rows.size()), n_channels = static_cast<Eigen::Index>(run.channels.size()),
             n_bodies = static_cast<Eigen::Index>(bodies.size());
  Eigen::MatrixXd observe(system.size(), n_channels), load = Eigen::MatrixXd::Zero(system.size(), n_bodies),
                                                      mean = Eigen::MatrixXd::Zero(system.size(), n_bodies);
  for (Eigen::Index c = 0; c < n_channels; ++c)
    observe.col(c) = bound.outputs.col(run.channels[static_cast<std::size_t>(c)].output) / scale[c];
  for (Eigen::Index b = 0; b < n_bodies; ++b) {
    const effects::Body& body = bodies[static_cast<std::size_t>(b)];
    for (const solver::HeatSource& s : system.sources) {
      if (!(s.body == body)) continue;
      load.col(b) = s.load;
      break;
    }
    for (std::size_t o = 0; o < twin.outputs().name.size(); ++o) {
      if (twin.outputs().name[o] == "mean of " + body.name) mean.col(b) = bound.outputs.col(static_cast<Eigen::Index>(o));
    }
  }
  l.temperature_K.resize(n_rows, n_bodies);
  l.ambient_K.resize(n_rows);
  l.turning_W.resize(n_bodies, n_rows - 1);
  Eigen::VectorXd held;  // coefficients that the modes at hand were made with
  Eigen::MatrixXd vectors;
  const Eigen::MatrixXd warmer = kStart_K * twin.warmer_bodies();
  for (Eigen::Index i = 0; i < n_rows; ++i) {
    const Eigen::Index row = rows[static_cast<std::size_t>(i)];
    const double t_s = run.time_s[static_cast<std::size_t>(row)];
    const Eigen::VectorXd at = z.col(run.row_in_grid[static_cast<std::size_t>(row)]);
    l.course.time_s.push_back(t_s);
    l.temperature_K.row(i) = at.transpose() * mean;
    l.ambient_K[i] = bound.ambient.at(t_s);
    if (i + 1 == n_rows) break;
    const double next_s = run.time_s[static_cast<std::size_t>(rows[static_cast<std::size_t>(i + 1)])];
    const double middle_s = 0.5 * (t_s + next_s);
    const effects::Inputs inputs{.drive = bound.cyclogram.drive(middle_s),
                                 .ambient_K = bound.ambient.at(middle_s),
                                 .time_s = middle_s,
                                 .run = run.name};
    const Eigen::VectorXd now = coefficients(system, inputs, at);
    l.turning_W.col(i) = turning_heat_W(system, bodies, inputs, at);
    const double tiny = 1e-9 * std::max(1e-300, now.cwiseAbs().maxCoeff());
    const bool is_same = held.size() > 0 && ((now - held).array().abs() <= kSameModes * held.array().abs() + tiny).all();
    if (!is_same) {
      Eigen::MatrixXd k = system.conduction;
      for (std::size_t e = 0; e < system.exchanges.size(); ++e)
        k += now[static_cast<Eigen::Index>(e)] * system.exchanges[e].matrix;
      const dense::GeneralizedSymmetricEigen eigen(0.5 * (k + k.transpose()), system.mass);
      ModalCourse::Modes m;
      m.rate_1_s = eigen.eigenvalues();
      const Eigen::MatrixXd& v = eigen.eigenvectors();
      m.load = v.transpose() * load;
      m.observe = v.transpose() * observe;
      m.mean = v.transpose() * mean;
      if (vectors.size() > 0) m.from = v.transpose() * system.mass * vectors;
      if (vectors.size() == 0) m.start = v.transpose() * system.mass * warmer;
      vectors = v;
      held = now;
      l.course.modes.push_back(std::move(m));
    }
    l.course.of_interval.push_back(l.course.modes.size() - 1);
  }
  l.decay.resize(system.size(), n_rows - 1);
  for (Eigen::Index k = 0; k + 1 < n_rows; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double dt_s = l.course.time_s[i + 1] - l.course.time_s[i];
    l.decay.col(k) = (-dt_s * l.course.modes[l.course.of_interval[i]].rate_1_s).array().exp();
  }
  return l;
}

Eigen::MatrixXd modal_gain(const LinearRun& run, const Eigen::MatrixXd& heat_W) {
  Eigen::MatrixXd gain(run.decay.rows(), run.decay.cols());
  for (Eigen::Index k = 0; k < gain.cols(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ModalCourse::Modes& m = run.course.modes[run.course.of_interval[i]];
    const double dt_s = run.course.time_s[i + 1] - run.course.time_s[i];
    const Eigen::VectorXd load = m.load * heat_W.col(k);
    for (Eigen::Index j = 0; j < gain.rows(); ++j) {
      const double x = dt_s * m.rate_1_s[j];
      gain(j, k) = load[j] * (std::abs(x) < 1e-9 ? dt_s : (1.0 - run.decay(j, k)) / m.rate_1_s[j]);
    }
  }
  return gain;
}

Eigen::MatrixXd response(const LinearRun& run, const Eigen::MatrixXd& gain, Eigen::Index from, Eigen::Index to) {
  const ModalCourse& course = run.course;
  Eigen::MatrixXd readings = Eigen::MatrixXd::Zero(course.modes.front().observe.cols(), gain.cols() + 1);
  Eigen::VectorXd a = Eigen::VectorXd::Zero(gain.rows());
  for (Eigen::Index k = from; k < gain.cols(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ModalCourse::Modes& m = course.modes[course.of_interval[i]];
    if (k > from && course.of_interval[i] != course.of_interval[i - 1]) a = (m.from * a).eval();
    a.array() *= run.decay.col(k).array();
    if (k < to) a += gain.col(k);
    readings.col(k + 1).noalias() = m.observe.transpose() * a;
  }
  return readings;
}

double mean_difference(double first_K, double second_K) {
  const double ratio = first_K / second_K;
  return ratio > 0.0 && std::abs(ratio - 1.0) > 1e-6 ? (first_K - second_K) / std::log(ratio) : 0.5 * (first_K + second_K);
}

}  // namespace driftwright::diagnosis
