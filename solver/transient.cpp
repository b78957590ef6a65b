#include "solver/transient.hpp"

#include <arkode/arkode_arkstep.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_nonlinearsolver.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

#include "base/errors.hpp"
#include "solver/heat_ode.hpp"
#include "solver/overshoot.hpp"

namespace driftwright::solver {
namespace {

struct FreeContext {
  void operator()(SUNContext c) const { SUNContext_Free(&c); }
};
struct FreeVector {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
struct FreeStageSolver {
  void operator()(SUNNonlinearSolver s) const { SUNNonlinSolFree(s); }
};
struct FreeArkode {
  void operator()(void* mem) const { ARKStepFree(&mem); }
};
using ContextPtr = std::unique_ptr<std::remove_pointer_t<SUNContext>, FreeContext>;
using VectorPtr = std::unique_ptr<std::remove_pointer_t<N_Vector>, FreeVector>;
using StageSolverPtr = std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, FreeStageSolver>;
using ArkodePtr = std::unique_ptr<void, FreeArkode>;

/// What the callbacks are handed.
struct Callee {
  HeatOde& ode;
  int n_thermostats = 0;
  void* arkode = nullptr;  ///< for what a stage is made of
  std::exception_ptr failure;
  std::string out_of_range;  ///< what the law said that refused a trial state last
};

// No exception crosses a C frame: keep it, return a code, rethrow when ARKODE has returned.
template <class Work>
int guarded(void* user, Work work) noexcept {
  auto& callee = *static_cast<Callee*>(user);
  try {
    work(callee);
    return 0;
  } catch (const RangeError& e) {
    callee.out_of_range = e.what();
    return +1;  // a trial state that no law is defined at: ARKODE tries a smaller step
  } catch (...) {
    callee.failure = std::current_exception();
    return -1;
  }
}

const double* in(N_Vector v) {
  return N_VGetArrayPointer(v);
}
double* out(N_Vector v) {
  return N_VGetArrayPointer(v);
}

int rhs_callback(realtype t, N_Vector y, N_Vector ydot, void* user) noexcept {
  return guarded(user, [&](Callee& c) { c.ode.slopes(t, in(y), out(ydot)); });
}
int switch_callback(realtype t, N_Vector y, realtype* distance, void* user) noexcept {
  return guarded(user, [&](Callee& c) {
    for (int i = 0; i < c.n_thermostats; ++i) distance[i] = c.ode.distance_to_switch_K(i, t, in(y));
  });
}
int stage_callback(SUNNonlinearSolver s, N_Vector, N_Vector correction, N_Vector weight, realtype, booleantype,
                   void*) noexcept {
  bool converged = false;
  const int flag = guarded(s->content, [&](Callee& c) {
    realtype t = 0.0, gamma = 0.0;
    N_Vector predicted = nullptr, z = nullptr, slope = nullptr, gathered = nullptr;
    void* user = nullptr;
    ARKStepGetNonlinearSystemData(c.arkode, &t, &predicted, &z, &slope, &gamma, &gathered, &user);
    converged = c.ode.solve_stage(t, gamma, in(predicted), in(gathered), in(weight), out(correction));
  });
  if (flag < 0) return flag;
  return flag == 0 && converged ? SUN_NLS_SUCCESS : SUN_NLS_CONV_RECVR;  // ARKODE tries a smaller step
}

/// To ARKODE this is a nonlinear solver that keeps everything to itself, as fixed-point ones do.
StageSolverPtr make_stage_solver(Callee& callee, SUNContext context) {
  StageSolverPtr s(SUNNonlinSolNewEmpty(context));
  s->content = &callee;
  s->ops->gettype = [](SUNNonlinearSolver) { return SUNNONLINEARSOLVER_FIXEDPOINT; };
  s->ops->solve = stage_callback;
  s->ops->setsysfn = [](SUNNonlinearSolver, SUNNonlinSolSysFn) -> int { return SUN_NLS_SUCCESS; };
  s->ops->free = [](SUNNonlinearSolver self) -> int {
    self->content = nullptr;  // borrowed
    SUNNonlinSolFreeEmpty(self);
    return SUN_NLS_SUCCESS;
  };
  return s;
}

void check(int flag, const char* call, double time_s, Callee& callee) {
  if (callee.failure) std::rethrow_exception(callee.failure);
  if (flag >= 0) return;
  const std::unique_ptr<char, decltype(&std::free)> name(ARKStepGetReturnFlagName(flag), &std::free);
  const std::string remedy = callee.out_of_range.empty() ? "try looser tolerances in `solver`"
                                                         : "a law refused a trial state: " + callee.out_of_range;
  throw SolveError(fmt::format("{} failed at t = {:.1f} s with {}; {}", call, time_s, name.get(), remedy));
}

/// Times at which the drive stays but something else bends or jumps.
std::vector<double> knots_s(const FullSystem& system, const TimeSeries& hall) {
  std::vector<double> knots = hall.time_s;
  knots.insert(knots.end(), system.change_times_s.begin(), system.change_times_s.end());
  for (const FixedUnknowns& f : system.fixed) knots.insert(knots.end(), f.theta.time_s.begin(), f.theta.time_s.end());
  return knots;
}

/// @throws SolveError  at temperatures that no machine has: below absolute zero, or above what melts any part of it
void require_sane(const double* theta, int n, double reference_K, double t_s) {
  constexpr double kMost_K = 5000.0;
  for (int i = 0; i < n; ++i) {
    const double t_K = reference_K + theta[i];
    if (t_K >= 0.0 && t_K <= kMost_K) continue;
    throw SolveError(
        fmt::format("a temperature of {:.3g} K at t = {:.1f} s: a source cools or heats more than films, links "
                    "and joints can make up for",
                    t_K, t_s));
  }
}

/// Coldest and warmest of what surrounds the machine at a time.
std::pair<double, double> surroundings_K(const FullSystem& system, const TimeSeries& hall, double t_s) {
  double low = hall.at(t_s), high = low;
  for (const FixedUnknowns& f : system.fixed) {
    if (f.follows_hall) continue;
    low = std::min(low, f.theta.at(t_s));
    high = std::max(high, f.theta.at(t_s));
  }
  return {low, high};
}

/// y = the cubic through two states and their slopes; without the slope at the start, which is rough after a jump, the parabola.
void interpolate(double share, double step_s, const double* from, const double* slope_from, const double* to,
                 const double* slope_to, int size, double* y) {
  const double s = share, r = 1.0 - share;
  const double of_to = slope_from ? s * s * (3.0 - 2.0 * s) : s * (2.0 - s);
  const double of_slope_to = slope_from ? -s * s * r * step_s : -s * r * step_s;
  const double of_slope_from = s * r * r * step_s;
  for_blocks(size, [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const double at = from[i] + of_to * (to[i] - from[i]) + of_slope_to * slope_to[i];
      y[i] = slope_from ? at + of_slope_from * slope_from[i] : at;
    }
  });
}

/// What is read off a state, by columns of few or many entries.
class Readings {
 public:
  explicit Readings(const Outputs& outputs) : outputs_(outputs), entries_(outputs.state.cols()) {
    for (Eigen::Index j = 0; j < outputs.state.cols(); ++j) {
      for (Eigen::Index i = 0; i < outputs.state.rows(); ++i) {
        if (outputs.state(i, j) != 0.0) entries_[j].push_back(static_cast<int>(i));
      }
    }
  }
  [[nodiscard]] Eigen::VectorXd of(const double* theta, double hall_K) const {
    Eigen::VectorXd y = hall_K * outputs_.hall;
    const auto n = static_cast<int>(outputs_.state.rows());
    for (Eigen::Index j = 0; j < y.size(); ++j) {
      const double* column = outputs_.state.col(j).data();
      if (4 * entries_[j].size() > static_cast<std::size_t>(n)) {
        y[j] += dot(column, theta, n);
        continue;
      }
      for (int i : entries_[j]) y[j] += column[i] * theta[i];
    }
    return y;
  }

