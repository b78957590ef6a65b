#pragma once
// Methods for choosing a few sensors, with one interface, so that they can be compared.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compensation/sensors/grey_relational.hpp"
#include "compensation/sensors/product_sums.hpp"

namespace driftwright::compensation {

/// The chosen sensors.
struct Selection {
  std::vector<std::string> sensors;  ///< best first
  std::string reason;                ///< criterion of the choice, one sentence with the decisive numbers
};

/// Chooses at most n of the candidates for the target. Candidates that never change are not chosen.
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
/// n clusters of sensors with similar curves (average linkage of 1 - |r|); from each the one with the highest correlation
/// with the target.
/// Source: the usual remedy for multicollinear thermometers in the field; linkage by Sokal & Michener 1958.
[[nodiscard]] Selection select_by_clusters(std::span<const Record> records, const std::vector<std::string>& candidates,
                                           const std::string& target, int n);
/// One by one, each time the sensor that gives the best prediction of left-out runs (held_out_rmse()); stops when none
/// helps.
/// @throws InputError  for fewer than two records
[[nodiscard]] Selection select_forward(std::span<const Record> records, const std::vector<std::string>& candidates,
                                       const std::string& target, int n);
/// The best of all sets of n by held_out_rmse(). @throws InputError  for more than two million sets, fewer than two records
[[nodiscard]] Selection select_best_set(std::span<const Record> records, const std::vector<std::string>& candidates,
                                        const std::string& target, int n);
/// The n sensors that enter the LASSO's path first and stay in it, |y - X b|^2 / 2n + penalty |b|_1 by coordinate descent,
/// with the penalty decreasing from the value at which all are 0. Source: Friedman, Hastie & Tibshirani, J. Stat. Softw. 33
/// (2010) 1.
[[nodiscard]] Selection select_by_lasso(std::span<const Record> records, const std::vector<std::string>& candidates,
                                        const std::string& target, int n);

/// All of the above. @param grey  options of the grey grades
[[nodiscard]] std::vector<Selector> selectors(const GreyOptions& grey = {});

/// Calls visit() for every set of n columns, in lexicographic order.
void for_each_set(int n_columns, int n, const std::function<void(std::span<const int>)>& visit);

}  // namespace driftwright::compensation
