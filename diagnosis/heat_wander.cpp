#include "diagnosis/heat_wander.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "diagnosis/linear_operator.hpp"
#include "diagnosis/scene.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr Eigen::Index kKnots = 24;  // of a run; heat is linear between them
constexpr int kMaximisations = 30;   // largest number of iterations
constexpr double kMatters = 0.02;    // share of the effect of all bodies; smaller ones are dropped
constexpr double kShortest = 1.0;    // range of trial time constants, in distances of knots
constexpr double kLongest = 64.0;

/// Triangular hats of 1 W at each knot, n_steps x kKnots: means from row to row.
Eigen::MatrixXd hats(const std::vector<double>& time_s) {
  const auto n_steps = static_cast<Eigen::Index>(time_s.size()) - 1;
  const double length_s = time_s.back() - time_s.front();
  Eigen::MatrixXd hat = Eigen::MatrixXd::Zero(n_steps, kKnots);
  for (Eigen::Index k = 0; k < n_steps; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double at = (0.5 * (time_s[i] + time_s[i + 1]) - time_s.front()) / length_s * static_cast<double>(kKnots - 1);
    const auto left = std::min<Eigen::Index>(static_cast<Eigen::Index>(at), kKnots - 2);
    const double behind = at - static_cast<double>(left);
    hat(k, left) = 1.0 - behind;
    hat(k, left + 1) = behind;
  }
  return hat;
}

/// Root of exp(-|t_i - t_j| / τ) for the knots.
Eigen::MatrixXd root_of_correlation(double spacing_s, double time_s) {
  Eigen::MatrixXd c(kKnots, kKnots);
  for (Eigen::Index i = 0; i < kKnots; ++i) {
    for (Eigen::Index j = 0; j < kKnots; ++j) c(i, j) = std::exp(-spacing_s * static_cast<double>(std::abs(i - j)) / time_s);
  }
  return c.llt().matrixL();
}

/// The change of a run's readings by 1 W at each knot in each body, whitened and condensed.
struct Run {
  double spacing_s = 0.0;
  Eigen::MatrixXd columns;  ///< n_rows x (n_bodies kKnots), body after body
  Eigen::VectorXd residual;
};

struct FittedCourse {
  double log_likelihood = -1e300;
  double time_s = 0.0;
  Eigen::VectorXd variance_W2;  ///< of each body
  Eigen::VectorXd does;         ///< of each body: squares of its effect on the readings
};

/// Expectation and maximisation. @param gram, along  of each run: products of the columns with each other and with the
/// residual
FittedCourse fitted(const std::vector<Run>& runs, const std::vector<Eigen::MatrixXd>& gram,
                    const std::vector<Eigen::VectorXd>& along, Eigen::Index n_bodies, double time_s) {
  const Eigen::Index n = n_bodies * kKnots;
  std::vector<Eigen::MatrixXd> g;
  std::vector<Eigen::VectorXd> a;
  Eigen::VectorXd does = Eigen::VectorXd::Zero(n_bodies);
  double squares = 0.0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::MatrixXd root = root_of_correlation(runs[r].spacing_s, time_s);
    Eigen::MatrixXd m(n, n);
    Eigen::VectorXd v(n);
    for (Eigen::Index b = 0; b < n_bodies; ++b) {
      v.segment(b * kKnots, kKnots) = root.transpose() * along[r].segment(b * kKnots, kKnots);
      for (Eigen::Index c = 0; c < n_bodies; ++c)
        m.block(b * kKnots, c * kKnots, kKnots, kKnots) =
            root.transpose() * gram[r].block(b * kKnots, c * kKnots, kKnots, kKnots) * root;
      does[b] += m.block(b * kKnots, b * kKnots, kKnots, kKnots).trace();
    }
    g.push_back(std::move(m));
    a.push_back(std::move(v));
    squares += runs[r].residual.squaredNorm();
  }
  FittedCourse f{.time_s = time_s, .variance_W2 = Eigen::VectorXd::Zero(n_bodies), .does = does};
  for (Eigen::Index b = 0; b < n_bodies; ++b) {
    if (does[b] > 0.0) f.variance_W2[b] = squares / does[b] / static_cast<double>(n_bodies);
  }
  for (int turn = 0; turn <= kMaximisations; ++turn) {
    Eigen::VectorXd sd(n), amplitude2 = Eigen::VectorXd::Zero(n_bodies);
    for (Eigen::Index b = 0; b < n_bodies; ++b) sd.segment(b * kKnots, kKnots).setConstant(std::sqrt(f.variance_W2[b]));
    double log_likelihood = 0.0;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      Eigen::MatrixXd information = sd.asDiagonal() * g[r] * sd.asDiagonal();
      information.diagonal().array() += 1.0;
      const Eigen::LLT<Eigen::MatrixXd> factor(information);
      const Eigen::VectorXd rhs = sd.cwiseProduct(a[r]), u = factor.solve(rhs);
      log_likelihood += 0.5 * rhs.dot(u) - factor.matrixLLT().diagonal().array().log().sum();
      if (turn == kMaximisations) continue;
      const Eigen::VectorXd spread = factor.solve(Eigen::MatrixXd::Identity(n, n)).diagonal();
      for (Eigen::Index b = 0; b < n_bodies; ++b)
        amplitude2[b] += u.segment(b * kKnots, kKnots).squaredNorm() + spread.segment(b * kKnots, kKnots).sum();
    }
    f.log_likelihood = log_likelihood;
    if (turn < kMaximisations)
      f.variance_W2.array() *= amplitude2.array() / static_cast<double>(kKnots * static_cast<Eigen::Index>(runs.size()));
  }
  f.does.array() *= f.variance_W2.array();
  return f;
}

}  // namespace

