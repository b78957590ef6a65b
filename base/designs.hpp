#pragma once
// Designs of experiments: which points of a parameter space a study computes. Plain numbers; the caller knows their meaning.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace driftwright {

/// `n` equidistant values from `from` to `to`, including both. @param n  >= 2
[[nodiscard]] std::vector<double> linear_steps(double from, double to, int n);
/// The same with equal ratios. @throws RangeError  unless both ends are > 0
[[nodiscard]] std::vector<double> log_steps(double from, double to, int n);

/// Index into each of several lists for one point of their grid; the first list varies slowest.
/// @param point  < product of sizes
[[nodiscard]] std::vector<std::size_t> grid_point(std::size_t point, const std::vector<std::size_t>& sizes);

/// A Latin hypercube: n_samples x n_variables numbers in (0, 1). In each column every one of the n_samples equal strata
/// contains exactly one number, at random within it; columns are shuffled independently of each other. The same seed gives
/// the same numbers on every machine (std::mt19937_64, whose output the standard fixes; shuffles and uniform numbers are
/// made from it here).
/// Source: McKay, Beckman & Conover, Technometrics 21 (1979) 239-245.
/// @param n_samples  1 to 1e6
[[nodiscard]] Eigen::MatrixXd latin_hypercube(int n_samples, int n_variables, std::uint64_t seed);

/// The design of Sobol' indices: two independent samples A and B of each variable, and for each variable A with the column
/// of that variable from B. A and B are one Latin hypercube of twice as many variables.
/// @returns (n_variables + 2) n_samples x n_variables numbers in (0, 1): A, then B, then A with each column in turn
/// Source: Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270.
[[nodiscard]] Eigen::MatrixXd saltelli_design(int n_samples, int n_variables, std::uint64_t seed);

}  // namespace driftwright
