#pragma once
// Probings of one followed axis: which columns have them, what they do to its residual, and the same in words.

#include <optional>
#include <string>
#include <vector>

#include "compensation/predictors/residual_process.hpp"
#include "follow/followed.hpp"

namespace driftwright::follow {

class AxisProbing {
 public:
  /// @param target  the displacement that is corrected
  /// @param is_known  the drift counts from the first row
  AxisProbing(const std::string& target, const compensation::ResidualProcess& process, const compensation::Probe& probe,
              bool is_known, const std::vector<Channel>& channels);

  /// The columns of a stream that are probings of an axis. @throws InputError  where it has both kinds
  [[nodiscard]] static std::vector<std::string> columns_of(const std::string& target, const std::vector<Channel>& channels);

  /// Time passes, with a row or without. @param correction_um  in force until now
  void wait(double predicted_um, double correction_um, double step_s);
  /// The probing of a row, if it has one. Call it after wait(); before the first wait() a probing is refused.
  void hear(const std::vector<double>& values);

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
  compensation::ProbeFeedback feedback_;
  std::optional<std::size_t> drift_, left_;  // channels
  bool is_probed_ = false;                   // in the last row
};

}  // namespace driftwright::follow
