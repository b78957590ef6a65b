#pragma once
// Measures how well a structure predicts kept-out rows.

#include "base/mean_error.hpp"
#include "identification/foster_network.hpp"

namespace driftwright::identification {

/// Errors on kept-out rows: one row per fold, one column per channel.
struct Loss {
  Eigen::MatrixXd log_rms, rms;  ///< log_rms: logarithm, with a lower limit; rms: without
  /// Mean over channels, with half the weight for thermometers and half for displacements; NaN without a judged row.
  Eigen::VectorXd of_fold;
  double mean = 0.0;  ///< mean over kinds of the mean over their folds
};

/// By how much the error of `one` is larger than that of `other`, in all or in one channel: mean difference of the
/// logarithms over the folds.
[[nodiscard]] MeanError missed_more(const Loss& one, const Loss& other);
[[nodiscard]] MeanError missed_more(const Loss& one, const Loss& other, std::size_t channel);

/// True if one is not worse than another by more than a standard error of their difference over the folds.
[[nodiscard]] bool is_as_good(const Loss& one, const Loss& best);

/// A structure with its errors.
struct Judged {
  Structure structure;
  std::vector<Smoothness> smoothness;  ///< of each channel
  Loss loss;
  std::size_t n_bodies = 0;
  bool has_default_exponent = true;
};

/// Standard deviation of the values that are not missing.
[[nodiscard]] double deviation(const Eigen::VectorXd& y);

/// Judges structures by the folds of validation (compensation/judging/folds.hpp), each hidden from the fit in turn. All
/// arguments must outlive it.
class Jury {
 public:
  /// @param rise_K, blocks, simulated  as of FosterProblem
  Jury(std::span<const Record> records, const RecordRoles& roles, double rise_K, const std::vector<std::size_t>& blocks,
       std::span<const Record> simulated = {});
  [[nodiscard]] const std::vector<HiddenRows>& folds() const { return folds_; }

  /// Uses the penalties with the smallest error: common ones for all thermometers and for all displacements; if a scenario
  /// is extended, separate ones per channel.
  /// @param only  one per channel: uses these penalties
  [[nodiscard]] Judged judged(const Structure& structure, const std::vector<Smoothness>& only = {}) const;
  /// Errors of the unchanged scenario, with the same initial states of records as in that extension.
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
