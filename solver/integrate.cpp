#include "solver/integrate.hpp"

#include <arkode/arkode_arkstep.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_nonlinearsolver.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

#include "base/errors.hpp"
#include "solver/share.hpp"
#include "solver/stretches.hpp"

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

/// The data passed to the callbacks.
struct Callee {
  StageOde& ode;
  int n_thermostats = 0;
  void* arkode = nullptr;  ///< for computing a stage's data
  std::exception_ptr failure;
  std::string out_of_range;  ///< message of the law that refused the last trial state
};

// No exception crosses a C frame: it is stored, a code is returned, and it is rethrown when ARKODE has returned.
template <class Work>
int guarded(void* user, Work work) noexcept {
  auto& callee = *static_cast<Callee*>(user);
  try {
    work(callee);
    return 0;
  } catch (const RangeError& e) {
    callee.out_of_range = e.what();
    return +1;  // a trial state at which some law is undefined: ARKODE tries a smaller step
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

/// To ARKODE this is a nonlinear solver without a linear solver, like the fixed-point ones.
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
  const std::string at = fmt::format("t = {:.1f} s ({})", time_s, name.get());
  if (!callee.out_of_range.empty())
    throw SolveError(fmt::format("a law refused the state, {}, at {}", callee.out_of_range, at));
  throw SolveError(fmt::format(
      "{} failed at {}; try looser tolerances in `solver`; a machine whose heat grows as it warms may run away", call, at));
}

/// y = the cubic through two states and their slopes; if the slope at the start is rough after a jump, the parabola without
/// it.
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

N_Vector new_vector(const StageOde& ode, SUNContext context) {
  return ode.share() ? ode.share()->new_vector(ode.size(), context) : N_VNew_Serial(ode.size(), context);
}

/// Gives ARKODE the callbacks, the tolerances, the method and the limits of its steps.
void configure(void* mem, Callee& callee, SUNNonlinearSolver stage, N_Vector tolerance, const TransientOptions& options,
               double from_s) {
  const auto must = [&](int flag, const char* call) { check(flag, call, from_s, callee); };
  // ARKODE's messages arrive as flags; check() reports them in our own words.
  must(ARKStepSetErrHandlerFn(
           mem, [](int, const char*, const char*, char*, void*) {}, nullptr),
       "ARKStepSetErrHandlerFn");
  must(ARKStepSetUserData(mem, &callee), "ARKStepSetUserData");
  must(ARKStepSVtolerances(mem, options.relative_tolerance, tolerance), "ARKStepSVtolerances");
  must(ARKStepSetTableNum(mem, ARKODE_ESDIRK324L2SA_4_2_3, ARKODE_ERK_NONE), "ARKStepSetTableNum");
  must(ARKStepSetNonlinearSolver(mem, stage), "ARKStepSetNonlinearSolver");
  must(ARKStepSetDeduceImplicitRhs(mem, SUNTRUE), "ARKStepSetDeduceImplicitRhs");
  must(ARKStepSetMaxErrTestFails(mem, 40),
       "ARKStepSetMaxErrTestFails");  // a shock may need steps far smaller than the first
  must(ARKStepSetMaxNumSteps(mem, 1000000), "ARKStepSetMaxNumSteps");
  must(ARKStepSetMaxStep(mem, options.max_step_s), "ARKStepSetMaxStep");
  if (callee.n_thermostats > 0) must(ARKStepRootInit(mem, callee.n_thermostats, switch_callback), "ARKStepRootInit");
}

/// Switches the thermostats whose switching points the last step has reached.
/// @param n_switches  of all of them so far. @throws SolveError  beyond the most that are allowed
void toggle_reached(Callee& callee, double t_s, int most_switches, int& n_switches) {
  std::vector<int> reached(callee.n_thermostats);
  check(ARKStepGetRootInfo(callee.arkode, reached.data()), "ARKStepGetRootInfo", t_s, callee);
  for (int i = 0; i < callee.n_thermostats; ++i) {
    if (reached[i] == 0) continue;
    callee.ode.toggle(i);
    if (++n_switches <= most_switches) continue;
    throw SolveError(
        fmt::format("thermostat '{}' switched for the {}th time at t = {:.1f} s; is its hysteresis too small "
                    "for its volume?",
                    callee.ode.thermostats()[static_cast<std::size_t>(i)].name, n_switches, t_s));
  }
}

}  // namespace

