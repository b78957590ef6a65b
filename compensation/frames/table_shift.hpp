#pragma once
// A table's error over a work shift, corrected by the frame: from rings every k minutes, a thermometer, a model, and
// combinations.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "compensation/frames/axis_temperature.hpp"

namespace driftwright::compensation {

/// Position errors (actual - commanded) at points of a table over time.
struct TableErrors {
  std::vector<double> time_s;
  std::vector<Eigen::Vector3d> points_m;
  std::vector<Eigen::Matrix3Xd> error_m;  ///< one per time; one column per point
};

/// The frame at each time, and the errors that remain with it.
struct FrameCourse {
  std::vector<TableFrame> frames;
  std::vector<Eigen::Matrix3Xd> left_m;
};

/// Applies given frames. @param frames  at the table's times
[[nodiscard]] FrameCourse through_frame(const TableErrors& table, std::vector<TableFrame> frames);

/// Applies the frames that follow from errors at ring positions, measured or predicted.
/// @param rings_m      nominal positions, two or more
/// @param ring_error_m one matrix per time of the table, one column per ring: the assumed errors there
/// @throws InputError  as fit_table_frame()
[[nodiscard]] FrameCourse through_frame(const TableErrors& table, std::span<const Eigen::Vector3d> rings_m,
                                        const std::vector<Eigen::Matrix3Xd>& ring_error_m);

/// Applies the frames that follow from assumed errors at the table's points: at each time the one with the smallest largest
/// error.
/// @throws InputError  as fit_minimax_frame()
[[nodiscard]] FrameCourse through_best_frame(const TableErrors& table, const std::vector<Eigen::Matrix3Xd>& believed_m);

/// How rings are measured over a shift.
struct RingPlan {
  double every_s = 10800.0;
  double noise_m = 2e-6;  ///< 1 sigma of a ring's coordinate
  std::uint64_t seed = 1;
};

/// Ring errors of the last measurement, at each of the table's times; the first measurement is at the first time.
[[nodiscard]] std::vector<Eigen::Matrix3Xd> held_rings(const std::vector<double>& time_s,
                                                       const std::vector<Eigen::Matrix3Xd>& true_ring_error_m,
                                                       const RingPlan& plan);

/// The same plus the change that a model predicts since the last measurement.
[[nodiscard]] std::vector<Eigen::Matrix3Xd> carried_rings(const std::vector<double>& time_s,
                                                          const std::vector<Eigen::Matrix3Xd>& true_ring_error_m,
                                                          const std::vector<Eigen::Matrix3Xd>& model_ring_error_m,
                                                          const RingPlan& plan);

/// A model's errors over the whole table, corrected by a frame fitted to its errors at the last measurement of the rings.
/// Use the result with through_best_frame().
/// @param model_error_m, model_ring_error_m  at the table's points and at the rings, one matrix per time each
[[nodiscard]] std::vector<Eigen::Matrix3Xd> carried_table(const TableErrors& table, std::span<const Eigen::Vector3d> rings_m,
                                                          const std::vector<Eigen::Matrix3Xd>& true_ring_error_m,
                                                          const std::vector<Eigen::Matrix3Xd>& model_error_m,
                                                          const std::vector<Eigen::Matrix3Xd>& model_ring_error_m,
                                                          const RingPlan& plan);

/// Ring errors as linear functions of one temperature, fitted to measurements from another time.
/// @param train_K, train_error_m  at the measurements; at least three different temperatures
/// @throws InputError  for fewer, or for temperatures that do not differ
[[nodiscard]] std::vector<Eigen::Matrix3Xd> rings_by_temperature(std::span<const double> train_K,
                                                                 std::span<const Eigen::Matrix3Xd> train_error_m,
                                                                 std::span<const double> temperature_K);

/// The control's built-in compensation from the same measurements: K0 and tan_beta as linear functions of the temperature,
/// P0 = 0.
[[nodiscard]] AxisTemperature fit_axis_temperature(std::span<const double> train_K,
                                                   std::span<const Eigen::Matrix3Xd> train_error_m,
                                                   std::span<const Eigen::Vector3d> rings_m);

/// Largest errors over time and table [m].
struct PeakErrors {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, position_m = 0.0;  ///< position: the length of the vector
};
[[nodiscard]] PeakErrors peaks(const std::vector<Eigen::Matrix3Xd>& error_m);

}  // namespace driftwright::compensation
