#pragma once
// Probings of one followed axis: which columns have them, what they do to its residual, and the same in words.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/residual_process.hpp"
#include "follow/followed.hpp"

namespace driftwright::follow {

class AxisProbing {
 public:
  /// @param target  the displacement that is corrected
  /// @param names  of the predictors; more than one: a blend and its members, whose weights move with probings
  /// @param processes  probe_processes_of()
  AxisProbing(const std::string& target, std::vector<std::string> names, std::vector<probe_process> processes,
              const std::vector<Channel>& channels);

  /// The columns of a stream that are probings of an axis. @throws InputError  where it has both kinds
  [[nodiscard]] static std::vector<std::string> columns_of(const std::string& target, const std::vector<Channel>& channels);

  /// Time passes, with a row or without. @param predicted_um  of each predictor @param correction_um  in force until now
  void wait(std::span<const double> predicted_um, double correction_um, double step_s);
  /// The probing of a row, if it has one. Call it after wait(); before the first wait() a probing is refused.
  void hear(const std::vector<double>& values);

  /// The last prediction of each predictor, as wait() was given it.
  [[nodiscard]] std::vector<double> predicted_um() const;
  [[nodiscard]] double residual_um() const { return feedback_.estimate_um(); }
  /// Half width of the 95 % interval after some time: that without probings, times the deviation of the residual over that
  /// of its process. Unchanged until a probing was taken.
  [[nodiscard]] double interval_um(double without_um, double ahead_s = 0.0) const;
  /// What a line says. @param without_um  half width of the interval without probings; none: unknown
  [[nodiscard]] ProbingState state(std::optional<double> without_um) const;

  [[nodiscard]] std::vector<double> memory() const { return feedback_.memory(); }
  void recall(std::span<const double> memory) { feedback_.recall(memory); }

 private:
  [[nodiscard]] std::string words() const;
  std::vector<std::string> names_;
  compensation::ProbeFeedback feedback_;
  std::optional<std::size_t> drift_, left_;  // channels
  bool is_probed_ = false;                   // in the last row
};

}  // namespace driftwright::follow