std::optional<HeatWander> heat_wander(const Fitter& fitter, const TwinState& state, const Prediction& prediction,
                                      Twin::Workspace& workspace) {
  const Comparison& comparison = fitter.comparison();
  std::vector<effects::Body> bodies = scene_of(fitter.twin(), fitter.runs()).bodies;
  std::erase(bodies, effects::ambient_node());
  const auto n_bodies = static_cast<Eigen::Index>(bodies.size());
  if (n_bodies == 0) return std::nullopt;
  std::vector<LinearOperator> machine;
  std::vector<std::vector<LinearOperator::Load>> heat_in;  // of each run and body
  std::vector<Run> runs;
  std::vector<Eigen::MatrixXd> gram;
  std::vector<Eigen::VectorXd> along;
  const Eigen::VectorXd residual = comparison.measured() - comparison.whitened(prediction);
  double shortest_s = 1e300, longest_s = 0.0;
  for (std::size_t r = 0; r < fitter.runs().size(); ++r) {
    const std::vector<double>& time_s = fitter.runs()[r].time_s;
    machine.emplace_back(fitter.twin(), fitter.runs()[r], state, workspace);
    heat_in.emplace_back();
    for (const effects::Body& body : bodies) heat_in.back().push_back(machine.back().heat(body));
    const Eigen::MatrixXd hat = hats(time_s);
    Run run{.spacing_s = (time_s.back() - time_s.front()) / static_cast<double>(kKnots - 1),
            .columns = Eigen::MatrixXd(comparison.condensed_rows(r).second, n_bodies * kKnots),
            .residual = comparison.condensed(r, residual.segment(comparison.first_of(r), comparison.n_of(r)))};
    Eigen::VectorXd whitened(comparison.n_of(r));
    for (Eigen::Index b = 0; b < n_bodies; ++b) {
      for (Eigen::Index k = 0; k < kKnots; ++k) {
        comparison.whiten(r, machine[r].response(heat_in[r][static_cast<std::size_t>(b)], hat.col(k).transpose()), whitened);
        run.columns.col(b * kKnots + k) = comparison.condensed(r, whitened);
      }
    }
    gram.emplace_back(run.columns.transpose() * run.columns);
    along.emplace_back(run.columns.transpose() * run.residual);
    shortest_s = std::min(shortest_s, run.spacing_s);
    longest_s = std::max(longest_s, run.spacing_s);
    runs.push_back(std::move(run));
  }
  FittedCourse best;
  double last_s = 0.0;
  for (double time_s = kShortest * shortest_s; time_s <= kLongest * longest_s; time_s *= 4.0) {
    FittedCourse f = fitted(runs, gram, along, n_bodies, time_s);
    if (f.log_likelihood > best.log_likelihood) best = std::move(f);
    last_s = time_s;
  }
  const double all = best.does.sum();
  if (!(best.log_likelihood > 0.0) || !(all > 0.0)) return std::nullopt;

  using Limit = HeatWander::Limit;
  HeatWander wander{.time_s = best.time_s,
                    .limit = best.time_s == kShortest * shortest_s ? Limit::kAtMost
                             : best.time_s == last_s               ? Limit::kAtLeast
                                                                   : Limit::kNone,
                    .bodies = {},
                    .readings = {},
                    .prediction = prediction};
  std::vector<Eigen::Index> kept;
  for (Eigen::Index b = 0; b < n_bodies; ++b) {
    if (best.does[b] > kMatters * all) kept.push_back(b);
  }
  std::stable_sort(kept.begin(), kept.end(), [&](Eigen::Index a, Eigen::Index b) { return best.does[a] > best.does[b]; });
  for (Eigen::Index b : kept)
    wander.bodies.push_back({bodies[static_cast<std::size_t>(b)], std::sqrt(best.variance_W2[b]), best.does[b] / all});
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const MeasuredRun& run = fitter.runs()[r];
    const auto n_times = static_cast<Eigen::Index>(run.time_s.size()),
               n_channels = static_cast<Eigen::Index>(run.channels.size());
    const Eigen::MatrixXd hat = hats(run.time_s), root = root_of_correlation(runs[r].spacing_s, best.time_s);
    Eigen::MatrixXd shared(n_channels * n_times, kKnots * static_cast<Eigen::Index>(kept.size()));
    Eigen::MatrixXd columns(runs[r].columns.rows(), shared.cols());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const auto first = static_cast<Eigen::Index>(i) * kKnots;
      const double sd_W = wander.bodies[i].sd_W;
      Eigen::MatrixXd of_knot(shared.rows(), kKnots);
      for (Eigen::Index k = 0; k < kKnots; ++k) {
        const Eigen::MatrixXd readings =
            machine[r].response(heat_in[r][static_cast<std::size_t>(kept[i])], hat.col(k).transpose());
        for (Eigen::Index c = 0; c < n_channels; ++c)
          of_knot.col(k).segment(c * n_times, n_times) = readings.row(c).transpose();
      }
      shared.middleCols(first, kKnots) = sd_W * of_knot * root;
      columns.middleCols(first, kKnots) = sd_W * runs[r].columns.middleCols(kept[i] * kKnots, kKnots) * root;
    }
    Eigen::MatrixXd information = columns.transpose() * columns;
    information.diagonal().array() += 1.0;
    const Eigen::VectorXd heat = shared * information.llt().solve(columns.transpose() * runs[r].residual);
    for (Eigen::Index c = 0; c < n_channels; ++c)
      wander.prediction[r].row(run.channels[static_cast<std::size_t>(c)].output) +=
          heat.segment(c * n_times, n_times).transpose();
    wander.readings.push_back(std::move(shared));
  }
  return wander;
}

}  // namespace driftwright::diagnosis