Trajectory integrate(StageOde& ode, const std::vector<LinearStretch>& stretches, const TimeSeries& ambient,
                     const std::vector<double>& output_s, const TransientOptions& options, const Eigen::VectorXd& start,
                     const OutputCallback& callback) {
  require_within(stretches, output_s);
  const double from_s = stretches.front().start_s;
  SUNContext raw_context = nullptr;
  SUNContext_Create(nullptr, &raw_context);
  const ContextPtr context(raw_context);
  const VectorPtr y(new_vector(ode, context.get())), tolerance(new_vector(ode, context.get()));
  ode.begin(start, out(y.get()));
  ode.tolerances(options.absolute_tolerance_K, out(tolerance.get()));
  Callee callee{ode, static_cast<int>(ode.thermostats().size()), nullptr, nullptr, {}};
  (void)ode.begin_stretch(stretches.front(), out(y.get()));
  // Made before ARKODE and freed after it, because ARKODE uses them until it is freed.
  const StageSolverPtr stage = make_stage_solver(callee, context.get());
  const ArkodePtr arkode(ARKStepCreate(nullptr, rhs_callback, from_s, y.get(), context.get()));
  void* mem = arkode.get();
  callee.arkode = mem;
  configure(mem, callee, stage.get(), tolerance.get(), options, from_s);

  Trajectory run;
  run.flows = ode.flows();
  run.time_s = output_s;
  const auto n_times = static_cast<Eigen::Index>(output_s.size());
  run.heat_J.resize(static_cast<Eigen::Index>(run.flows.size()), n_times);
  run.stored_J.resize(n_times);

  const VectorPtr at_output(new_vector(ode, context.get()));
  const VectorPtr before(new_vector(ode, context.get()));  // the state at the start of the last step
  Eigen::Index next = 0;
  const auto take_output = [&](double t_s, N_Vector state_vector) {
    const Eigen::VectorXd outputs = ode.observe(in(state_vector), ambient.at(t_s));
    if (next == 0) run.outputs.resize(outputs.size(), n_times);
    run.outputs.col(next) = outputs;
    run.heat_J.col(next).setZero();
    run.stored_J[next] = 0.0;
    if (t_s > from_s) {
      run.heat_J.col(next) = ode.heats_J(in(state_vector));
      run.stored_J[next] = ode.stored_J(in(state_vector));
    }
    ++next;
    if (callback) callback(t_s, ode.state(in(state_vector)));
  };
  double t_s = from_s;
  if (next < n_times && output_s[next] <= from_s) take_output(from_s, y.get());
  const auto restart = [&](double end_s) {
    ode.restart(t_s, in(y.get()));
    check(ARKStepReset(mem, t_s, y.get()), "ARKStepReset", t_s, callee);
    check(ARKStepSetInitStep(mem, std::min(5.0, 0.1 * (end_s - t_s))), "ARKStepSetInitStep", t_s, callee);
  };
  bool is_elsewhere = true;  // ARKODE is not yet, or not quite, at t
  int n_switches = 0;
  for (const LinearStretch& stretch : stretches) {
    const bool jumps = ode.begin_stretch(stretch, out(y.get()));
    if (jumps || is_elsewhere) restart(stretch.end_s);
    is_elsewhere = false;
    check(ARKStepSetStopTime(mem, stretch.end_s), "ARKStepSetStopTime", t_s, callee);
    while (t_s < stretch.end_s) {
      const double began_s = t_s;
      std::copy(in(y.get()), in(y.get()) + ode.size(), out(before.get()));
      const int flag = ARKStepEvolve(mem, stretch.end_s, y.get(), &t_s, ARK_ONE_STEP);
      check(flag, "ARKStepEvolve", t_s, callee);
      // Steps that shrink towards a time that no law lets them pass would go on forever.
      constexpr double kLeastStep = 1e-12;
      if (t_s - began_s <= kLeastStep * t_s) check(ARK_CONV_FAILURE, "ARKStepEvolve", t_s, callee);
      callee.out_of_range.clear();
      if (t_s > stretch.end_s - 1e-9 * stretch.end_s) {
        is_elsewhere = t_s < stretch.end_s;
        t_s = stretch.end_s;
      }
      ode.look(t_s, in(y.get()));
      while (next < n_times && output_s[next] <= t_s) {
        if (output_s[next] == t_s) {
          take_output(t_s, y.get());
        } else {
          if (flag == ARK_ROOT_RETURN) {  // the step continues beyond t
            check(ARKStepGetDky(mem, output_s[next], 0, at_output.get()), "ARKStepGetDky", t_s, callee);
          } else {
            interpolate((output_s[next] - began_s) / (t_s - began_s), t_s - began_s, in(before.get()),
                        ode.starts_rough() ? nullptr : ode.slope_at_start(), in(y.get()), ode.slope_at_end(), ode.size(),
                        out(at_output.get()));
          }
          take_output(output_s[next], at_output.get());
        }
      }
      if (flag == ARK_ROOT_RETURN) {
        toggle_reached(callee, t_s, options.most_switches, n_switches);
        if (t_s >= stretch.end_s) break;  // reached at the very end: the next stretch begins with it switched
        (void)ode.begin_stretch(stretch, out(y.get()));
        restart(stretch.end_s);
        check(ARKStepSetStopTime(mem, stretch.end_s), "ARKStepSetStopTime", t_s, callee);
      }
    }
  }
  run.overshoots = ode.overshoots();
  long n_steps = 0;
  ARKStepGetNumSteps(mem, &n_steps);
  run.n_steps = static_cast<int>(n_steps);
  run.n_solves = ode.n_solves();
  run.n_iterations = ode.n_iterations();
  return run;
}

}  // namespace driftwright::solver
