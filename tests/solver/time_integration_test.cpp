// The integrator against exact solutions in time: how its error follows the tolerance, for linear and nonlinear systems, and
// how well heat balances at the tolerances of the shipped machine (scenarios/fp3_spindle.yaml).

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "solver/heat_assembly.hpp"
#include "tests/shared/heat_runs.hpp"

namespace driftwright::solver::time_integration_test {
namespace {

using fixtures::constant, fixtures::film, fixtures::fixed_at, fixtures::text;
using mesh::CellShape;

constexpr double kKelvin = 293.15;
const std::vector<double> kTolerances = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

/// Runs `error_K(tolerance)` for all tolerances: the error stays below `factor` x tolerance x (1 K + the largest |θ|), what
/// one step may err by, and falls by three decades when the tolerance falls by four.
template <class Error>
void expect_error_follows_tolerance(Error error_K, double largest_K, double factor) {
  std::vector<double> errors;
  for (double tolerance : kTolerances) {
    const double error = error_K(tolerance);
    ::testing::Test::RecordProperty("error_K_at_" + text(tolerance), text(error));
    ::testing::Test::RecordProperty("factor_at_" + text(tolerance), text(error / (tolerance * (1.0 + largest_K)), 3));
    EXPECT_LT(error, factor * tolerance * (1.0 + largest_K)) << "tolerance " << tolerance;
    errors.push_back(error);
  }
  EXPECT_LT(errors.back(), 1e-3 * errors.front());
}

TransientOptions options_of(double tolerance, double max_step_s) {
  return {.relative_tolerance = tolerance, .absolute_tolerance_K = tolerance, .max_step_s = max_step_s};
}

// --- linear -----------------------------------------------------------------------------------------------------

/// A bar with one end on a ramp of temperature, heat in pulses, a film to an ambient that bends: M θ' = -K θ + f0 + f1 t
/// in each piece of time for the free unknowns. Its exact solution by the eigenmodes of (K, M), independent of the
/// integrator.
class PiecewiseLinearBar {
 public:
  PiecewiseLinearBar() {
    effects::HeatBalance balance;
    balance.heats.push_back(
        {"pulses", effects::region("body"), [](const effects::Inputs& u) { return 0.05 * u.drive.speed_rpm; }});
    balance.exchanges.push_back(film("x1", 100.0));
    balance.fixed.push_back(
        {"ramp", effects::surface("x0"), {{0, 1000, 3000, 4000}, {293.15, 303.15, 303.15, 288.15}}, false});
    system = assemble_heat(mesh, {fixtures::steel()}, balance);
    std::vector<char> is_fixed(system.size(), 0);
    for (int i : system.fixed.front().unknowns) is_fixed[i] = 1;
    for (int i = 0; i < system.size(); ++i) {
      if (!is_fixed[i]) free.push_back(i);
    }
    fixtures::observe_unknowns(system, free);
    k_ = Eigen::MatrixXd(fixtures::stiffness(system));
    m_ = Eigen::MatrixXd(system.mass);
    const Eigen::MatrixXd k_free = k_(free, free), m_free = m_(free, free);
    modes_.compute(k_free, m_free);
  }

  /// Free unknowns at the ends of `times_s`, which include all ends of pieces.
  [[nodiscard]] std::vector<Eigen::VectorXd> exact(const std::vector<double>& times_s) const {
    std::vector<Eigen::VectorXd> at;
    Eigen::VectorXd a = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free.size()));  // amplitudes of modes
    double from_s = 0.0;
    for (double to_s : times_s) {
      const Eigen::VectorXd f_from = modal_load(from_s, from_s, to_s), f_to = modal_load(to_s, from_s, to_s);
      const double dt_s = to_s - from_s;
      for (Eigen::Index i = 0; i < a.size(); ++i) {  // a' = -r a + f, f linear in time
        const double r = modes_.eigenvalues()[i], slope = (f_to[i] - f_from[i]) / dt_s;
        const double particular_from = f_from[i] / r - slope / (r * r), particular_to = f_to[i] / r - slope / (r * r);
        a[i] = particular_to + (a[i] - particular_from) * std::exp(-r * dt_s);
      }
      at.push_back(modes_.eigenvectors() * a);
      from_s = to_s;
    }
    return at;
  }

  mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.2, 0.05, 0.05}, .n = {6, 1, 1}});
  FullSystem system;
  std::vector<int> free;
  Cyclogram cycle{.name = "pulses",
                  .sections = {{600, {.speed_rpm = 2000}}, {900, {}}, {30, {.speed_rpm = 3000}}, {2470, {}}}};
  TimeSeries ambient{{0, 2000, 4000}, {0.0, 4.0, -2.0}};

 private:
  [[nodiscard]] Eigen::VectorXd modal_load(double t_s, double from_s, double to_s) const {
    const TimeSeries& ramp = system.fixed.front().theta;
    const double middle_s = 0.5 * (from_s + to_s), slope_K_s = (ramp.at(to_s) - ramp.at(from_s)) / (to_s - from_s);
    Eigen::VectorXd held = Eigen::VectorXd::Zero(system.size()), rising = held;
    for (int i : system.fixed.front().unknowns) {
      held[i] = ramp.at(t_s);
      rising[i] = slope_K_s;
    }
    const Eigen::VectorXd f =
        system.load({.drive = cycle.drive(middle_s), .ambient_K = ambient.at(t_s)}) - k_ * held - m_ * rising;
    return modes_.eigenvectors().transpose() * f(free);
  }

  Eigen::MatrixXd k_, m_;
  Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes_;
};

TEST(LinearSystem, ErrorFollowsTheToleranceUnderRampsPulsesAndPrescribedTemperatures) {
  const PiecewiseLinearBar bar;
  const std::vector<double> times_s = {600, 1000, 1500, 1515, 1530, 2000, 3000, 3500, 4000};
  const std::vector<Eigen::VectorXd> exact = bar.exact(times_s);
  double largest_K = 0.0;
  for (const Eigen::VectorXd& e : exact) largest_K = std::max(largest_K, e.cwiseAbs().maxCoeff());
  ASSERT_GT(largest_K, 10.0);
  RecordProperty("largest_K", text(largest_K));
  const auto error_K = [&](double tolerance) {
    const Trajectory run = simulate(bar.system, bar.cycle, bar.ambient, times_s, options_of(tolerance, 2000.0),
                                    Eigen::VectorXd::Zero(bar.system.size()));
    double worst_K = 0.0;
    for (std::size_t k = 0; k < times_s.size(); ++k) {
      worst_K = std::max(worst_K, (run.outputs.col(static_cast<Eigen::Index>(k)) - exact[k]).cwiseAbs().maxCoeff());
    }
    return worst_K;
  };
  // The tolerance is that of each step; those after a jump add up to no more than one.
  expect_error_follows_tolerance(error_K, largest_K, 1.0);
}

TEST(LinearSystem, ErrorOfAnEigenmodeFollowsTheTolerance) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.2, 0.05, 0.05}, .n = {6, 1, 1}});
  effects::HeatBalance balance;
  balance.exchanges.push_back(film("x1", 200.0));
  FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(fixtures::stiffness(system)),
                                                                        Eigen::MatrixXd(system.mass));
  const Eigen::VectorXd mode = 20.0 * eigen.eigenvectors().col(0) / eigen.eigenvectors().col(0).cwiseAbs().maxCoeff();
  const double rate_1_s = eigen.eigenvalues()[0];
  std::vector<int> all(system.size());
  for (int i = 0; i < system.size(); ++i) all[i] = i;
  fixtures::observe_unknowns(system, all);
  const std::vector<double> times_s = {0.1 / rate_1_s, 0.5 / rate_1_s, 1.0 / rate_1_s, 2.0 / rate_1_s, 4.0 / rate_1_s};
  const auto error_K = [&](double tolerance) {
    const Trajectory run = fixtures::run_at_rest(system, times_s, tolerance, mode);
    double worst_K = 0.0;
    for (std::size_t k = 0; k < times_s.size(); ++k) {
      const Eigen::VectorXd exact = std::exp(-rate_1_s * times_s[k]) * mode;
      worst_K = std::max(worst_K, (run.outputs.col(static_cast<Eigen::Index>(k)) - exact).cwiseAbs().maxCoeff());
    }
    return worst_K;
  };
  expect_error_follows_tolerance(error_K, 20.0, 1.0);
}

// --- nonlinear: lumps in closed form ----------------------------------------------------------------------------

