#include "diagnosis/experiment_check.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <random>

namespace driftwright::diagnosis {
namespace {

constexpr int kDraws = 20;         // of each explanation
constexpr double kCannotTell = 3;  // nats, as the search has it

/// Standard normal numbers by Box and Muller: the standard library fixes its engines, not its distributions.
Eigen::VectorXd normals(Eigen::Index n, std::mt19937_64& random) {
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1.0p-53; };
  Eigen::VectorXd z(n);
  for (Eigen::Index i = 0; i < n; ++i)
    z[i] = std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
  return z;
}

}  // namespace

Check check_by_simulation(const Fitter& ahead, const std::vector<Explanation>& explanations, const std::vector<Pair>& pairs,
                          const std::set<std::string>& channels) {
  Twin::Workspace workspace(ahead.twin());
  std::vector<Outlook> outlooks;
  for (const Explanation& e : explanations)
    outlooks.push_back(only(outlook(ahead, e, workspace), ahead.comparison(), channels));
  std::mt19937_64 random(20240229);
  Check check;
  for (std::size_t truth = 0; truth < explanations.size(); ++truth) {
    const Explanation& e = explanations[truth];
    const Eigen::MatrixXd lower = Eigen::LLT<Eigen::MatrixXd>(e.covariance).matrixL();
    for (int draw = 0; draw < kDraws; ++draw) {
      const Eigen::VectorXd x = e.x + lower * normals(e.x.size(), random);
      Outlook made;
      try {
        made.mean = ahead.comparison().whitened(ahead.predict(e.hypothesis, x, workspace));
      } catch (const std::exception&) {  // numbers that no machine can have
        continue;
      }
      made.mean += normals(made.mean.size(), random);  // whitened noise is white, of 1
      made.root.resize(made.mean.size(), 0);
      const Eigen::VectorXd readings = only(made, ahead.comparison(), channels).mean;
      std::vector<double> value;
      for (std::size_t i = 0; i < explanations.size(); ++i)
        value.push_back(explanations[i].log_evidence + log_density(outlooks[i], readings));
      bool is_told = true;
      for (const Pair& p : pairs) {
        if (p.first != truth && p.second != truth) continue;
        const std::size_t rival = p.first == truth ? p.second : p.first;
        is_told = is_told && value[truth] > value[rival] + kCannotTell;
      }
      ++check.n;
      check.n_told += is_told ? 1 : 0;
    }
  }
  return check;
}

}  // namespace driftwright::diagnosis
