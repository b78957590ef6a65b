#include "diagnosis/heat_smoother.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

constexpr double kFirst = 10.0;     // the heat at the first row may be so many typical ones
constexpr int kSmoothings = 8;      // of steps that learn their own size
constexpr double kSharpens = 12.0;  // nats of a heat that is worth it
constexpr double kQuiet = 0.003;    // variance of a step where nothing happens, over the mean one

/// One pass of the filter over state [modes; heat], with what the smoother needs of it.
class Filter {
 public:
  /// @param step_W2  variance of the heat's step behind each row but the last
  Filter(const ModalCourse& machine, const Eigen::MatrixXd& residual, Eigen::Index body, const Eigen::VectorXd& carrier,
         const Eigen::VectorXd& step_W2, double first_W, bool keeps)
      : machine_(machine), carrier_(carrier), body_(body), n_(machine.modes.front().rate_1_s.size()) {
    const Eigen::Index n_rows = residual.rows();
    const ModalCourse::Modes& at_start = machine.modes.front();
    state_ = Eigen::VectorXd::Zero(n_ + 1);
    covariance_ = Eigen::MatrixXd::Zero(n_ + 1, n_ + 1);
    covariance_.topLeftCorner(n_, n_) = at_start.start * at_start.start.transpose();
    covariance_(n_, n_) = first_W * first_W;
    for (Eigen::Index k = 0; k < n_rows; ++k) {
      if (keeps) {
        prior_W_.push_back(state_[n_]);
        prior_row_.emplace_back(covariance_.row(n_));
        if (k == 0) prior_start_ = covariance_.leftCols(n_);
      }
      const ModalCourse::Modes& seen = modes_at(k);
      for (Eigen::Index c = 0; c < residual.cols(); ++c) {
        const double y = residual(k, c);
        if (!std::isnan(y)) update(k, c, seen.observe.col(c), y, keeps);
      }
      if (k + 1 == n_rows) break;
      advance(k, step_W2[k]);
    }
  }

  [[nodiscard]] double scale2() const { return std::max(1e-4, squares_ / std::max(1.0, n_readings_)); }
  /// Profiled over the scale of all variances.
  [[nodiscard]] double log_likelihood() const {
    return -0.5 * (n_readings_ * std::log(scale2()) + squares_ / scale2() + logs_);
  }

