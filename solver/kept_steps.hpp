#pragma once
// A run of a small machine whose laws look at temperatures, kept with its steps, their tangents and the exponentials of these (solver/exponential_run.hpp).
//
// A machine that differs from it a little goes the same steps with the same exponentials,
//
//     z(t + h) = e^{hJ} z + h (φ1 - φ2) N(t) + h φ2 N(t + h),   N = F - J z,
//
// with its own F, which is all that says what machine it is: J only says what is taken exactly. No tangent is taken, and no exponential is made but where the other
// machine's drive or laws change within a step, or where what is new in it makes it too long and it is halved. The errors of the steps are those of the kept run, so that what is left of them in a
// difference of the two is as small as the difference.

#include "solver/kept_run.hpp"
#include "solver/transient.hpp"

namespace driftwright::solver {

/// The steps of a run.
struct StepsOfRun {
  /// What a step of a tangent J is made with: e^{hJ}, h (φ1 - φ2), h φ2.
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
  double allowed = 0.0;   ///< error of a step
  double farthest = 0.0;  ///< of a state from the reference, beyond which no machine is
  bool is_whole = true;   ///< false: they were too many to keep, and none are
};

class KeptSteps final : public KeptRun {
 public:
  static constexpr std::size_t kMostBytes = 128u << 20;  ///< of the matrices of one run
  /// @returns nothing where exponential_states() has nothing, for a system with thermostats, and for a run of more matrices than are kept
  [[nodiscard]] static std::optional<KeptSteps> of(const ReducedSystem& system, const Cyclogram& cyclogram,
                                                   const TimeSeries& ambient, const std::vector<double>& output_s,
                                                   const TransientOptions& options, const Eigen::VectorXd& start);

  /// To the error of the kept run's steps and a hundredth of what the two machines' laws do differently in one.
  /// @returns nothing for a system with another number of unknowns or with thermostats, and for one that runs away
  [[nodiscard]] std::optional<Eigen::MatrixXd> states_of(const ReducedSystem& other, const Cyclogram& cyclogram,
                                                         const TimeSeries& ambient,
                                                         const Eigen::VectorXd& start) const override;

 private:
  KeptSteps() = default;

  StepsOfRun run_;
  std::vector<double> output_s_;
};

}  // namespace driftwright::solver
