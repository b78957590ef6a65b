#pragma once
// A table's error over a shift, with the frame as its correction: rings every k minutes, a thermometer, a model, and mixtures.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "compensation/frames/axis_temperature.hpp"

namespace driftwright::compensation {

/// Position errors (actual - commanded) at points of a table over time, and the points where rings sit among them.
struct TableErrors {
  std::vector<double> time_s;
  std::vector<Eigen::Vector3d> points_m;
  std::vector<Eigen::Matrix3Xd> error_m;  ///< one a time, a column a point
};

/// What is left of the errors with one frame a time.
struct FrameCourse {
  std::vector<TableFrame> frames;
  std::vector<Eigen::Matrix3Xd> left_m;
};

/// @param frames  at the table's times
[[nodiscard]] FrameCourse through_frame(const TableErrors& table, std::vector<TableFrame> frames);

/// The way of every predictor through the frame: errors at ring places, measured or predicted, make the frame of that time.
/// @param rings_m      nominal places, two or more
/// @param ring_error_m one matrix a time of the table, a column a ring: what is believed of the errors there
/// @throws InputError  as fit_table_frame()
[[nodiscard]] FrameCourse through_frame(const TableErrors& table, std::span<const Eigen::Vector3d> rings_m,
                                        const std::vector<Eigen::Matrix3Xd>& ring_error_m);

/// What is believed of the errors at the table's points makes the frame of that time: the one that leaves the least of the largest error.
/// @throws InputError  as fit_minimax_frame()
[[nodiscard]] FrameCourse through_best_frame(const TableErrors& table, const std::vector<Eigen::Matrix3Xd>& believed_m);

/// How rings are measured over a shift.
struct RingPlan {
  double every_s = 10800.0;
  double noise_m = 2e-6;  ///< 1 sigma of a ring's coordinate
  std::uint64_t seed = 1;
};

/// Ring errors as the last measurement found them, at each of the table's times; the first one is made at the first time.
[[nodiscard]] std::vector<Eigen::Matrix3Xd> held_rings(const std::vector<double>& time_s,
                                                       const std::vector<Eigen::Matrix3Xd>& true_ring_error_m,
                                                       const RingPlan& plan);

/// The same carried on by what a model says has changed since.
[[nodiscard]] std::vector<Eigen::Matrix3Xd> carried_rings(const std::vector<double>& time_s,
                                                          const std::vector<Eigen::Matrix3Xd>& true_ring_error_m,
                                                          const std::vector<Eigen::Matrix3Xd>& model_ring_error_m,
                                                          const RingPlan& plan);

/// Errors all over the table as a model has them, mended by what the last measurement of the rings found wrong with it (a frame).
/// through_best_frame() then makes the frame of it.
/// @param model_error_m, model_ring_error_m  at the table's points and at the rings, one matrix a time each
[[nodiscard]] std::vector<Eigen::Matrix3Xd> carried_table(const TableErrors& table, std::span<const Eigen::Vector3d> rings_m,
                                                          const std::vector<Eigen::Matrix3Xd>& true_ring_error_m,
                                                          const std::vector<Eigen::Matrix3Xd>& model_error_m,
                                                          const std::vector<Eigen::Matrix3Xd>& model_ring_error_m,
                                                          const RingPlan& plan);

/// Ring errors as straight lines of one temperature, fitted to what measurements of another time found.
/// @param train_K, train_error_m  at the measurements; at least three that differ
/// @throws InputError  for fewer, or for temperatures that do not differ
[[nodiscard]] std::vector<Eigen::Matrix3Xd> rings_by_temperature(std::span<const double> train_K,
                                                                 std::span<const Eigen::Matrix3Xd> train_error_m,
                                                                 std::span<const double> temperature_K);

/// The control's own compensation from the same measurements: K0 and tan_beta as straight lines of the temperature, P0 = 0.
[[nodiscard]] AxisTemperature fit_axis_temperature(std::span<const double> train_K,
                                                   std::span<const Eigen::Matrix3Xd> train_error_m,
                                                   std::span<const Eigen::Vector3d> rings_m);

/// Largest errors of a course over time and table [m].
struct PeakErrors {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, position_m = 0.0;  ///< position: the length of the vector
};
[[nodiscard]] PeakErrors peaks(const std::vector<Eigen::Matrix3Xd>& error_m);

}  // namespace driftwright::compensation
