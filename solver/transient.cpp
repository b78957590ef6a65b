#include "solver/transient.hpp"

#include <arkode/arkode_arkstep.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>

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
struct FreeLinearSolver {
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
};
struct FreeArkode {
  void operator()(void* mem) const { ARKStepFree(&mem); }
};
using ContextPtr = std::unique_ptr<std::remove_pointer_t<SUNContext>, FreeContext>;
using VectorPtr = std::unique_ptr<std::remove_pointer_t<N_Vector>, FreeVector>;
using LinearSolverPtr = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, FreeLinearSolver>;
using ArkodePtr = std::unique_ptr<void, FreeArkode>;

/// What the callbacks are handed.
struct Callee {
  HeatOde& ode;
  int n_thermostats = 0;
  void* arkode = nullptr;  ///< for the current gamma
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
  return guarded(user, [&](Callee& c) { c.ode.rhs(t, in(y), out(ydot)); });
}
int mass_times_callback(N_Vector v, N_Vector mv, realtype, void* user) noexcept {
  return guarded(user, [&](Callee& c) { c.ode.multiply_mass(in(v), out(mv)); });
}
int switch_callback(realtype t, N_Vector y, realtype* distance, void* user) noexcept {
  return guarded(user, [&](Callee& c) {
    for (int i = 0; i < c.n_thermostats; ++i) distance[i] = c.ode.distance_to_switch_K(i, t, in(y));
  });
}
int shifted_solve_callback(SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype) noexcept {
  return guarded(s->content, [&](Callee& c) {
    realtype gamma = 0.0;
    ARKStepGetCurrentGamma(c.arkode, &gamma);
    c.ode.solve_shifted(gamma, in(b), out(x));
  });
}
int mass_solve_callback(SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype) noexcept {
  return guarded(s->content, [&](Callee& c) { c.ode.solve_mass(in(b), out(x)); });
}
SUNLinearSolver_Type embedded_type(SUNLinearSolver) noexcept {
  return SUNLINEARSOLVER_MATRIX_EMBEDDED;
}

LinearSolverPtr make_linear_solver(Callee& callee, SUNContext context,
                                   int (*solve)(SUNLinearSolver, SUNMatrix, N_Vector, N_Vector, realtype) noexcept) {
  LinearSolverPtr s(SUNLinSolNewEmpty(context));
  s->content = &callee;
  s->ops->gettype = embedded_type;
  s->ops->solve = solve;
  s->ops->setatimes = [](SUNLinearSolver, void*, SUNATimesFn) -> int { return 0; };  // it knows its matrix
  s->ops->free = [](SUNLinearSolver self) -> int {
    self->content = nullptr;  // borrowed
    SUNLinSolFreeEmpty(self);
    return 0;
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
  HeatOde ode(system, hall, 2e-3 * options.absolute_tolerance_K);
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
  const LinearSolverPtr shifted = make_linear_solver(callee, context.get(), shifted_solve_callback);
  const LinearSolverPtr mass = make_linear_solver(callee, context.get(), mass_solve_callback);
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
  must(ARKStepSetLinearSolver(mem, shifted.get(), nullptr), "ARKStepSetLinearSolver");
  // Linear in the state but for laws that look at it; those take Newton iterations with a tangent that leaves their slope out.
  const bool is_affine = system.nonlinear.empty() && !system.capacity && !system.looks_at_state();
  if (is_affine) {
    must(ARKStepSetLinear(mem, 0), "ARKStepSetLinear");
  } else {
    must(ARKStepSetMaxNonlinIters(mem, 10), "ARKStepSetMaxNonlinIters");
  }
  must(ARKStepSetMassLinearSolver(mem, mass.get(), nullptr, SUNFALSE), "ARKStepSetMassLinearSolver");
  must(ARKStepSetMassTimes(mem, nullptr, mass_times_callback, &callee), "ARKStepSetMassTimes");
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

  const VectorPtr at_output(N_VNew_Serial(ode.size(), context.get()));
  Eigen::Index next = 0;
  const auto take_output = [&](double t_s, N_Vector state_vector) {
    const Eigen::VectorXd state = Eigen::Map<const Eigen::VectorXd>(in(state_vector), n);
    run.outputs.col(next) = system.observe(state, hall.at(t_s));
    run.heat_J.col(next).setZero();
    run.stored_J[next] = 0.0;
    if (t_s > 0.0) {
      run.heat_J.col(next) = jump_J + ode.heats_J(in(state_vector), began.data());
      run.stored_J[next] = jump_J.sum() + ode.stored_J(in(state_vector), began.data());
    }
    ++next;
    if (callback) callback(t_s, state);
  };
  OvershootWatch watch(options.absolute_tolerance_K);
  const bool bounds_hold = !system.is_stratified();  // else the air itself has a range
  double t_s = 0.0;
  if (next < n_times && output_s[next] <= 0.0) take_output(0.0, y.get());
  const auto restart = [&](double end_s) {
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
      const int flag = ARKStepEvolve(mem, stretch.end_s, y.get(), &t_s, ARK_ONE_STEP);
      check(flag, "ARKStepEvolve", t_s, callee);
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
          check(ARKStepGetDky(mem, output_s[next], 0, at_output.get()), "ARKStepGetDky", t_s, callee);
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