  /// Heat from row to row, its standard deviation at scale 1, and the modes at the start.
  void smooth(Eigen::VectorXd& heat_W, Eigen::VectorXd& sd_W, Eigen::VectorXd& start) const {
    const auto n_rows = static_cast<Eigen::Index>(prior_W_.size());
    heat_W.resize(n_rows);
    sd_W.resize(n_rows);
    Eigen::VectorXd lambda = Eigen::VectorXd::Zero(n_ + 1);
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n_ + 1, n_ + 1);
    auto m = updates_.rbegin();
    for (Eigen::Index k = n_rows - 1; k >= 0; --k) {
      if (k + 1 < n_rows) go_back(k, lambda, information);
      for (; m != updates_.rend() && m->row == k; ++m) {
        Eigen::VectorXd c = Eigen::VectorXd::Zero(n_ + 1);
        c.head(n_) = modes_at(k).observe.col(m->channel);
        const Eigen::VectorXd v = information * m->gain;
        const double of_gain = m->gain.dot(v);
        lambda -= c * (m->innovation / m->variance + m->gain.dot(lambda));
        information.noalias() -= c * v.transpose();
        information.noalias() -= v * c.transpose();
        information.noalias() += (of_gain + 1.0 / m->variance) * c * c.transpose();
      }
      const Eigen::VectorXd& row = prior_row_[static_cast<std::size_t>(k)];
      heat_W[k] = prior_W_[static_cast<std::size_t>(k)] - row.dot(lambda);
      sd_W[k] = std::sqrt(std::max(0.0, row[n_] - row.dot(information * row)));
    }
    start = -(prior_start_.transpose() * lambda);
  }

  /// What that heat does, from that start.
  void run(const Eigen::VectorXd& heat_W, Eigen::VectorXd a, Eigen::MatrixXd& mean_K, Eigen::MatrixXd& readings) const {
    const auto n_rows = static_cast<Eigen::Index>(machine_.time_s.size());
    const ModalCourse::Modes& first = machine_.modes.front();
    mean_K.resize(n_rows, first.mean.cols());
    readings.resize(n_rows, first.observe.cols());
    for (Eigen::Index k = 0; k < n_rows; ++k) {
      const ModalCourse::Modes& seen = modes_at(k);
      mean_K.row(k) = a.transpose() * seen.mean;
      readings.row(k) = a.transpose() * seen.observe;
      if (k + 1 == n_rows) break;
      if (changes_at(k)) a = modes_of(k).from * a;
      const Step s = step(k);
      a = s.decay.cwiseProduct(a) + heat_W[k] * s.load;
    }
  }

 private:
  struct Update {
    Eigen::Index row, channel;
    Eigen::VectorXd gain;
    double innovation, variance;
  };
  struct Step {
    Eigen::VectorXd decay, load;
  };
  [[nodiscard]] double interval_s(Eigen::Index k) const {
    return machine_.time_s[static_cast<std::size_t>(k + 1)] - machine_.time_s[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] const ModalCourse::Modes& modes_of(Eigen::Index interval) const {
    return machine_.modes[machine_.of_interval[static_cast<std::size_t>(interval)]];
  }
  /// The modes that the state at a row is held in: those of the interval before it.
  [[nodiscard]] const ModalCourse::Modes& modes_at(Eigen::Index row) const {
    return row == 0 ? machine_.modes.front() : modes_of(row - 1);
  }
  [[nodiscard]] bool changes_at(Eigen::Index row) const { return &modes_at(row) != &modes_of(row); }
  [[nodiscard]] Step step(Eigen::Index k) const {
    const ModalCourse::Modes& m = modes_of(k);
    const double dt_s = interval_s(k);
    Step s{(-dt_s * m.rate_1_s).array().exp(), Eigen::VectorXd(n_)};
    for (Eigen::Index i = 0; i < n_; ++i) {
      const double x = dt_s * m.rate_1_s[i];
      s.load[i] = carrier_[k] * m.load(i, body_) * (std::abs(x) < 1e-9 ? dt_s : -std::expm1(-x) / m.rate_1_s[i]);
    }
    return s;
  }

  void update(Eigen::Index row, Eigen::Index channel, const Eigen::VectorXd& c, double y, bool keeps) {
    const Eigen::VectorXd pc = covariance_.leftCols(n_) * c;
    const double variance = c.dot(pc.head(n_)) + 1.0, innovation = y - c.dot(state_.head(n_));
    const Eigen::VectorXd gain = pc / variance;
    state_ += gain * innovation;
    covariance_.noalias() -= gain * pc.transpose();
    squares_ += innovation * innovation / variance;
    logs_ += std::log(variance);
    n_readings_ += 1.0;
    if (keeps) updates_.push_back({row, channel, gain, innovation, variance});
  }

  void advance(Eigen::Index k, double step_variance_W2) {
    if (changes_at(k)) {
      const Eigen::MatrixXd& t = modes_of(k).from;
      state_.head(n_) = (t * state_.head(n_)).eval();
      covariance_.topRows(n_) = (t * covariance_.topRows(n_)).eval();
      covariance_.leftCols(n_) = (covariance_.leftCols(n_) * t.transpose()).eval();
    }
    const Step s = step(k);
    state_.head(n_) = s.decay.cwiseProduct(state_.head(n_)) + state_[n_] * s.load;
    const Eigen::VectorXd heat = covariance_.col(n_);
    covariance_.topRows(n_) = (s.decay.asDiagonal() * covariance_.topRows(n_) + s.load * heat.transpose()).eval();
    const Eigen::VectorXd moved = covariance_.col(n_);
    covariance_.leftCols(n_) = (covariance_.leftCols(n_) * s.decay.asDiagonal() + moved * s.load.transpose()).eval();
    covariance_(n_, n_) += step_variance_W2;
    covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  }

  /// λ and its information from row k + 1 to row k.
  void go_back(Eigen::Index k, Eigen::VectorXd& lambda, Eigen::MatrixXd& information) const {
    const Step s = step(k);
    const auto back = [&](Eigen::Ref<Eigen::VectorXd> v) {
      v[n_] += s.load.dot(v.head(n_));
      v.head(n_) = s.decay.cwiseProduct(v.head(n_)).eval();
      if (changes_at(k)) v.head(n_) = (modes_of(k).from.transpose() * v.head(n_)).eval();
    };
    back(lambda);
    for (Eigen::Index i = 0; i <= n_; ++i) back(information.col(i));
    information.transposeInPlace();
    for (Eigen::Index i = 0; i <= n_; ++i) back(information.col(i));
  }

  const ModalCourse& machine_;
  const Eigen::VectorXd& carrier_;
  Eigen::Index body_, n_;
  Eigen::VectorXd state_;
  Eigen::MatrixXd covariance_, prior_start_;
  std::vector<double> prior_W_;
  std::vector<Eigen::VectorXd> prior_row_;
  std::vector<Update> updates_;
  double squares_ = 0.0, logs_ = 0.0, n_readings_ = 0.0;
};

}  // namespace

