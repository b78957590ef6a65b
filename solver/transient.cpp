#include "solver/transient.hpp"

#include <arkode/arkode_arkstep.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>

#include <cmath>
#include <exception>
#include <memory>

#include "base/errors.hpp"
#include "solver/pcg.hpp"

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

/// A flow of heat that is integrated along: a source, or an exchange with the hall.
struct Flow {
  const HeatSource* source = nullptr;
  const Exchange<SparseRow>* exchange = nullptr;
};

/// The right-hand side and its linear systems. The state is θ followed by the heats Q of the flows:
///     M dθ/dt = -K θ + f,   dQ_source/dt = P,   dQ_hall/dt = c (g'θ - hall_sum θ_hall).
class HeatOde {
 public:
  HeatOde(const FullSystem& system, const TimeSeries& hall, double pcg_tolerance_K)
      : system_(system),
        hall_(hall),
        tolerance_K_(pcg_tolerance_K),
        n_(system.size()),
        stiffness_(system.conduction),
        shifted_(system.mass),
        shifted_solver_(shifted_),
        mass_solver_(system.mass) {
    for (const HeatSource& s : system.sources) flows_.push_back({&s, nullptr});
    for (const auto& e : system.exchanges) {
      slots_.push_back(slots_of(e.matrix, system.conduction));
      if (e.hall_sum != 0.0) flows_.push_back({nullptr, &e});
    }
    mass_solver_.refresh();
    mass_warm_ = Eigen::VectorXd::Zero(n_);
  }

  void set_speed(double speed_rpm) {
    inputs_.speed_rpm = speed_rpm;
    stiffness_ = system_.conduction;
    for (std::size_t e = 0; e < slots_.size(); ++e) {
      const Exchange<SparseRow>& exchange = system_.exchanges[e];
      const double c = exchange.coefficient(inputs_);
      for (std::size_t k = 0; k < slots_[e].size(); ++k) {
        stiffness_.valuePtr()[slots_[e][k]] += c * exchange.matrix.valuePtr()[k];
      }
    }
    gamma_ = -1.0;
  }

  void rhs(double t_s, const double* y, double* ydot) {
    inputs_.hall_K = hall_.at(t_s);
    const Eigen::VectorXd f = system_.load(inputs_);
    multiply(stiffness_, y, ydot);
    Eigen::Map<Eigen::VectorXd> rate(ydot, n_);
    rate = f - rate;
    const Eigen::Map<const Eigen::VectorXd> theta(y, n_);
    for (std::size_t j = 0; j < flows_.size(); ++j) {
      const auto& [source, exchange] = flows_[j];
      ydot[n_ + j] =
          source ? source->power_W(inputs_)
                 : exchange->coefficient(inputs_) * (exchange->to_hall.dot(theta) - exchange->hall_sum * inputs_.hall_K);
    }
  }

  void multiply_mass(const double* x, double* mx) const {
    multiply(system_.mass, x, mx);
    std::copy(x + n_, x + n_ + flows_.size(), mx + n_);
  }

  /// (M + gamma K) x = b for θ, then the heats, which follow from θ.
  void solve_shifted(double gamma, const double* b, double* x) {
    if (gamma != gamma_) {
      const double* k = stiffness_.valuePtr();
      const double* m = system_.mass.valuePtr();
      double* a = shifted_.valuePtr();
      const auto n_entries = shifted_.nonZeros();
#pragma omp parallel for simd schedule(static) if (n_entries > kWorthThreads)
      for (Eigen::Index i = 0; i < n_entries; ++i) a[i] = m[i] + gamma * k[i];
      shifted_solver_.refresh();
      gamma_ = gamma;
    }
    std::fill(x, x + n_, 0.0);
    run(shifted_solver_, b, x);
    const Eigen::Map<const Eigen::VectorXd> theta(x, n_);
    for (std::size_t j = 0; j < flows_.size(); ++j) {
      const Exchange<SparseRow>* e = flows_[j].exchange;
      x[n_ + j] = b[n_ + j] + (e ? gamma * e->coefficient(inputs_) * e->to_hall.dot(theta) : 0.0);
    }
  }

  void solve_mass(const double* b, double* x) {
    std::copy(mass_warm_.data(), mass_warm_.data() + n_, x);  // the last rate is near this one
    run(mass_solver_, b, x);
    std::copy(x, x + n_, mass_warm_.data());
    std::copy(b + n_, b + n_ + flows_.size(), x + n_);
  }

  [[nodiscard]] int n_flows() const {
    return static_cast<int>(flows_.size());
  }
  [[nodiscard]] const std::vector<Flow>& flows() const {
    return flows_;
  }
  [[nodiscard]] int n_solves() const {
    return n_solves_;
  }
  [[nodiscard]] int n_iterations() const {
    return n_iterations_;
  }

  void* arkode = nullptr;  ///< for the current gamma
  std::exception_ptr failure;

