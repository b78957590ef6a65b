#include "compensation/frames/minimax_frame.hpp"

#include <algorithm>

#include "base/dense.hpp"

namespace driftwright::compensation {
namespace {

constexpr int kMostRounds = 300;
constexpr double kCloseEnough = 0.99;
/// Residual below which a frame fits exactly: a nanometre.
constexpr double kFits_m = 1e-9;
/// Smallest weight of a point relative to the mean, so that a point with a small error can regain weight later.
constexpr double kLeastWeight = 1e-6;

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 7>;
using Step = Eigen::Matrix<double, 7, 1>;  // scale, shift, shift y, turn, shift z, tilt, scale y

/// Motion of each point per unit of a step; the second order is a thousandth of a micrometre.
Rows slopes(std::span<const RingPair> points) {
  Rows rows = Rows::Zero(3 * static_cast<Eigen::Index>(points.size()), 7);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d& at = *points[i].before_m;
    auto block = rows.middleRows<3>(3 * static_cast<Eigen::Index>(i));
    block.row(0) << at[0], 1.0, 0.0, -at[1], 0.0, at[2], 0.0;
    block.row(1) << 0.0, 0.0, 1.0, at[0], 0.0, 0.0, at[1];
    block.row(2) << 0.0, 0.0, 0.0, 0.0, 1.0, -at[0], 0.0;
  }
  return rows;
}

TableFrame stepped(TableFrame frame, const Step& step) {
  frame.x.scale += step[0];
  frame.x.shift_m += step[1];
  frame.shift_y_m += step[2];
  frame.turn_rad += step[3];
  frame.shift_z_m += step[4];
  frame.tilt_rad += step[5];
  frame.scale_y += step[6];
  return frame;
}

Eigen::Matrix3Xd misfits(std::span<const RingPair> points, const TableFrame& table) {
  const Frame frame = table.frame();
  Eigen::Matrix3Xd left_m(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    left_m.col(static_cast<Eigen::Index>(i)) = *points[i].now_m - frame.map(*points[i].before_m);
  return left_m;
}

}  // namespace

MinimaxFrame fit_minimax_frame(std::span<const RingPair> points) {
  const TableFrame start = fit_table_frame(points);
  const Eigen::Matrix3Xd missed_m = misfits(points, start);
  const Rows rows = slopes(points);
  const int n_unknowns = tells_scale_y(points) ? 7 : 6;
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n));
  Step step = Step::Zero(), best = step;
  double most_m = missed_m.colwise().norm().maxCoeff(), least_m = 0.0;
  for (int round = 0; round < kMostRounds && most_m > kFits_m && least_m < kCloseEnough * most_m; ++round) {
    Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
    Step right = Step::Zero();
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto block = rows.middleRows<3>(3 * i);
      normal.noalias() += weights[i] * block.transpose() * block;
      right.noalias() += weights[i] * block.transpose() * missed_m.col(i);
    }
    step.head(n_unknowns) = dense::least_squares(normal.topLeftCorner(n_unknowns, n_unknowns), right.head(n_unknowns));
    const Eigen::VectorXd moved_m = rows * step;
    const Eigen::VectorXd left_m = (missed_m - moved_m.reshaped(3, n)).colwise().norm().transpose();
    // a weighted mean that no frame can reduce is a lower bound of the largest error of any frame
    least_m = std::max(least_m, std::sqrt(weights.dot(left_m.cwiseAbs2())));
    if (left_m.maxCoeff() < most_m) {
      most_m = left_m.maxCoeff();
      best = step;
    }
    weights.array() *= left_m.array();
    weights = (weights / weights.sum()).cwiseMax(kLeastWeight / static_cast<double>(n));
    weights /= weights.sum();
  }
  TableFrame frame = stepped(start, best);
  frame.misfit_m = misfits(points, frame).colwise().norm().maxCoeff();
  return {.frame = frame, .least_misfit_m = least_m};
}

}  // namespace driftwright::compensation
