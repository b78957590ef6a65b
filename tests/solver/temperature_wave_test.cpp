// Waves of temperature in a half space against the exact complex solution.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "solver/heat_assembly.hpp"
#include "tests/shared/heat_runs.hpp"

namespace driftwright::solver::temperature_wave_test {
namespace {

using fixtures::text;
using mesh::CellShape;
using std::numbers::pi;

TEST(PeriodicHalfSpace, AmplitudeAndPhaseFallWithDepthAsTheComplexWave) {
  // Surface 10 K sin(w t), one hour a period: T = 10 K exp(-x/d) sin(w t - x/d), d = sqrt(2 a / w) = 107 mm. A bar of 8 d,
  // insulated at its end, differs from the half space by 2 exp(-2 (8 - 3)) = 1e-4 of the amplitude at the deepest point; its
  // exact wave is Im[cosh(q (L - x)) / cosh(q L) exp(i w t)], q = (1 + i) / d. The bar starts on that wave: from rest its
  // slowest mode would take 8 periods to fall by e.
  constexpr double kPeriod_s = 3600.0, kAmplitude_K = 10.0;
  constexpr int kPeriods = 3, kKnots = 200, kSamples = 40;
  const Material steel = fixtures::steel();
  const double diffusivity_m2_s = steel.conductivity_W_mK / (steel.density_kg_m3 * steel.heat_capacity_J_kgK);
  const double w = 2 * pi / kPeriod_s, d_m = std::sqrt(2 * diffusivity_m2_s / w), length_m = 8 * d_m;
  for (CellShape shape : {CellShape::kTet10, CellShape::kHex20}) {
    const int n = 40;
    const mesh::Mesh mesh =
        fixtures::box_mesh({.size_m = {length_m, length_m / n, length_m / n}, .n = {n, 1, 1}, .shape = shape});
    effects::HeatBalance balance;
    TimeSeries sine_K;
    for (int i = 0; i <= kPeriods * kKnots; ++i) {
      sine_K.time_s.push_back(kPeriod_s * i / kKnots);
      sine_K.value.push_back(293.15 + kAmplitude_K * std::sin(2 * pi * i / kKnots));
    }
    balance.fixed.push_back({"wave", effects::surface("x0"), sine_K, false});
    FullSystem system = assemble_heat(mesh, {steel}, balance);
    std::vector<int> nodes;
    for (double depth : {1.0, 2.0, 3.0}) nodes.push_back(fixtures::node_at(mesh, {depth * d_m, 0, 0}));
    fixtures::observe_unknowns(system, nodes);
    std::vector<double> times_s;
    for (int i = 0; i < kSamples; ++i) times_s.push_back(kPeriod_s * (kPeriods - 1 + (i + 1.0) / kSamples));
    // Straight lines between the knots carry (sin(pi/N) / (pi/N))^2 of the sine; their harmonics die within a cell or two.
    const double chord = pi / kKnots, carried = std::pow(std::sin(chord) / chord, 2);
    const std::complex<double> q = std::complex<double>(1, 1) / d_m;
    const auto bar = [&](double x_m) {
      return carried * kAmplitude_K * std::cosh(q * (length_m - x_m)) / std::cosh(q * length_m);
    };
    const Eigen::VectorXd start = fixtures::at_nodes(mesh, [&](const Eigen::Vector3d& x) { return bar(x[0]).imag(); });
    const Trajectory run = fixtures::run_at_rest(system, times_s, 1e-6, start);
    for (int i = 0; i < 3; ++i) {
      std::complex<double> measured = 0.0;
      for (int j = 0; j < kSamples; ++j) {
        measured += run.outputs(i, j) * std::polar(1.0, -w * times_s[j]) * std::complex<double>(0, 2.0 / kSamples);
      }
      const double x_m = mesh.coords(0, nodes[i]);
      const std::string at = fixtures::name_of(shape) + "_" + std::to_string(i + 1) + "d";
      const double amplitude_error = std::abs(measured / bar(x_m)) - 1.0, phase_error = std::arg(measured / bar(x_m));
      RecordProperty("amplitude_K_" + at, text(std::abs(measured)));
      RecordProperty("amplitude_error_" + at, text(amplitude_error));
      RecordProperty("phase_error_rad_" + at, text(phase_error));
      EXPECT_NEAR(amplitude_error, 0.0, 1e-3) << at;
      EXPECT_NEAR(phase_error, 0.0, 1e-3) << at;
      EXPECT_NEAR(std::abs(measured), kAmplitude_K * std::exp(-x_m / d_m), 1e-3 * kAmplitude_K) << at;
    }
  }
}

}  // namespace
}  // namespace driftwright::solver::temperature_wave_test