/// A lumped node of 500 J/K that sees 0.01 m^2 of a body held at `body_K`; the node is exactly a lump.
FullSystem radiating_lump(double body_K) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}});
  effects::HeatBalance balance;
  balance.nodes.push_back({"lump", 500.0});
  balance.fixed.push_back(fixed_at(effects::region("body"), body_K));
  balance.radiations.push_back({"radiation", "x1", 0.9, "lump"});
  FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  fixtures::observe_unknowns(system, {mesh.n_nodes()});
  return system;
}

/// T at time t of C T' = -s (T^4 - S^4): s t / C = F(T) - F(T_0), F' = -1 / (T^4 - S^4); by bisection.
double radiating_lump_K(double t_s, double start_K, double body_K) {
  const double strength_W_K4 = 0.9 * 5.670374419e-8 * 0.01, capacity_J_K = 500.0;
  const auto antiderivative = [&](double t_K) {  // of -1 / (T^4 - S^4), for T > S
    const double s = body_K;
    return (std::log((t_K + s) / (t_K - s)) + 2.0 * std::atan(t_K / s)) / (4.0 * s * s * s);
  };
  double low = body_K * (1.0 + 1e-15), high = start_K;
  for (int i = 0; i < 200; ++i) {
    const double t_K = 0.5 * (low + high);
    const double needed_s = capacity_J_K / strength_W_K4 * (antiderivative(t_K) - antiderivative(start_K));
    (needed_s > t_s ? low : high) = t_K;
  }
  return high;
}

TEST(NonlinearSystem, RadiatingLumpFollowsTheToleranceAgainstItsClosedForm) {
  const double start_K = 1000.0, body_K = 300.0;
  FullSystem system = radiating_lump(body_K);
  Eigen::VectorXd start = Eigen::VectorXd::Constant(system.size(), body_K - kKelvin);
  start[system.size() - 1] = start_K - kKelvin;
  const std::vector<double> times_s = {10, 100, 500, 2000, 10000, 40000};
  const auto error_K = [&](double tolerance) {
    const Trajectory run = fixtures::run_at_rest(system, times_s, tolerance, start);
    double worst_K = 0.0;
    for (std::size_t k = 0; k < times_s.size(); ++k) {
      const double exact_K = radiating_lump_K(times_s[k], start_K, body_K) - kKelvin;
      worst_K = std::max(worst_K, std::abs(run.outputs(0, static_cast<Eigen::Index>(k)) - exact_K));
    }
    return worst_K;
  };
  // More adds up here than in a linear system; tighter Newton iterations would not change that.
  expect_error_follows_tolerance(error_K, start_K - kKelvin, 3.0);
}

TEST(NonlinearSystem, FrictionThatThinsWithHeatFollowsTheToleranceAgainstItsClosedForm) {
  // P = P0 exp(-b (T - T0)) into an insulated lump, as of a bearing whose oil thins: exp(b (T - T0)) = 1 + b P0 t / C.
  constexpr double kPower_W = 200.0, kThinning_1_K = 0.05, kCapacity_J_K = 2000.0;
  effects::HeatBalance balance;
  balance.nodes.push_back({"lump", kCapacity_J_K});
  const auto friction = [](const effects::Inputs& u) {
    return kPower_W * std::exp(-kThinning_1_K * (u.probe_K[0] - kKelvin));
  };
  balance.heats.push_back({"friction", effects::node("lump"), effects::Law(friction, {effects::node("lump")})});
  FullSystem system = assemble_heat({}, {}, balance);
  fixtures::observe_unknowns(system, {0});
  const std::vector<double> times_s = {10, 100, 1000, 5000, 20000};
  const auto exact_K = [](double t_s) { return std::log1p(kThinning_1_K * kPower_W * t_s / kCapacity_J_K) / kThinning_1_K; };
  const auto error_K = [&](double tolerance) {
    const Trajectory run = fixtures::run_at_rest(system, times_s, tolerance, Eigen::VectorXd::Zero(1));
    double worst_K = 0.0;
    for (std::size_t k = 0; k < times_s.size(); ++k) {
      worst_K = std::max(worst_K, std::abs(run.outputs(0, static_cast<Eigen::Index>(k)) - exact_K(times_s[k])));
    }
    return worst_K;
  };
  RecordProperty("largest_K", text(exact_K(20000)));
  expect_error_follows_tolerance(error_K, exact_K(20000), 1.0);
}

}  // namespace
}  // namespace driftwright::solver::time_integration_test
