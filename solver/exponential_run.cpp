#include "solver/exponential_run.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "solver/exponentials.hpp"
#include "solver/live_rate.hpp"
#include "solver/reduced_model.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/step_ends.hpp"
#include "solver/stretches.hpp"

namespace driftwright::solver {
namespace {

constexpr double kShareOfTolerance = 0.05;  // error of a step, relative to the absolute tolerance
constexpr int kStepsOfOneTangent = 50;
constexpr std::size_t kMostKnown = 100;  // exponentials of one tangent; more are not stored for the next step
constexpr double kShortestStep_s = 1e-3;
constexpr double kFarthest_K = 3000.0;  // from the reference; no machine gets there
constexpr int kBisections = 40;

/// One run.
class ExponentialIntegrator {
 public:
  ExponentialIntegrator(const ReducedSystem& system, const TimeSeries& ambient, const TransientOptions& options,
                        const Eigen::VectorXd& start, StepsTaken* steps)
      : system_(system),
        ambient_(ambient),
        steps_(steps),
        rates_(system, ambient),
        state_(start),
        most_s_(options.max_step_s),
        most_switches_(options.most_switches),
        next_(start.size()),
        n0_(start.size()),
        n1_(start.size()),
        rest_(start.size()) {
    for (std::size_t i = 0; i < system.thermostats.size(); ++i) {
      if (beyond_K(i, ambient.at(0.0), start) > 0.0) rates_.toggle(i);
    }
    double per_unit = 1.0 / system.ones.norm();
    const auto look_at = [&](int p) {
      per_unit = std::max(per_unit, system.probes[static_cast<std::size_t>(p)].weights.norm());
    };
    const auto look_at_those_of =
        [&](const BoundLaw& law) {  // not all: a system may have more of them, from laws that it had before
          for (int p : law.probes) look_at(p);
        };
    for (const HeatSource& s : system.sources) look_at_those_of(s.power_W);
    for (const auto& e : system.exchanges) look_at_those_of(e.coefficient);
    for (const Thermostat& t : system.thermostats) look_at(t.probe);
    for (std::size_t o = 0; o < system.outputs.unit.size(); ++o) {
      if (system.outputs.unit[o] == "K")
        per_unit = std::max(per_unit, system.outputs.state.col(static_cast<Eigen::Index>(o)).norm());
    }
    allowed_ = kShareOfTolerance * options.absolute_tolerance_K / per_unit;
    farthest_ = kFarthest_K / per_unit;
    if (steps_) {
      steps_->allowed = allowed_;
      steps_->farthest = farthest_;
    }
  }

  [[nodiscard]] const Eigen::VectorXd& state() const { return state_; }
  /// @param stretch  must outlive the steps in it
  void enter(const LinearStretch& stretch) {
    stretch_ = &stretch;
    if (rates_.enter(stretch) || stretch.drive_changed) has_tangent_ = false;
  }
  /// @return false if no step succeeds
  [[nodiscard]] bool go(double from_s, double until_s) {
    double t_s = from_s, limit_s = std::min(until_s - from_s, most_s_);
    while (until_s - t_s > kSameStep * (until_s - from_s)) {
      const double h_s = until_s - t_s <= (1.0 + kSameStep) * limit_s ? until_s - t_s : limit_s;
      if (const double gone_s = step(t_s, h_s); gone_s > 0.0) {
        t_s += gone_s;
        limit_s = std::min(2.0 * limit_s, most_s_);
        if (n_switches_ > most_switches_) return false;
      } else {
        has_tangent_ = has_tangent_ && n_steps_ == 0;  // the tangent belongs to exactly this state
        limit_s = 0.5 * h_s;
        if (!(limit_s > kShortestStep_s)) return false;
      }
    }
    return state_.lpNorm<Eigen::Infinity>() <= farthest_;
  }

