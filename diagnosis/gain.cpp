#include "diagnosis/gain.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kFitted = 2.0 / 3.0;  // of a single run

/// x of a fit with numbers taken from some rows of the whitened data alone: one Gauss-Newton step, damped, from the fit to all.
Eigen::VectorXd refitted(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit,
                         const std::vector<char>& is_used, bool keep_unseen, Twin::Workspace& workspace) {
  const Eigen::Index n_n = fitter.n_nuisance(), n = fit.x.size();
  Eigen::MatrixXd slopes(fit.residual.size(), n);
  slopes << fitter.nuisance_slopes(), fit.slopes;
  const Eigen::VectorXd all_squares = slopes.colwise().squaredNorm();
  Eigen::VectorXd residual = fit.residual;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    if (is_used[static_cast<std::size_t>(i)]) continue;
    slopes.row(i).setZero();
    residual[i] = 0.0;
  }
  const Eigen::VectorXd sd = fitter.prior_sd(hypothesis);
  Eigen::MatrixXd hessian = slopes.transpose() * slopes;
  hessian.diagonal() += sd.cwiseProduct(sd).cwiseInverse();
  Eigen::VectorXd step = slopes.transpose() * residual - fit.x.cwiseQuotient(sd.cwiseProduct(sd));
  const Eigen::VectorXd used_squares = slopes.colwise().squaredNorm();
  Eigen::VectorXd from = fit.x;
  for (Eigen::Index i = n_n; i < n; ++i) {  // it happened elsewhere
    if (used_squares[i] > 1e-6 * all_squares[i]) continue;
    const bool has_no_slope = all_squares[i] == 0.0;  // a time, or cables that are swapped or not
    step[i] = 0.0;
    hessian.row(i).setZero();
    hessian.col(i).setZero();
    hessian(i, i) = 1.0;
    if (!keep_unseen && !has_no_slope) from[i] = 0.0;
  }
  // What few data want may be more than the machine stands: only as far as it explains them better.
  const auto misfit = [&](const Eigen::VectorXd& x) {
    double sum = 1e300;
    (void)has_solution([&] {
      const Eigen::VectorXd r =
          fitter.comparison().measured() - fitter.comparison().whitened(fitter.predict(hypothesis, x, workspace));
      sum = 0.5 * x.cwiseQuotient(sd).squaredNorm();
      for (Eigen::Index i = 0; i < r.size(); ++i) {
        if (is_used[static_cast<std::size_t>(i)]) sum += 0.5 * r[i] * r[i];
      }
    });
    return sum;
  };
  const Eigen::VectorXd whole = hessian.llt().solve(step);
  const double before = misfit(from);
  for (double share : {1.0, 0.5, 0.25, 0.1}) {
    if (misfit(from + share * whole) < before) return from + share * whole;
  }
  return from;
}

}  // namespace

HeldOut held_out_gain(const Fitter& fitter, const SearchResult& result, const std::map<std::string, NoiseModel>& noise) {
  const std::vector<MeasuredRun>& runs = fitter.runs();
  const Comparison& comparison = fitter.comparison();
  HeldOut held;
  std::map<std::string, std::size_t> index;
  std::vector<double> n_rows;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      if (index.contains(c.name)) continue;
      index[c.name] = held.channels.size();
      held.channels.push_back({c.name, c.unit == "K" ? "K" : c.unit == "m" ? "um" : "urad", 0, 0, 0, 0, 0, 0});
      n_rows.push_back(0.0);
    }
  }
  Twin::Workspace workspace(fitter.twin());
  const Prediction written = fitter.predict({}, Eigen::VectorXd::Zero(fitter.n_nuisance()), workspace);
  const bool single = runs.size() == 1;
  for (std::size_t out = 0; out < runs.size(); ++out) {
    const double from_s = single ? kFitted * runs[0].time_s.back() : -1.0;
    std::vector<char> is_used(static_cast<std::size_t>(comparison.n()), 1);
    for (const Comparison::Block& b : comparison.blocks()) {
      if (b.run != out) continue;
      const Eigen::VectorXd& value = runs[out].find(b.channel)->value;
      Eigen::Index row = b.first;
      for (Eigen::Index i = 0; i < value.size(); ++i) {
        if (std::isnan(value[i])) continue;
        if (runs[out].time_s[static_cast<std::size_t>(i)] > from_s) is_used[static_cast<std::size_t>(row)] = 0;
        ++row;
      }
    }
    const Prediction without =
        fitter.predict({}, refitted(fitter, {}, result.without, is_used, !single, workspace), workspace);
    const Prediction with =
        result.hypothesis.empty()
            ? without
            : fitter.predict(result.hypothesis, refitted(fitter, result.hypothesis, result.fit, is_used, !single, workspace),
                             workspace);
    for (const MeasuredChannel& c : runs[out].channels) {
      ChannelGain& g = held.channels[index[c.name]];
      const double scale = c.unit == "K" ? 1.0 : 1e6;
      for (Eigen::Index i = 0; i < c.value.size(); ++i) {
        if (std::isnan(c.value[i]) || !(runs[out].time_s[static_cast<std::size_t>(i)] > from_s)) continue;
        const auto miss = [&](const Prediction& p) { return scale * (c.value[i] - p[out](c.output, i)); };
        g.rmse_before += std::pow(miss(written), 2);
        g.rmse_calibrated += std::pow(miss(without), 2);
        g.rmse_after += std::pow(miss(with), 2);
        g.peak_before = std::max(g.peak_before, std::abs(miss(written)));
        g.peak_after = std::max(g.peak_after, std::abs(miss(with)));
        n_rows[index[c.name]] += 1.0;
      }
    }
  }
  for (auto& [name, i] : index) {
    ChannelGain& g = held.channels[i];
    const double n = std::max(1.0, n_rows[i]);
    for (double* sum : {&g.rmse_before, &g.rmse_calibrated, &g.rmse_after}) *sum = std::sqrt(*sum / n);
    g.noise_floor = (g.unit == "K" ? 1.0 : 1e6) * noise.at(name).total();
  }
  held.how =
      single
          ? "the last third of the only record, predicted with numbers fitted to the first two thirds; which effect it is "
            "was decided on the whole record"
          : fmt::format(
                "each of the {} records in turn, predicted with numbers fitted to the others; which effect it is was "
                "decided on all, and numbers of what happened in one record alone are kept",
                runs.size());
  return held;
}

}  // namespace driftwright::diagnosis
