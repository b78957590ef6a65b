#pragma once
// Which of given points (rings, spheres, the spindle nose) to probe, so that errors at all of them are known best.
//
// Errors of the points have a covariance C about zero, over the rows of records: the square of a row counts, not its
// distance from a mean, because an error that stays is one to find, too. After a probing of the set S with noise r, errors
// at all points have the covariance of a conditional normal distribution,
//
//     C - C_:S (C_SS + r² I)^-1 C_S:.
//
// A-optimal is the set with the smallest mean of its diagonal over the points that count, D-optimal the one with the
// smallest determinant over them. Sources: Fedorov, Theory of Optimal Experiments (1972); Rasmussen & Williams, Gaussian
// Processes for Machine Learning (2006), A.2.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

/// Errors at points, in um.
struct PointErrors {
  std::vector<std::string> names;
  Eigen::MatrixXd covariance_um2;  ///< of the coordinates, about zero: those of the first point, of the second ...
  std::size_t n_rows = 0;          ///< rows with a value at each point
  std::size_t n_coordinates = 1;   ///< of a point; one probing reads all of them
};

/// From the displacements (um) that all records have; each row counts as much.
/// @throws InputError  for fewer than two common displacements, and without a row that has all of them
[[nodiscard]] PointErrors point_errors(std::span<const Record> records);

/// Of a table's rings, then of its judged points "table_1", "table_2" ..., each in x, y and z: the errors that a frame
/// corrects (studies/table_study.hpp). @throws InputError  for a channel of the table that a record does not have
[[nodiscard]] PointErrors table_point_errors(const scenarios::Scenario& scenario, std::span<const Record> records);

enum class PointCriterion { kMeanVariance, kDeterminant };  ///< A- and D-optimal

/// A set of points to probe.
struct PointSet {
  std::vector<std::size_t> points;  ///< rising indices of PointErrors::names
  double left_um = 0.0;             ///< root of the mean variance of the points that count
  double worst_um = 0.0;            ///< largest standard deviation of them
  std::size_t worst = 0;            ///< its point
  /// Half the logarithm of the determinant of the covariance before, over that after: information in nats.
  double nats = 0.0;
};

/// @param counting  points whose errors count; at least one
[[nodiscard]] PointSet judged_points(const PointErrors& errors, std::vector<std::size_t> probed,
                                     std::span<const std::size_t> counting, double noise_um);

/// The best set of n of the points that may be probed: of all sets, if there are 20,000 or fewer; else points are chosen one
/// after another and then exchanged one by one, until no exchange helps (Fedorov).
[[nodiscard]] PointSet best_points(const PointErrors& errors, std::span<const std::size_t> probable, std::size_t n,
                                   std::span<const std::size_t> counting, double noise_um, PointCriterion criterion);

/// The best sets by number of points.
struct PointChoice {
  PointErrors errors;
  std::vector<std::size_t> probable, counting;  ///< points that may be probed, and those whose errors count
  double noise_um = 1.0;
  PointSet without = {};
  std::vector<PointSet> by_variance = {}, by_determinant = {};  ///< of 1, 2 ... points
};

/// @param probable, counting  names of points; empty: all
/// @param n_most  largest number of points
/// @throws InputError  for a name that the records do not share
[[nodiscard]] PointChoice choose_points(PointErrors errors, const std::vector<std::string>& probable,
                                        const std::vector<std::string>& counting, std::size_t n_most, double noise_um);

}  // namespace driftwright::studies
