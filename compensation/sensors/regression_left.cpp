#include "compensation/sensors/regression_left.hpp"

#include <cmath>
#include <set>
#include <stdexcept>

#include "base/dense.hpp"

namespace driftwright::compensation {

RegressionLeft::RegressionLeft(const std::vector<RunOfCandidates>& runs, double noise_K) : noise_K_(noise_K) {
  std::set<int> groups, machines;
  for (const RunOfCandidates& run : runs) {
    groups.insert(run.group);
    machines.insert(run.machine);
  }
  if (groups.size() < 2) throw std::logic_error("RegressionLeft: one group alone leaves none to fit");
  if (!(noise_K > 0.0)) throw std::logic_error("RegressionLeft: readings without noise");
  n_candidates_ = static_cast<int>(runs.front().reading_K.rows());
  n_drifts_ = runs.front().drift_um.cols();
  const Eigen::Index size = n_candidates_ + 1 + n_drifts_;
  for (int machine : machines) {
    std::vector<Fold> own(groups.size());
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
    double n_all = 0.0;
    std::size_t at = 0;
    for (int group : groups) {
      Fold& fold = own[at++];
      fold.judged = Eigen::MatrixXd::Zero(size, size);
      for (const RunOfCandidates& run : runs) {
        if (run.machine != machine || run.group != group) continue;
        Eigen::MatrixXd columns(run.drift_um.rows(), size);
        columns << run.reading_K.transpose(), Eigen::VectorXd::Ones(columns.rows()), run.drift_um;
        fold.judged.noalias() += columns.transpose() * columns;
        fold.n_judged += static_cast<double>(columns.rows());
      }
      all += fold.judged;
      n_all += fold.n_judged;
    }
    for (Fold& fold : own) {
      fold.fitted = all - fold.judged;
      fold.n_fitted = n_all - fold.n_judged;
      folds_.push_back(std::move(fold));
    }
    n_values_ += n_all * static_cast<double>(n_drifts_);
    squares_ += all.diagonal().tail(n_drifts_).sum();
  }
}

Eigen::ArrayXd RegressionLeft::squares(const Fold& fold, std::span<const int> set) const {
  const double noise = noise_K_ * noise_K_;
  std::vector<Eigen::Index> columns = {n_candidates_};  // the intercept, then the set
  for (int c : set) columns.push_back(c);
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd a = fold.fitted(columns, columns);
  a.diagonal().tail(n - 1).array() += fold.n_fitted * noise;
  const Eigen::MatrixXd between = fold.fitted(columns, Eigen::seqN(0, n_candidates_));
  const Eigen::MatrixXd to_drift = fold.fitted(columns, Eigen::lastN(n_drifts_));
  // The part of each candidate c that the set does not explain, q_c = x_c - X u_c: bordered normal equations.
  const Eigen::MatrixXd u = dense::solve_definite(a, between);
  const Eigen::MatrixXd b = dense::solve_definite(a, to_drift);
  const Eigen::ArrayXd own = fold.fitted.diagonal().head(n_candidates_).array() + fold.n_fitted * noise -
                             (between.array() * u.array()).colwise().sum().transpose();
  const Eigen::MatrixXd judged = fold.judged(columns, columns);
  const Eigen::MatrixXd judged_between = fold.judged(columns, Eigen::seqN(0, n_candidates_));
  const Eigen::ArrayXd q_q = fold.judged.diagonal().head(n_candidates_).array() -
                             2.0 * (u.array() * judged_between.array()).colwise().sum().transpose() +
                             (u.array() * (judged * u).array()).colwise().sum().transpose();
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(n_candidates_);
  for (Eigen::Index d = 0; d < n_drifts_; ++d) {
    const Eigen::Index y = n_candidates_ + 1 + d;
    const Eigen::VectorXd b_d = b.col(d);
    const Eigen::VectorXd judged_y = fold.judged(columns, y);
    const Eigen::ArrayXd gamma =
        (fold.fitted.col(y).head(n_candidates_) - between.transpose() * b_d).array() / own.max(1e-300);
    const double rest = fold.judged(y, y) - 2.0 * b_d.dot(judged_y) + b_d.dot(judged * b_d);
    const Eigen::ArrayXd rest_q = (fold.judged.col(y).head(n_candidates_) - judged_between.transpose() * b_d -
                                   u.transpose() * (judged_y - judged * b_d))
                                      .array();
    Eigen::ArrayXd passed_on = gamma.square();  // |b|² with each candidate
    for (Eigen::Index i = 1; i < n; ++i) passed_on += (b_d(i) - u.row(i).transpose().array() * gamma).square();
    sum += rest - 2.0 * gamma * rest_q + gamma.square() * q_q + fold.n_judged * noise * passed_on;
  }
  return sum;
}

std::vector<double> RegressionLeft::with_each(std::span<const int> set) const {
  std::vector<Eigen::ArrayXd> by_fold(folds_.size());
  for_each_part(folds_.size(), n_candidates_, [&](std::size_t f) { by_fold[f] = squares(folds_[f], set); });
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(n_candidates_);
  for (const Eigen::ArrayXd& of_fold : by_fold) sum += of_fold;
  std::vector<double> left;
  for (double s : sum) left.push_back(std::sqrt(std::max(0.0, s) / n_values_));
  return left;
}

double RegressionLeft::of(std::span<const int> set) const {
  if (set.empty()) return std::sqrt(squares_ / n_values_);
  return with_each(set.first(set.size() - 1))[static_cast<std::size_t>(set.back())];
}

}  // namespace driftwright::compensation
