#pragma once
// Normal random numbers, for tests of solvers.

#include <Eigen/Core>
#include <random>

namespace driftwright::fixtures {

inline Eigen::VectorXd random_vector(Eigen::Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd v(n);
  for (double& value : v) value = normal(random);
  return v;
}

}  // namespace driftwright::fixtures
