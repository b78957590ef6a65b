#include "diagnosis/experiment_check.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "diagnosis/no_solution.hpp"
#include "diagnosis/rivals.hpp"

namespace driftwright::diagnosis {
namespace {

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

/// The probability of one explanation of a question after a record. @param evidence  of each, with the record
double probability_after(const OpenQuestion& q, const std::vector<Explanation>& explanations,
                         const std::vector<double>& evidence, double power, std::size_t of) {
  const auto odds = [&](std::size_t i) {
    return std::log(q.weight[i]) + power * (evidence[i] - explanations[q.of[i]].log_evidence);
  };
  double others = 0.0;
  for (std::size_t i = 0; i < q.of.size(); ++i) others += i == of ? 0.0 : std::exp(std::min(700.0, odds(i) - odds(of)));
  return 1.0 / (1.0 + others);
}

}  // namespace

Check check_by_simulation(const Fitter& fitter, const MeasuredRun& run, const std::map<std::string, NoiseModel>& noise,
                          const std::vector<Explanation>& explanations, const std::vector<OpenQuestion>& questions,
                          double power, int n_draws) {
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
  for (const OpenQuestion& q : questions) {
    const int n = n_draws * static_cast<int>(q.of.size());
    std::size_t truth = 0;
    double up_to = q.weight.front();  // probability of the explanations up to the true one
    for (int draw = 0; draw < n; ++draw) {
      while (truth + 1 < q.of.size() && (draw + 0.5) / n > up_to) up_to += q.weight[++truth];
      const Explanation& e = explanations[q.of[truth]];
      const Eigen::MatrixXd lower = Eigen::LLT<Eigen::MatrixXd>(e.covariance).matrixL();
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
        for (std::size_t i : q.of)
          evidence.push_back(
              joint.fit(explanations[i].hypothesis, explanations[i].claim_x(n_scatter), workspace).log_evidence);
      });
      if (!is_solved) continue;  // the drawn numbers are impossible
      ++check.n;
      check.n_told += probability_after(q, explanations, evidence, power, truth) >= kSure ? 1 : 0;
    }
  }
  return check;
}

}  // namespace driftwright::diagnosis