 private:
  /// N = F - J z.
  void rest(double t_s, const Eigen::VectorXd& z, Eigen::VectorXd& n) {
    rates_.rate(t_s, z, n);
    n.noalias() -= tangent_ * z;
  }
  void prepare(double t_s, double h_s) {
    if (!has_tangent_ || n_steps_ == kStepsOfOneTangent) {
      tangent_ = rates_.tangent(t_s, state_);
      is_tangent_kept_ = false;
      has_tangent_ = true;
      n_steps_ = 0;
      known_s_ = -1.0;
      known_.clear();
    }
    if (std::abs(h_s - known_s_) <= kSameStep * h_s) return;
    const Exponentials& e = exponentials_of(h_s);
    decay_ = e.exp;
    second_ = h_s * e.phi2;
    first_ = h_s * e.phi1 - second_;
    known_s_ = h_s;
  }
  /// Exponentials of the current tangent: stored ones, doubled from those of half the step, or new ones.
  const Exponentials& exponentials_of(double h_s) {
    const auto of = [&](double length_s) {
      return std::find_if(known_.begin(), known_.end(),
                          [&](const auto& e) { return std::abs(e.first - length_s) <= kSameStep * length_s; });
    };
    if (const auto same = of(h_s); same != known_.end()) return same->second;
    if (known_.size() > kMostKnown) known_.clear();
    std::vector<Exponentials> halves;
    if (const auto half = of(0.5 * h_s); half != known_.end()) {
      halves.push_back(doubled(half->second));
    } else {
      halves = exponentials_and_halves(h_s * tangent_);
    }
    for (std::size_t i = halves.size(); i-- > 0;)
      known_.emplace_back(std::ldexp(h_s, -static_cast<int>(i)), std::move(halves[i]));
    return known_.back().second;
  }
  /// Distance of a thermostat's probe beyond its next switching temperature: > 0 means it must switch on, < 0 off.
  [[nodiscard]] double beyond_K(std::size_t i, double ambient_K, const Eigen::VectorXd& z) const {
    const Thermostat& t = system_.thermostats[i];
    const double probe_K = system_.reference_K + system_.probes[static_cast<std::size_t>(t.probe)].theta_K(z, ambient_K);
    return probe_K - (rates_.is_on(i) ? t.off_below_K : t.on_above_K);
  }
  /// Share of a step from the state to `end` at which the first thermostat switches, on the cubic through both; 1 and none
  /// if none switches.
  [[nodiscard]] double first_switch(double t_s, double h_s, const Eigen::VectorXd& end,
                                    std::vector<std::size_t>& which) const {
    which.clear();
    double first = 1.0;
    for (std::size_t i = 0; i < system_.thermostats.size(); ++i) {
      const bool is_on = rates_.is_on(i);
      const auto has_switched = [&](double beyond_K) { return is_on ? beyond_K < 0.0 : beyond_K > 0.0; };
      if (!has_switched(beyond_K(i, ambient_.at(t_s + h_s), end))) continue;
      double before = 0.0, after = 1.0;
      for (int k = 0; k < kBisections; ++k) {
        const double s = 0.5 * (before + after);
        (has_switched(beyond_K(i, ambient_.at(t_s + s * h_s), between(s, h_s, end))) ? after : before) = s;
      }
      if (after < first * (1.0 - kSameStep)) {
        first = after;
        which.clear();
      }
      if (after <= first * (1.0 + kSameStep)) which.push_back(i);
    }
    return first;
  }
  /// The cubic through the state, `end` and their slopes, which the last step has computed.
  [[nodiscard]] Eigen::VectorXd between(double s, double h_s, const Eigen::VectorXd& end) const {
    return state_ + s * s * (3.0 - 2.0 * s) * (end - state_) + s * (1.0 - s) * (1.0 - s) * h_s * (n0_ + tangent_ * state_) -
           s * s * (1.0 - s) * h_s * (n1_ + tangent_ * end);
  }
  /// @return the length of the step taken: h, less if a thermostat switched, 0 if no such step is possible
  double step(double t_s, double h_s) {
    Eigen::VectorXd end(state_.size());
    if (!tried(t_s, h_s, end)) return 0.0;
    std::vector<std::size_t> switched;
    if (const double share = first_switch(t_s, h_s, end, switched); share < 1.0) {
      h_s *= share;
      if (!tried(t_s, h_s, end)) return 0.0;
    }
    if (steps_) keep(t_s, h_s);
    state_.swap(end);
    ++n_steps_;
    for (std::size_t i : switched) rates_.toggle(i);
    if (!switched.empty()) {
      n_switches_ += static_cast<int>(switched.size());
      (void)rates_.enter(*stretch_);
      has_tangent_ = false;
    }
    return h_s;
  }
  /// Stores the last tried step.
  void keep(double t_s, double h_s) {
    if (!steps_->is_whole) return;
    if (3 * sizeof(double) * static_cast<std::size_t>(tangent_.size()) * steps_->matrices.size() > KeptSteps::kMostBytes) {
      *steps_ = {.tangents = {}, .matrices = {}, .steps = {}, .is_whole = false};
      return;
    }
    if (!is_tangent_kept_) steps_->tangents.push_back(tangent_);
    is_tangent_kept_ = true;
    const std::size_t tangent = steps_->tangents.size() - 1;
    std::vector<StepsTaken::Matrices>& known = steps_->matrices;
    std::size_t which = known.size();
    for (std::size_t i = known.size(); i-- > 0 && known[i].tangent == tangent && which == known.size();) {
      if (std::abs(known[i].h_s - h_s) <= kSameStep * h_s) which = i;
    }
    if (which == known.size()) known.push_back({tangent, h_s, decay_, first_, second_});
    steps_->steps.push_back({t_s, which, n1_ - n0_});
  }
  /// @param end  receives the state at its end; @return false if the step is too long
  bool tried(double t_s, double h_s, Eigen::VectorXd& end) {
    prepare(t_s, h_s);
    rest(t_s, state_, n0_);
    next_.noalias() = decay_ * state_;
    next_.noalias() += first_ * n0_;
    n1_ = n0_;
    end = next_;
    end.noalias() += second_ * n1_;
    bool is_there = false;
    for (int j = 0; j < kMostStepIterations && !is_there; ++j) {
      rest(t_s + h_s, end, n1_);
      rest_ = next_;
      rest_.noalias() += second_ * n1_;
      is_there = (rest_ - end).lpNorm<Eigen::Infinity>() <= kShareIterated * allowed_;
      end.swap(rest_);
    }
    if (!is_there) return false;
    // the middle, by the cubic through both ends and their slopes
    rest(t_s + 0.5 * h_s, between(0.5, h_s, end), rest_);
    return 2.0 / 3.0 * h_s * (rest_ - 0.5 * (n0_ + n1_)).lpNorm<Eigen::Infinity>() <= allowed_;
  }