 private:
  void run(Pcg& solver, const double* b, double* x) {
    const PcgOutcome outcome = solver.solve(b, x, tolerance_K_, 2000);
    ++n_solves_;
    n_iterations_ += outcome.iterations;
    if (!outcome.converged) {
      throw SolveError(
          fmt::format("PCG stopped after {} iterations at a residual of {:.2e} K (wanted {:.2e} K); is a film, "
                      "joint or material value extreme?",
                      outcome.iterations, outcome.residual, tolerance_K_));
    }
  }

  const FullSystem& system_;
  const TimeSeries& hall_;
  double tolerance_K_;
  int n_;
  std::vector<Flow> flows_;
  std::vector<std::vector<int>> slots_;  // of each exchange in the common pattern
  effects::Inputs inputs_;
  SparseRow stiffness_, shifted_;
  double gamma_ = -1.0;
  Pcg shifted_solver_, mass_solver_;
  Eigen::VectorXd mass_warm_;
  int n_solves_ = 0, n_iterations_ = 0;
};

// No exception crosses a C frame: keep it, return a code, rethrow when ARKODE has returned.
template <class Work>
int guarded(HeatOde& ode, Work work) noexcept {
  try {
    work();
    return 0;
  } catch (...) {
    ode.failure = std::current_exception();
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
  auto& ode = *static_cast<HeatOde*>(user);
  return guarded(ode, [&] { ode.rhs(t, in(y), out(ydot)); });
}
int mass_times_callback(N_Vector v, N_Vector mv, realtype, void* user) noexcept {
  auto& ode = *static_cast<HeatOde*>(user);
  return guarded(ode, [&] { ode.multiply_mass(in(v), out(mv)); });
}
int shifted_solve_callback(SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype) noexcept {
  auto& ode = *static_cast<HeatOde*>(s->content);
  return guarded(ode, [&] {
    realtype gamma = 0.0;
    ARKStepGetCurrentGamma(ode.arkode, &gamma);
    ode.solve_shifted(gamma, in(b), out(x));
  });
}
int mass_solve_callback(SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype) noexcept {
  auto& ode = *static_cast<HeatOde*>(s->content);
  return guarded(ode, [&] { ode.solve_mass(in(b), out(x)); });
}
SUNLinearSolver_Type embedded_type(SUNLinearSolver) noexcept {
  return SUNLINEARSOLVER_MATRIX_EMBEDDED;
}

LinearSolverPtr make_linear_solver(HeatOde& ode, SUNContext context,
                                   int (*solve)(SUNLinearSolver, SUNMatrix, N_Vector, N_Vector, realtype) noexcept) {
  LinearSolverPtr s(SUNLinSolNewEmpty(context));
  s->content = &ode;
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

void check(int flag, const char* call, double time_s, HeatOde& ode) {
  if (ode.failure) std::rethrow_exception(ode.failure);
  if (flag >= 0) return;
  const std::unique_ptr<char, decltype(&std::free)> name(ARKStepGetReturnFlagName(flag), &std::free);
  throw SolveError(
      fmt::format("{} failed at t = {:.1f} s with {}; try looser tolerances in `solver`", call, time_s, name.get()));
}

}  // namespace

double Trajectory::energy_gap() const {
  const Eigen::VectorXd last = heat_J.col(heat_J.cols() - 1);
  double in_J = 0.0, lost_J = 0.0;
  for (int j = 0; j < last.size(); ++j) {
    if (j < n_sources) {
      in_J += last[j];
    } else {
      lost_J += last[j];
    }
  }
  const double stored = stored_J[stored_J.size() - 1];
  const double scale = std::max({std::abs(in_J), std::abs(stored), std::abs(lost_J)});
  return scale == 0.0 ? 0.0 : std::abs(in_J - stored - lost_J) / scale;
}

Trajectory simulate(const FullSystem& system, const Cyclogram& cyclogram, const TimeSeries& hall,
                    const std::vector<double>& output_s, const TransientOptions& options, const Eigen::VectorXd& start,
                    const OutputCallback& callback) {
  HeatOde ode(system, hall, 2e-3 * options.absolute_tolerance_K);
  const int n = system.size(), n_flows = ode.n_flows();

  SUNContext raw_context = nullptr;
  SUNContext_Create(nullptr, &raw_context);
  const ContextPtr context(raw_context);
  const VectorPtr y(N_VNew_Serial(n + n_flows, context.get())), tolerance(N_VNew_Serial(n + n_flows, context.get()));
  std::fill(out(y.get()), out(y.get()) + n + n_flows, 0.0);
  std::copy(start.data(), start.data() + n, out(y.get()));
  std::fill(out(tolerance.get()), out(tolerance.get()) + n, options.absolute_tolerance_K);
  std::fill(out(tolerance.get()) + n, out(tolerance.get()) + n + n_flows,
            1e30);  // heats follow, they do not steer

  const std::vector<LinearStretch> stretches = linear_stretches(cyclogram, hall);
  ode.set_speed(stretches.front().drive.speed_rpm);
  // Made before ARKODE and freed after it, which still looks at them when it goes.
  const LinearSolverPtr shifted = make_linear_solver(ode, context.get(), shifted_solve_callback);
  const LinearSolverPtr mass = make_linear_solver(ode, context.get(), mass_solve_callback);
  const ArkodePtr arkode(ARKStepCreate(nullptr, rhs_callback, 0.0, y.get(), context.get()));
  void* mem = arkode.get();
  ode.arkode = mem;
  const auto must = [&](int flag, const char* call) { check(flag, call, 0.0, ode); };
  must(ARKStepSetUserData(mem, &ode), "ARKStepSetUserData");
  must(ARKStepSVtolerances(mem, options.relative_tolerance, tolerance.get()), "ARKStepSVtolerances");
  must(ARKStepSetTableNum(mem, ARKODE_ESDIRK324L2SA_4_2_3, ARKODE_ERK_NONE), "ARKStepSetTableNum");
  must(ARKStepSetLinearSolver(mem, shifted.get(), nullptr), "ARKStepSetLinearSolver");
  must(ARKStepSetLinear(mem, 0), "ARKStepSetLinear");
  must(ARKStepSetMassLinearSolver(mem, mass.get(), nullptr, SUNFALSE), "ARKStepSetMassLinearSolver");
  must(ARKStepSetMassTimes(mem, nullptr, mass_times_callback, &ode), "ARKStepSetMassTimes");
  must(ARKStepSetMaxErrTestFails(mem, 40),
       "ARKStepSetMaxErrTestFails");  // a shock may need steps far below the first
  must(ARKStepSetMaxNumSteps(mem, 1000000), "ARKStepSetMaxNumSteps");
  must(ARKStepSetMaxStep(mem, options.max_step_s), "ARKStepSetMaxStep");

  Trajectory run;
  run.n_sources = static_cast<int>(system.sources.size());
  for (const Flow& f : ode.flows()) run.flow_names.push_back(f.source ? f.source->name : f.exchange->name);
  run.time_s = output_s;
  const auto n_times = static_cast<Eigen::Index>(output_s.size());
  run.outputs.resize(system.outputs.state.cols(), n_times);
  run.heat_J.resize(n_flows, n_times);
  run.stored_J.resize(n_times);
  Eigen::VectorXd m_ones(n);
  multiply(system.mass, system.ones.data(), m_ones.data());
  const double stored_at_start_J = m_ones.dot(start);

  const VectorPtr at_output(N_VNew_Serial(n + n_flows, context.get()));
  Eigen::Index next = 0;
  const auto take_output = [&](double t_s, N_Vector state_vector) {
    const Eigen::VectorXd state = Eigen::Map<const Eigen::VectorXd>(in(state_vector), n);
    run.outputs.col(next) = system.observe(state, hall.at(t_s));
    run.heat_J.col(next) = Eigen::Map<const Eigen::VectorXd>(in(state_vector) + n, n_flows);
    run.stored_J[next] = m_ones.dot(state) - stored_at_start_J;
    ++next;
    if (callback) callback(t_s, state);
  };
  double t_s = 0.0;
  if (next < n_times && output_s[next] <= 0.0) take_output(0.0, y.get());
  for (const LinearStretch& stretch : stretches) {
    if (stretch.drive_changed) {
      ode.set_speed(stretch.drive.speed_rpm);
      check(ARKStepReset(mem, stretch.start_s, y.get()), "ARKStepReset", stretch.start_s, ode);
      check(ARKStepSetInitStep(mem, std::min(5.0, 0.1 * (stretch.end_s - stretch.start_s))), "ARKStepSetInitStep", t_s, ode);
    }
    check(ARKStepSetStopTime(mem, stretch.end_s), "ARKStepSetStopTime", t_s, ode);
    while (t_s < stretch.end_s) {
      check(ARKStepEvolve(mem, stretch.end_s, y.get(), &t_s, ARK_ONE_STEP), "ARKStepEvolve", t_s, ode);
      if (t_s > stretch.end_s - 1e-9 * stretch.end_s) t_s = stretch.end_s;
      while (next < n_times && output_s[next] <= t_s) {
        if (output_s[next] == t_s) {
          take_output(t_s, y.get());
        } else {
          check(ARKStepGetDky(mem, output_s[next], 0, at_output.get()), "ARKStepGetDky", t_s, ode);
          take_output(output_s[next], at_output.get());
        }
      }
    }
  }
  long n_steps = 0;
  ARKStepGetNumSteps(mem, &n_steps);
  run.n_steps = static_cast<int>(n_steps);
  run.n_solves = ode.n_solves();
  run.n_iterations = ode.n_iterations();
  return run;
}

}  // namespace driftwright::solver