 private:
  const Outputs& outputs_;
  std::vector<std::vector<int>> entries_;
};

}  // namespace

double Trajectory::energy_gap() const {
  const Eigen::VectorXd last = heat_J.col(heat_J.cols() - 1);
  double in_J = 0.0, magnitude_J = std::abs(stored_J[stored_J.size() - 1]);
  for (std::size_t j = 0; j < flows.size(); ++j) {
    if (flows[j].kind == FlowKind::kInternal) continue;
    const double heat = last[static_cast<Eigen::Index>(j)];
    in_J += heat;
    magnitude_J += std::abs(heat);
  }
  return magnitude_J == 0.0 ? 0.0 : std::abs(in_J - stored_J[stored_J.size() - 1]) / (0.5 * magnitude_J);
}

Trajectory simulate(const FullSystem& system, const Cyclogram& cyclogram, const TimeSeries& hall,
                    const std::vector<double>& output_s, const TransientOptions& options, const Eigen::VectorXd& start,
                    const OutputCallback& callback) {
  constexpr double kShareOfTolerance = 0.02;  // errors of linear solves do not steer the steps
  HeatOde ode(system, hall, kShareOfTolerance * options.absolute_tolerance_K);
  const int n = system.size(), n_flows = ode.n_flows();

  SUNContext raw_context = nullptr;
  SUNContext_Create(nullptr, &raw_context);
  const ContextPtr context(raw_context);
  const VectorPtr y(N_VNew_Serial(ode.size(), context.get())), tolerance(N_VNew_Serial(ode.size(), context.get()));
  std::fill(out(y.get()), out(y.get()) + ode.size(), 0.0);
  std::copy(start.data(), start.data() + n, out(y.get()));
  // What is held at another temperature than it starts with jumps at once; the heat of that jump belongs to the balance.
  const Eigen::VectorXd jump_J = ode.prescribe(0.0, out(y.get()));
  const std::vector<double> began(in(y.get()), in(y.get()) + n);
  std::fill(out(tolerance.get()), out(tolerance.get()) + n, options.absolute_tolerance_K);
  std::fill(out(tolerance.get()) + n, out(tolerance.get()) + ode.size(), 1e30);  // heats follow, they do not steer

  const std::vector<LinearStretch> stretches = linear_stretches(cyclogram, knots_s(system, hall));
  Callee callee{ode, static_cast<int>(system.thermostats.size()), nullptr, nullptr, {}};
  ode.set_thermostats(0.0, in(y.get()));
  (void)ode.begin_stretch(stretches.front());
  // Made before ARKODE and freed after it, which still looks at them when it goes.
  const StageSolverPtr stage = make_stage_solver(callee, context.get());
  const ArkodePtr arkode(ARKStepCreate(nullptr, rhs_callback, 0.0, y.get(), context.get()));
  void* mem = arkode.get();
  callee.arkode = mem;
  const auto must = [&](int flag, const char* call) { check(flag, call, 0.0, callee); };
  // Its messages come back as flags; check() says them in our words.
  must(ARKStepSetErrHandlerFn(
           mem, [](int, const char*, const char*, char*, void*) {}, nullptr),
       "ARKStepSetErrHandlerFn");
  must(ARKStepSetUserData(mem, &callee), "ARKStepSetUserData");
  must(ARKStepSVtolerances(mem, options.relative_tolerance, tolerance.get()), "ARKStepSVtolerances");
  must(ARKStepSetTableNum(mem, ARKODE_ESDIRK324L2SA_4_2_3, ARKODE_ERK_NONE), "ARKStepSetTableNum");
  must(ARKStepSetNonlinearSolver(mem, stage.get()), "ARKStepSetNonlinearSolver");
  must(ARKStepSetDeduceImplicitRhs(mem, SUNTRUE), "ARKStepSetDeduceImplicitRhs");
  must(ARKStepSetMaxErrTestFails(mem, 40),
       "ARKStepSetMaxErrTestFails");  // a shock may need steps far below the first
  must(ARKStepSetMaxNumSteps(mem, 1000000), "ARKStepSetMaxNumSteps");
  must(ARKStepSetMaxStep(mem, options.max_step_s), "ARKStepSetMaxStep");
  if (callee.n_thermostats > 0) must(ARKStepRootInit(mem, callee.n_thermostats, switch_callback), "ARKStepRootInit");

  Trajectory run;
  run.flows = ode.flows();
  run.time_s = output_s;
  const auto n_times = static_cast<Eigen::Index>(output_s.size());
  run.outputs.resize(system.outputs.state.cols(), n_times);
  run.heat_J.resize(n_flows, n_times);
  run.stored_J.resize(n_times);

  const Readings readings(system.outputs);
  const VectorPtr at_output(N_VNew_Serial(ode.size(), context.get()));
  const VectorPtr before(N_VNew_Serial(ode.size(), context.get()));  // the state at which the last step began
  Eigen::Index next = 0;
  const auto take_output = [&](double t_s, N_Vector state_vector) {
    run.outputs.col(next) = readings.of(in(state_vector), hall.at(t_s));
    run.heat_J.col(next).setZero();
    run.stored_J[next] = 0.0;
    if (t_s > 0.0) {
      run.heat_J.col(next) = jump_J + ode.heats_J(in(state_vector), began.data());
      run.stored_J[next] = jump_J.sum() + ode.stored_J(in(state_vector), began.data());
    }
    ++next;
    if (callback) callback(t_s, Eigen::Map<const Eigen::VectorXd>(in(state_vector), n));
  };
  OvershootWatch watch(options.absolute_tolerance_K);
  const bool bounds_hold = !system.is_stratified();  // else the air itself has a range
  double t_s = 0.0;
  if (next < n_times && output_s[next] <= 0.0) take_output(0.0, y.get());
  const auto restart = [&](double end_s) {
    ode.forget_slopes();
    check(ARKStepReset(mem, t_s, y.get()), "ARKStepReset", t_s, callee);
    check(ARKStepSetInitStep(mem, std::min(5.0, 0.1 * (end_s - t_s))), "ARKStepSetInitStep", t_s, callee);
    watch.begin(t_s, in(y.get()), n);
  };
  bool first = true;
  int n_switches = 0;
  for (const LinearStretch& stretch : stretches) {
    const bool jumps = ode.begin_stretch(stretch);
    if (jumps || first) restart(stretch.end_s);
    first = false;
    check(ARKStepSetStopTime(mem, stretch.end_s), "ARKStepSetStopTime", t_s, callee);
    while (t_s < stretch.end_s) {
      const double began_s = t_s;
      std::copy(in(y.get()), in(y.get()) + ode.size(), out(before.get()));
      const int flag = ARKStepEvolve(mem, stretch.end_s, y.get(), &t_s, ARK_ONE_STEP);
      check(flag, "ARKStepEvolve", t_s, callee);
      // Steps that shrink towards a time no law lets them pass would go on for ever.
      constexpr double kLeastStep = 1e-12;
      if (t_s - began_s <= kLeastStep * t_s) check(ARK_CONV_FAILURE, "ARKStepEvolve", t_s, callee);
      callee.out_of_range.clear();
      require_sane(in(y.get()), n, system.reference_K, t_s);
      if (t_s > stretch.end_s - 1e-9 * stretch.end_s) t_s = stretch.end_s;
      if (bounds_hold) {
        const auto [low_K, high_K] = surroundings_K(system, hall, t_s);
        const auto [least_W, most_W] = ode.power_range_W();
        watch.step(t_s, in(y.get()), n, low_K, high_K, most_W > 0.0, least_W < 0.0);
      }
      while (next < n_times && output_s[next] <= t_s) {
        if (output_s[next] == t_s) {
          take_output(t_s, y.get());
        } else {
          if (flag == ARK_ROOT_RETURN) {  // the step goes on beyond t
            check(ARKStepGetDky(mem, output_s[next], 0, at_output.get()), "ARKStepGetDky", t_s, callee);
          } else {
            interpolate((output_s[next] - began_s) / (t_s - began_s), t_s - began_s, in(before.get()),
                        ode.starts_rough() ? nullptr : ode.slope_at_start(), in(y.get()), ode.slope_at_end(), ode.size(),
                        out(at_output.get()));
          }
          take_output(output_s[next], at_output.get());
        }
      }
      if (flag == ARK_ROOT_RETURN && t_s < stretch.end_s) {
        std::vector<int> reached(callee.n_thermostats);
        check(ARKStepGetRootInfo(mem, reached.data()), "ARKStepGetRootInfo", t_s, callee);
        for (int i = 0; i < callee.n_thermostats; ++i) {
          if (reached[i] == 0) continue;
          ode.toggle(i);
          if (++n_switches <= options.most_switches) continue;
          throw SolveError(
              fmt::format("thermostat '{}' switched for the {}th time at t = {:.1f} s; is its hysteresis too small "
                          "for its volume?",
                          system.thermostats[i].name, n_switches, t_s));
        }
        (void)ode.begin_stretch(stretch);
        restart(stretch.end_s);
        check(ARKStepSetStopTime(mem, stretch.end_s), "ARKStepSetStopTime", t_s, callee);
      }
    }
  }
  run.overshoots = watch.result();
  long n_steps = 0;
  ARKStepGetNumSteps(mem, &n_steps);
  run.n_steps = static_cast<int>(n_steps);
  run.n_solves = ode.n_solves();
  run.n_iterations = ode.n_iterations();
  return run;
}

}  // namespace driftwright::solver
