#include "solver/kept_steps.hpp"

#include <cmath>

#include "base/errors.hpp"
#include "solver/exponential_run.hpp"
#include "solver/exponentials.hpp"
#include "solver/live_rate.hpp"
#include "solver/step_ends.hpp"
#include "solver/stretches.hpp"

namespace driftwright::solver {
namespace {

constexpr int kMostHalved = 8;
// Step errors: if the difference of the two machines' laws changes more within a step, the step's error is checked.
constexpr double kApart = 10.0;
constexpr double kOfApart = 1e-2;  // allowed error as a share of that difference, in addition to twice a step's

/// One run with the steps of another.
class AlongSteps {
 public:
  AlongSteps(const StepsTaken& steps, const ReducedSystem& system, const TimeSeries& ambient, const Eigen::VectorXd& start)
      : steps_(steps), rates_(system, ambient), state_(start), rate_(start.size()) {}

  [[nodiscard]] const Eigen::VectorXd& state() const { return state_; }
  void enter(const LinearStretch& stretch) {
    (void)rates_.enter(stretch);
    knows_rate_ = false;
  }
  /// @return false if no step succeeds
  [[nodiscard]] bool go(const StepsTaken::Step& step, double from_s, double h_s, int n_halved = 0) {
    const StepsTaken::Matrices& whole = steps_.matrices[step.matrices];
    const bool is_whole = std::abs(h_s - whole.h_s) <= kSameStep * whole.h_s;
    begin_ = state_;
    if (is_whole ? tried(whole, step.more, from_s) : tried(part(whole, h_s), h_s / whole.h_s * step.more, from_s))
      return true;
    if (n_halved == kMostHalved) return false;
    state_ = begin_;
    knows_rate_ = false;
    return go(step, from_s, 0.5 * h_s, n_halved + 1) && go(step, from_s + 0.5 * h_s, 0.5 * h_s, n_halved + 1);
  }

 private:
  /// @return false if the step is too long
  [[nodiscard]] bool tried(const StepsTaken::Matrices& m, const Eigen::VectorXd& more, double from_s) {
    const Eigen::MatrixXd& tangent = steps_.tangents[m.tangent];
    if (!knows_rate_) rates_.rate(from_s, state_, rate_);
    n0_ = rate_;
    n0_.noalias() -= tangent * state_;
    next_.noalias() = m.decay * state_;
    next_.noalias() += m.first * n0_;
    n1_ = n0_ + more;
    state_ = next_;
    state_.noalias() += m.second * n1_;
    knows_rate_ = true;
    for (int j = 0; j < kMostStepIterations; ++j) {
      rates_.rate(from_s + m.h_s, state_, rate_);
      n1_ = rate_;
      n1_.noalias() -= tangent * state_;
      end_ = next_;
      end_.noalias() += m.second * n1_;
      const double moved = (end_ - state_).lpNorm<Eigen::Infinity>();
      state_.swap(end_);
      if (moved <= kShareIterated * steps_.allowed) return is_true(m, more, from_s);
    }
    return false;
  }
  /// True if a stored step is short enough for the differences of the other machine: checks its middle as
  /// ExponentialIntegrator does.
  [[nodiscard]] bool is_true(const StepsTaken::Matrices& m, const Eigen::VectorXd& more, double from_s) {
    end_.noalias() = m.second * (n1_ - n0_ - more);
    const double apart = end_.lpNorm<Eigen::Infinity>();
    if (apart <= kApart * steps_.allowed) return true;
    const Eigen::MatrixXd& tangent = steps_.tangents[m.tangent];
    end_ = 0.5 * (begin_ + state_) + 0.125 * m.h_s * (n0_ - n1_ + tangent * (begin_ - state_));
    rates_.rate(from_s + 0.5 * m.h_s, end_, next_);
    next_.noalias() -= tangent * end_;
    next_ -= 0.5 * (n0_ + n1_);
    return 2.0 / 3.0 * m.h_s * next_.lpNorm<Eigen::Infinity>() <= 2.0 * steps_.allowed + kOfApart * apart;
  }
  /// Matrices of a part of a step.
  [[nodiscard]] const StepsTaken::Matrices& part(const StepsTaken::Matrices& whole, double h_s) {
    for (const StepsTaken::Matrices& m : parts_) {
      if (m.tangent == whole.tangent && std::abs(h_s - m.h_s) <= kSameStep * h_s) return m;
    }
    const Exponentials e = exponentials(h_s * steps_.tangents[whole.tangent]);
    parts_.push_back({whole.tangent, h_s, e.exp, h_s * (e.phi1 - e.phi2), h_s * e.phi2});
    return parts_.back();
  }

  const StepsTaken& steps_;
  LiveRate rates_;
  Eigen::VectorXd state_, rate_, begin_, n0_, n1_, next_, end_;
  bool knows_rate_ = false;  ///< of the state, in the current stretch
  std::vector<StepsTaken::Matrices> parts_;
};

}  // namespace

std::optional<KeptSteps> KeptSteps::of(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& ambient,
                                       const std::vector<double>& output_s, const TransientOptions& options,
                                       const Eigen::VectorXd& start) {
  if (!system.thermostats.empty()) return std::nullopt;
  KeptSteps kept;
  kept.output_s_ = output_s;
  auto states = exponential_states(system, cyclogram, ambient, output_s, options, start, &kept.run_);
  if (!states || !kept.run_.is_whole) return std::nullopt;
  kept.states_ = *std::move(states);
  return kept;
}

std::optional<Eigen::MatrixXd> KeptSteps::states_of(const ReducedSystem& other, const Cyclogram& cyclogram,
                                                    const TimeSeries& ambient, const Eigen::VectorXd& start) const {
  if (other.size() != states_.rows() || !other.thermostats.empty()) return std::nullopt;
  Eigen::MatrixXd states(states_.rows(), states_.cols());
  const std::vector<LinearStretch> stretches = stretches_of(other, cyclogram, ambient);
  if (stretches.empty()) return std::nullopt;
  try {
    AlongSteps run(run_, other, ambient, start);
    std::size_t stretch = 0, next = 0;
    run.enter(stretches.front());
    const auto take_outputs = [&](double t_s, double rounding_s) {
      for (; next < output_s_.size() && output_s_[next] <= t_s + rounding_s; ++next)
        states.col(static_cast<Eigen::Index>(next)) = run.state();
    };
    take_outputs(0.0, 0.0);
    for (const StepsTaken::Step& step : run_.steps) {
      const double h_s = run_.matrices[step.matrices].h_s, until_s = step.from_s + h_s, rounding_s = kSameStep * h_s;
      double t_s = step.from_s;
      while (until_s - t_s > rounding_s) {
        while (stretches[stretch].end_s <= t_s + rounding_s) {
          if (++stretch == stretches.size()) return std::nullopt;
          run.enter(stretches[stretch]);
        }
        const double end_s = stretches[stretch].end_s < until_s - rounding_s ? stretches[stretch].end_s : until_s;
        if (!run.go(step, t_s, end_s - t_s)) return std::nullopt;
        t_s = end_s;
      }
      take_outputs(until_s, rounding_s);
    }
    if (next < output_s_.size()) return std::nullopt;
  } catch (const RangeError&) {
    return std::nullopt;
  }
  if (!(states.lpNorm<Eigen::Infinity>() <= run_.farthest)) return std::nullopt;
  return states;
}

}  // namespace driftwright::solver
