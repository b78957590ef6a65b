#pragma once
// A stored run, from which runs of slightly different machines are computed faster than by a new simulation.

#include <optional>

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Interface of such runs.
class KeptStates {
 public:
  virtual ~KeptStates() = default;

  /// Reduced states at the output times, size x n_times.
  [[nodiscard]] const Eigen::MatrixXd& states() const { return states_; }

  /// The states of another system with the same unknowns at the same times, size x n_times.
  /// @returns none if this run cannot be used for the other system, which then needs its own run
  [[nodiscard]] virtual std::optional<Eigen::MatrixXd> states_of(const ReducedSystem& other, const Cyclogram& cyclogram,
                                                                 const TimeSeries& ambient,
                                                                 const Eigen::VectorXd& start) const = 0;

 protected:
  KeptStates() = default;
  KeptStates(const KeptStates&) = default;
  KeptStates(KeptStates&&) = default;
  KeptStates& operator=(const KeptStates&) = default;
  KeptStates& operator=(KeptStates&&) = default;

  Eigen::MatrixXd states_;
};

}  // namespace driftwright::solver
