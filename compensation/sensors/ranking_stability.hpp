#pragma once
// Tests how much the ranking of sensors depends on the data and on the distinguishing coefficient.

#include <span>

#include "compensation/sensors/grey_relational.hpp"

namespace driftwright::compensation {

struct RankedStability {
  std::string name;
  double lowest_rank = 0.0, highest_rank = 0.0;  ///< 5 % and 95 % quantile over the resamples; 1 is best
  double share_chosen = 0.0;                     ///< share of resamples in which it is among the n best
  double grade_deviation = 0.0;                  ///< standard deviation of its grade over the resamples
};

/// The result for all channels.
struct RankingStability {
  std::vector<RankedStability> channels;  ///< those with a grade, in the order of the ranking
  int n_resamples = 0;
  /// (rho, the n best in their order), for rho from 0.1 to 1.
  std::vector<std::pair<double, std::vector<std::string>>> by_rho;
  /// Neighbours in the ranking whose grades differ by at most two standard deviations of that difference, "X12 and X13".
  std::vector<std::pair<std::string, std::string>> undecided;
};

/// Resamples the rows in blocks (a twentieth of each record, so that neighbours stay together) with replacement and ranks
/// them again; images are those of all rows. @param n  number of sensors to choose
/// Source: Kuensch, Ann. Statist. 17 (1989) 1217 (block bootstrap).
[[nodiscard]] RankingStability ranking_stability(std::span<const Record> records, const std::string& reference,
                                                 const std::vector<std::string>& candidates, const GreyOptions& options,
                                                 int n, int n_resamples = 200, std::uint64_t seed = 1);

}  // namespace driftwright::compensation
