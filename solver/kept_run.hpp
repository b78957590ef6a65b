#pragma once
// A run that is kept, so that machines which differ from it a little are answered for less than a run of their own.

#include <optional>

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

class KeptRun {
 public:
  virtual ~KeptRun() = default;

  /// Reduced states at the outputs, size x n_times.
  [[nodiscard]] const Eigen::MatrixXd& states() const { return states_; }

  /// What the same unknowns come to in another system at the same times, size x n_times.
  /// @returns nothing where the other is none that this run can answer for: such a one is to be run by itself
  [[nodiscard]] virtual std::optional<Eigen::MatrixXd> states_of(const ReducedSystem& other, const Cyclogram& cyclogram,
                                                                 const TimeSeries& ambient,
                                                                 const Eigen::VectorXd& start) const = 0;

 protected:
  KeptRun() = default;
  KeptRun(const KeptRun&) = default;
  KeptRun(KeptRun&&) = default;
  KeptRun& operator=(const KeptRun&) = default;
  KeptRun& operator=(KeptRun&&) = default;

  Eigen::MatrixXd states_;
};

}  // namespace driftwright::solver
