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
  /// Of each channel: the fits whose mean predicts it. Of an extended scenario up to three: the scenario as it is, all of it
  /// with what is learned beside it, less of it with what is learned.
  std::vector<std::vector<Smoothness>> members;
  std::vector<Smoothness> scenario;  ///< of each channel of an extended scenario: the scenario as it is
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

  /// Uses the penalties with the smallest error: common ones for all thermometers and for all displacements. If a scenario
  /// is extended, each channel is the mean of the member (Judged::members) with the smallest error on kept-out rows and of
  /// those with at most 1.5 times that error: in the mean this predicts new conditions better than one chosen member
  /// (docs/theory/measured.md). Less of the scenario is a member only if it predicts hidden speeds better than all of it
  /// does; if the records have a speed and no fold hides one, all of it is a member in any case, because nothing else knows
  /// how heat grows with the speed.
  /// @param like  uses the members of this one
  [[nodiscard]] Judged judged(const Structure& structure, const Judged* like = nullptr) const;
  /// Errors of the unchanged scenario.
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
