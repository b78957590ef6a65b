#include "diagnosis/experiment_check.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <random>

#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kCannotTell = 3.0;  // nats, as in the search

/// Standard normal numbers by Box and Muller: the standard library defines its engines exactly, but not its
/// distributions.
double normal(std::mt19937_64& random) {
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1.0p-53; };
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

void add_noise(const NoiseModel& noise, double row_s, Eigen::VectorXd& series, std::mt19937_64& random) {
  const double kept = noise.time_s > 0.0 ? std::exp(-row_s / noise.time_s) : 0.0;
  double slow = noise.correlated * normal(random);
  for (double& value : series) {
    value += noise.white * normal(random) + slow;
    slow = kept * slow + std::sqrt(1.0 - kept * kept) * noise.correlated * normal(random);
  }
}

/// Linear columns for the records so far, with zeros for the new one.
std::vector<Prediction> with_nothing_in(const std::vector<Prediction>& linear, std::size_t n_times) {
  std::vector<Prediction> list = linear;
  for (Prediction& column : list)
    column.push_back(Eigen::MatrixXd::Zero(column.front().rows(), static_cast<Eigen::Index>(n_times)));
  return list;
}

}  // namespace

Check check_by_simulation(const Fitter& fitter, const MeasuredRun& run, const std::map<std::string, NoiseModel>& noise,
                          const std::vector<Explanation>& explanations, const std::vector<Pair>& pairs, int n_draws) {
  std::vector<MeasuredRun> runs = fitter.runs();
  runs.push_back(run);
  const std::vector<MeasuredRun> alone = {run};
  const Fitter ahead(fitter.twin(), alone, fitter.scatter(), {});
  Fitter joint(fitter.twin(), runs, fitter.scatter(), with_nothing_in(fitter.linear(), run.time_s.size()));
  joint.set_noise(noise);
  const Eigen::Index n_scatter = ahead.n_nuisance();
  Fit at;
  at.x = Eigen::VectorXd::Zero(explanations.front().x.size() + joint.n_nuisance() - n_scatter);
  at.x.head(n_scatter) = explanations.front().x.head(n_scatter);
  at.x.tail(explanations.front().x.size() - n_scatter) = explanations.front().claim_x(n_scatter);
  joint.settle(explanations.front().hypothesis, at);

  Twin::Workspace workspace(fitter.twin());
  const double row_s = run.time_s.size() > 1 ? run.time_s[1] - run.time_s[0] : 60.0;
  std::mt19937_64 random(20240229);
  Check check;
  for (std::size_t truth = 0; truth < explanations.size(); ++truth) {
    const Explanation& e = explanations[truth];
    const Eigen::MatrixXd lower = Eigen::LLT<Eigen::MatrixXd>(e.covariance).matrixL();
    for (int draw = 0; draw < n_draws; ++draw) {
      Eigen::VectorXd x = e.x;
      for (Eigen::Index i = 0; i < x.size(); ++i) x += normal(random) * lower.col(i);
      std::vector<double> evidence;
      const bool is_solved = has_solution([&] {
        const Prediction said = ahead.predict(e.hypothesis, x, workspace);
        for (MeasuredChannel& c : runs.back().channels) {
          c.value = said.front().row(c.output).transpose();
          add_noise(noise.at(c.name), row_s, c.value, random);
        }
        joint.set_noise(noise);  // evaluates the readings anew
        for (const Explanation& o : explanations)
          evidence.push_back(joint.fit(o.hypothesis, o.claim_x(n_scatter), workspace).log_evidence);
      });
      if (!is_solved) continue;  // the drawn numbers are impossible
      bool is_told = true;
      for (const Pair& p : pairs) {
        if (p.first != truth && p.second != truth) continue;
        const std::size_t rival = p.first == truth ? p.second : p.first;
        is_told = is_told && evidence[truth] > evidence[rival] + kCannotTell;
      }
      ++check.n;
      check.n_told += is_told ? 1 : 0;
    }
  }
  return check;
}

}  // namespace driftwright::diagnosis
