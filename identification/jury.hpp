#pragma once
// How well a structure predicts rows that were kept out.

#include "base/mean_error.hpp"
#include "identification/foster_network.hpp"

namespace driftwright::identification {

/// Folds as rows of all records, one after the other.
struct HiddenRows {
  std::string kind;
  std::vector<bool> hidden;
};

/// Logarithms of kept-out misses: a row a fold, a column a channel.
struct Loss {
  Eigen::MatrixXd log_rms, rms;  ///< with a floor; without
  Eigen::VectorXd of_fold;       ///< mean over channels, thermometers and displacements half each; NaN where none judges
  double mean = 0.0;             ///< over kinds of the mean over their folds
};

/// By how much more the one misses, or a channel of it: mean of the logarithms' differences over the folds.
[[nodiscard]] MeanError missed_more(const Loss& one, const Loss& other);
[[nodiscard]] MeanError missed_more(const Loss& one, const Loss& other, std::size_t channel);

/// Whether one is no worse than another beyond a standard error of their difference over the folds.
[[nodiscard]] bool is_as_good(const Loss& one, const Loss& best);

struct Judged {
  Structure structure;
  std::vector<Smoothness> smoothness;  ///< of each channel
  Loss loss;
  std::size_t n_bodies = 0;
  bool has_default_exponent = true;
};

/// Standard deviation of the values that are there.
[[nodiscard]] double deviation(const Eigen::VectorXd& y);

/// Judges structures by the folds of validation (compensation/judging/folds.hpp), each hidden from the fit in turn. All arguments are loans for its life.
class Jury {
 public:
  /// @param rise_K, blocks, simulated  as FosterProblem has them
  Jury(std::span<const Record> records, const RecordRoles& roles, double rise_K, const std::vector<std::size_t>& blocks,
       std::span<const Record> simulated = {});
  [[nodiscard]] const std::vector<HiddenRows>& folds() const { return folds_; }

  /// With the penalties that do best, alike for all thermometers and for all displacements; beside a scenario each channel's own.
  /// @param only  one of each channel: with these alone
  [[nodiscard]] Judged judged(const Structure& structure, const std::vector<Smoothness>& only = {}) const;
  /// Of the scenario that is extended, as it is, records beginning as they do in that extension.
  [[nodiscard]] Loss of_scenario(const Judged& extension) const;

 private:
  std::span<const Record> records_;
  const RecordRoles& roles_;
  double rise_K_;
  const std::vector<std::size_t>& blocks_;
  std::span<const Record> simulated_;
  std::vector<HiddenRows> folds_;
};

}  // namespace driftwright::identification
