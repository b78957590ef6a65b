#pragma once
// Errors of a table from three thermometers, if table and scales each have a uniform temperature.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace driftwright::compensation {

/// A table that grows freely from the point where it is held, along an axis with a linear scale.
struct EvenAxis {
  double table_1_K = 0.0, scale_1_K = 0.0;
  double held_at_m = 0.0;   ///< fixed point of the table
  double fixed_at_m = 0.0;  ///< fixed point of the scale
  /// @param table_K, scale_K  above the temperature at which both have their length
  [[nodiscard]] double error_m(double at_m, double table_K, double scale_K) const {
    return table_1_K * table_K * (at_m - held_at_m) - scale_1_K * scale_K * (at_m - fixed_at_m);
  }
};

/// Readings of the thermometers of table and scales at one time [K above the reference]; `scale_y_K` is used only if Y has a
/// scale.
struct EvenTemperatures {
  double table_K = 0.0, scale_x_K = 0.0, scale_y_K = 0.0;
};

/// Errors (actual - commanded) at points of the table, one matrix per time. Errors along Z, and along Y without a scale, are
/// 0: not modelled.
[[nodiscard]] std::vector<Eigen::Matrix3Xd> even_growth(std::span<const Eigen::Vector3d> points_m, const EvenAxis& x,
                                                        const std::optional<EvenAxis>& y,
                                                        std::span<const EvenTemperatures> temperatures);

}  // namespace driftwright::compensation
