#pragma once
// Errors of a table from three thermometers: what it would do if table and scales were each evenly warm.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace driftwright::compensation {

/// A table that is free to grow from where it is held, along an axis with a linear scale.
struct EvenAxis {
  double table_1_K = 0.0, scale_1_K = 0.0;
  double held_at_m = 0.0;   ///< the table
  double fixed_at_m = 0.0;  ///< the scale
  /// @param table_K, scale_K  above the temperature at which both have their length
  [[nodiscard]] double error_m(double at_m, double table_K, double scale_K) const {
    return table_1_K * table_K * (at_m - held_at_m) - scale_1_K * scale_K * (at_m - fixed_at_m);
  }
};

/// What the thermometers of table and scales say at one time [K above the reference]; `scale_y_K` is used with a scale of Y alone.
struct EvenTemperatures {
  double table_K = 0.0, scale_x_K = 0.0, scale_y_K = 0.0;
};

/// Errors (actual - commanded) at points of the table, one matrix a time. Along Z nothing is claimed: 0. A Y without scale: 0, too.
[[nodiscard]] std::vector<Eigen::Matrix3Xd> even_growth(std::span<const Eigen::Vector3d> points_m, const EvenAxis& x,
                                                        const std::optional<EvenAxis>& y,
                                                        std::span<const EvenTemperatures> temperatures);

}  // namespace driftwright::compensation