  const ReducedSystem& system_;
  const TimeSeries& ambient_;
  StepsTaken* steps_;  ///< null: steps are not stored
  const LinearStretch* stretch_ = nullptr;
  LiveRate rates_;
  Eigen::VectorXd state_;
  double most_s_, allowed_ = 0.0, farthest_ = 0.0;
  int most_switches_, n_switches_ = 0;
  bool has_tangent_ = false, is_tangent_kept_ = false;
  int n_steps_ = 0;        ///< steps taken with this tangent
  double known_s_ = -1.0;  ///< the step that the matrices belong to
  Eigen::MatrixXd tangent_, decay_, first_, second_;
  std::vector<std::pair<double, Exponentials>> known_;  ///< of this tangent, with the step that they belong to
  Eigen::VectorXd next_, n0_, n1_, rest_;
};

}  // namespace

std::optional<Eigen::MatrixXd> exponential_states(const ReducedSystem& system, const Cyclogram& cyclogram,
                                                  const TimeSeries& ambient, const std::vector<double>& output_s,
                                                  const TransientOptions& options, const Eigen::VectorXd& start,
                                                  StepsTaken* steps) {
  if (system.size() > kMostOfExponentialRun || options.from_s != 0.0) return std::nullopt;
  Eigen::MatrixXd states(system.size(), static_cast<Eigen::Index>(output_s.size()));
  try {
    ExponentialIntegrator run(system, ambient, options, start, steps);
    std::size_t next = 0;
    const std::vector<LinearStretch> stretches = stretches_of(system, cyclogram, ambient);
    for (const LinearStretch& stretch : stretches) {
      run.enter(stretch);
      double t_s = stretch.start_s;
      for (; next < output_s.size() && output_s[next] <= stretch.end_s; ++next) {
        if (output_s[next] > t_s && !run.go(t_s, output_s[next])) return std::nullopt;
        t_s = std::max(t_s, output_s[next]);
        states.col(static_cast<Eigen::Index>(next)) = run.state();
      }
      if (next == output_s.size()) break;
      if (stretch.end_s > t_s && !run.go(t_s, stretch.end_s)) return std::nullopt;
    }
    if (next < output_s.size()) return std::nullopt;
  } catch (const RangeError&) {
    return std::nullopt;
  }
  return states;
}

Eigen::MatrixXd states_of_run(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& ambient,
                              const std::vector<double>& output_s, const TransientOptions& options,
                              const Eigen::VectorXd& start) {
  if (!system.is_linear()) {
    if (auto states = exponential_states(system, cyclogram, ambient, output_s, options, start)) return *std::move(states);
  }
  Eigen::MatrixXd states(system.size(), static_cast<Eigen::Index>(output_s.size()));
  Eigen::Index k = 0;
  const auto take = [&](double, const Eigen::VectorXd& z) { states.col(k++) = z; };
  if (system.is_linear() || system.mass.isIdentity(1e-8)) {
    (void)simulate(system, cyclogram, ambient, output_s, options, start, take);
    return states;
  }
  Eigen::VectorXd from = start;
  const ReducedSystem unit = with_unit_mass(system, from);
  (void)simulate(unit, cyclogram, ambient, output_s, options, from, take);
  const Eigen::LLT<Eigen::MatrixXd> factor(system.mass);  // back from w = C'z
  factor.matrixU().solveInPlace(states);
  return states;
}

}  // namespace driftwright::solver
