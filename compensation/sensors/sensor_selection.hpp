#pragma once
// Which few sensors? Several answers on one interface, so that they can be judged side by side.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compensation/sensors/grey_relational.hpp"
#include "compensation/sensors/product_sums.hpp"

namespace driftwright::compensation {

struct Selection {
  std::vector<std::string> sensors;  ///< best first
  std::string reason;                ///< what they were chosen by, one sentence with the numbers that decided
};

/// Picks at most n of the candidates for the target. Candidates that never change are not picked.
struct Selector {
  std::string name;
  std::function<Selection(std::span<const Record>, const std::vector<std::string>&, const std::string&, int)> select;
};

/// Deng's grey relational grade.
[[nodiscard]] Selection select_by_grey_grade(std::span<const Record> records, const std::vector<std::string>& candidates,
                                             const std::string& target, int n, const GreyOptions& options = {});
/// Largest |correlation| with the target.
[[nodiscard]] Selection select_by_correlation(std::span<const Record> records, const std::vector<std::string>& candidates,
                                              const std::string& target, int n);
/// n clusters of sensors that move alike (average linkage of 1 - |r|), of each the one that correlates best with the target.
/// Source: the usual remedy for multicollinear thermometers in the field; linkage by Sokal & Michener 1958.
[[nodiscard]] Selection select_by_clusters(std::span<const Record> records, const std::vector<std::string>& candidates,
                                           const std::string& target, int n);
/// One by one, each time the sensor with which runs left out are predicted best (held_out_rmse()); stops where none helps.
/// @throws InputError  for fewer than two records
[[nodiscard]] Selection select_forward(std::span<const Record> records, const std::vector<std::string>& candidates,
                                       const std::string& target, int n);
/// The best of all sets of n by held_out_rmse(). @throws InputError  for more than two million sets, fewer than two records
[[nodiscard]] Selection select_best_set(std::span<const Record> records, const std::vector<std::string>& candidates,
                                        const std::string& target, int n);
/// The n sensors that enter the LASSO's path first and stay, |y - X b|^2 / 2n + penalty |b|_1 by coordinate descent, penalty falling from where
/// all are 0. Source: Friedman, Hastie & Tibshirani, J. Stat. Softw. 33 (2010) 1.
[[nodiscard]] Selection select_by_lasso(std::span<const Record> records, const std::vector<std::string>& candidates,
                                        const std::string& target, int n);

/// All of the above. @param grey  how grey grades are made
[[nodiscard]] std::vector<Selector> selectors(const GreyOptions& grey = {});

/// RMS errors of left-out records for every set of n columns, in lexicographic order of the sets.
void for_each_set(int n_columns, int n, const std::function<void(std::span<const int>)>& visit);

}  // namespace driftwright::compensation