SmoothedHeat smooth_heat(const ModalCourse& machine, const Eigen::MatrixXd& residual, Eigen::Index body,
                         const Eigen::VectorXd& carrier, double typical_W) {
  const Eigen::Index n_steps = residual.rows() - 1;
  const double first_W = kFirst * typical_W;
  Eigen::VectorXd share(n_steps);  // of a step's variance: as long as its interval
  for (Eigen::Index k = 0; k < n_steps; ++k)
    share[k] = machine.time_s[static_cast<std::size_t>(k + 1)] - machine.time_s[static_cast<std::size_t>(k)];
  share /= share.mean();
  const auto even = [&](double decade) -> Eigen::VectorXd {
    return std::pow(typical_W * std::pow(10.0, decade), 2) * share;
  };
  const auto likelihood = [&](const Eigen::VectorXd& step_W2) {
    return Filter(machine, residual, body, carrier, step_W2, first_W, false).log_likelihood();
  };
  double best = -4.0, best_value = likelihood(even(best));
  const auto look = [&](double decade) {
    if (const double value = likelihood(even(decade)); value > best_value) {
      best = decade;
      best_value = value;
    }
  };
  for (double decade : {-3.0, -2.0, -1.0, 0.0, 1.0}) look(decade);
  const double coarse = best;
  look(coarse - 0.5);
  look(coarse + 0.5);
  const double nothing =
      Filter(machine, residual, body, carrier, Eigen::VectorXd::Zero(n_steps), 0.0, false).log_likelihood();

  SmoothedHeat smoothed;
  Eigen::VectorXd start, step_W2 = even(best);
  const auto smooth = [&](const Eigen::VectorXd& steps_W2, double at_least) {
    const Filter filter(machine, residual, body, carrier, steps_W2, first_W, true);
    if (filter.log_likelihood() < at_least) return false;
    best_value = filter.log_likelihood();
    filter.smooth(smoothed.heat_W, smoothed.sd_W, start);
    filter.run(smoothed.heat_W, start, smoothed.mean_K, smoothed.readings);
    smoothed.noise_scale = std::sqrt(filter.scale2());
    return true;
  };
  (void)smooth(step_W2, -1e300);
  // Events are few and sharp: each step learns its own variance from what it turned out to be (a Student distribution of one degree of freedom).
  const double quiet_W2 = kQuiet * step_W2.mean();
  for (int turn = 0; turn < kSmoothings && best_value > nothing + kSharpens; ++turn) {
    for (Eigen::Index k = 0; k < n_steps; ++k)
      step_W2[k] = 0.5 * (std::pow(smoothed.heat_W[k + 1] - smoothed.heat_W[k], 2) / std::pow(smoothed.noise_scale, 2) +
                          quiet_W2 * share[k]);
    if (!smooth(step_W2, best_value - 2.0)) break;
  }
  smoothed.sd_W *= smoothed.noise_scale;
  smoothed.heat_W.conservativeResize(n_steps);  // what happens behind the last row nobody read
  smoothed.sd_W.conservativeResize(n_steps);
  smoothed.log_likelihood_gain = best_value - nothing;
  return smoothed;
}

}  // namespace driftwright::diagnosis
