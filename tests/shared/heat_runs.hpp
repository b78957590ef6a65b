#pragma once
// Short forms that verification tests share: entries of a heat balance, runs, and every shape of cell.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "effects/heat_balance.hpp"
#include "solver/steady_state.hpp"
#include "solver/transient.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::fixtures {

inline constexpr std::array kLinearShapes = {mesh::CellShape::kTet4, mesh::CellShape::kHex8, mesh::CellShape::kWedge6};
inline constexpr std::array kQuadraticShapes = {mesh::CellShape::kTet10, mesh::CellShape::kHex20, mesh::CellShape::kWedge15};
inline constexpr std::array kAllShapes = {mesh::CellShape::kTet4,  mesh::CellShape::kHex8,  mesh::CellShape::kWedge6,
                                          mesh::CellShape::kTet10, mesh::CellShape::kHex20, mesh::CellShape::kWedge15};

[[nodiscard]] inline std::string name_of(mesh::CellShape shape) {
  switch (shape) {
    case mesh::CellShape::kTet4:
      return "Tet4";
    case mesh::CellShape::kTet10:
      return "Tet10";
    case mesh::CellShape::kHex8:
      return "Hex8";
    case mesh::CellShape::kHex20:
      return "Hex20";
    case mesh::CellShape::kWedge6:
      return "Wedge6";
    case mesh::CellShape::kWedge15:
      return "Wedge15";
    default:
      return "facet";
  }
}

[[nodiscard]] inline effects::Exchange film(const std::string& surface, double htc_W_m2K,
                                            const std::string& surrounding = effects::kAmbientName) {
  return effects::make_film("film " + surface, surface, constant(htc_W_m2K), surrounding);
}

/// A surface or node at a constant absolute temperature.
[[nodiscard]] inline effects::FixedTemperature fixed_at(effects::Body body, double temperature_K) {
  const std::string name = "fixed " + body.name;
  return {name, std::move(body), {{0.0}, {temperature_K}}, false};
}

/// An ambient that is constant at `theta_K` above the reference temperature.
[[nodiscard]] inline TimeSeries still_ambient(double theta_K = 0.0) {
  return {{0.0}, {theta_K}};
}

/// A run at standstill with equal relative and absolute (times 1 K) tolerance.
[[nodiscard]] inline solver::Trajectory run_at_rest(const solver::FullSystem& system, const std::vector<double>& output_s,
                                                    double tolerance, const Eigen::VectorXd& start,
                                                    const TimeSeries& ambient = still_ambient()) {
  const solver::TransientOptions options{
      .relative_tolerance = tolerance, .absolute_tolerance_K = tolerance, .max_step_s = output_s.back()};
  const Cyclogram rest{.name = "rest", .sections = {{output_s.back(), {}}}};
  return solver::simulate(system, rest, ambient, output_s, options, start);
}

/// "1.234e-05", for RecordProperty and messages.
[[nodiscard]] inline std::string text(double value, int digits = 6) {
  std::array<char, 64> buffer{};
  (void)std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
  return buffer.data();
}

}  // namespace driftwright::fixtures
