#pragma once
// Stores the run of a small machine whose laws depend on temperatures: its steps, their tangents and the exponentials of
// these (solver/exponential_run.hpp).
//
// A machine that differs slightly from it is run with the same steps and exponentials,
//
//     z(t + h) = e^{hJ} z + h (φ1 - φ2) N(t) + h φ2 N(t + h),   N = F - J z,
//
// with its own F. Only F describes the machine; J only decides which part is integrated exactly. No tangent is computed. An
// exponential is computed only if the other machine's drive or laws change within a step, or if its difference makes a step
// too long, so that it is halved. The errors of the steps are those of the stored run, so the error of the difference of the
// two is as small as the difference.

#include "solver/kept_states.hpp"
#include "solver/transient.hpp"

namespace driftwright::solver {

/// The steps of a run.
struct StepsTaken {
  /// The matrices of a step with the tangent J: e^{hJ}, h (φ1 - φ2), h φ2.
  struct Matrices {
    std::size_t tangent = 0;
    double h_s = 0.0;
    Eigen::MatrixXd decay, first, second;
  };
  struct Step {
    double from_s = 0.0;
    std::size_t matrices = 0;
    Eigen::VectorXd more;  ///< N(t + h) - N(t)
  };
  std::vector<Eigen::MatrixXd> tangents;
  std::vector<Matrices> matrices;
  std::vector<Step> steps;
  double allowed = 0.0;   ///< allowed error of a step
  double farthest = 0.0;  ///< largest distance of a state from the reference that is accepted
  bool is_whole = true;   ///< false: there were too many steps to store, and none are stored
};

/// The stored run.
class KeptSteps final : public KeptStates {
 public:
  static constexpr std::size_t kMostBytes = 128u << 20;  ///< of the matrices of one run: 128 MiB
  /// @returns none if exponential_states() returns none, for a system with thermostats, and for a run with more matrices
  ///          than can be stored
  [[nodiscard]] static std::optional<KeptSteps> of(const ReducedSystem& system, const Cyclogram& cyclogram,
                                                   const TimeSeries& ambient, const std::vector<double>& output_s,
                                                   const TransientOptions& options, const Eigen::VectorXd& start);

  /// Accurate to the error of the stored run's steps, and in each step to a hundredth of the difference of the two machines'
  /// laws.
  /// @returns none for a system with another number of unknowns or with thermostats, and for one that diverges
  [[nodiscard]] std::optional<Eigen::MatrixXd> states_of(const ReducedSystem& other, const Cyclogram& cyclogram,
                                                         const TimeSeries& ambient,
                                                         const Eigen::VectorXd& start) const override;

 private:
  KeptSteps() = default;

  StepsTaken run_;
  std::vector<double> output_s_;
};

}  // namespace driftwright::solver
