#include "compensation/frames/table_shift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "compensation/frames/minimax_frame.hpp"

namespace driftwright::compensation {
namespace {

/// Intercept and slope of values over x.
struct Line {
  double mean_x = 0.0, mean = 0.0, slope = 0.0;
  [[nodiscard]] double at(double x) const { return mean + slope * (x - mean_x); }
};

Line fit_line(std::span<const double> x, const std::vector<double>& values) {
  Line line;
  const auto n = static_cast<double>(x.size());
  if (x.size() < 3)
    throw InputError(fmt::format("a line over temperature requires three measurements; there are {}", x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    line.mean_x += x[i] / n;
    line.mean += values[i] / n;
  }
  double xx = 0.0, xv = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - line.mean_x) * (x[i] - line.mean_x);
    xv += (x[i] - line.mean_x) * (values[i] - line.mean);
  }
  if (!(xx > 1e-6)) throw InputError("a line over temperature requires temperatures that differ; all of training are alike");
  line.slope = xv / xx;
  return line;
}

std::vector<RingPair> pairs(std::span<const Eigen::Vector3d> places_m, const Eigen::Matrix3Xd& error_m) {
  std::vector<RingPair> rings;
  for (std::size_t r = 0; r < places_m.size(); ++r)
    rings.push_back({fmt::format("{}", r + 1), places_m[r], places_m[r] + error_m.col(static_cast<Eigen::Index>(r))});
  return rings;
}

TableFrame frame_of_rings(std::span<const Eigen::Vector3d> rings_m, const Eigen::Matrix3Xd& error_m) {
  return fit_table_frame(pairs(rings_m, error_m));
}

}  // namespace

FrameCourse through_frame(const TableErrors& table, std::vector<TableFrame> frames) {
  FrameCourse course;
  for (std::size_t i = 0; i < table.time_s.size(); ++i) {
    const Frame frame = frames[i].frame();
    Eigen::Matrix3Xd left_m = table.error_m[i];
    for (std::size_t p = 0; p < table.points_m.size(); ++p)
      left_m.col(static_cast<Eigen::Index>(p)) -= frame.map(table.points_m[p]) - table.points_m[p];
    course.left_m.push_back(std::move(left_m));
  }
  course.frames = std::move(frames);
  return course;
}

FrameCourse through_frame(const TableErrors& table, std::span<const Eigen::Vector3d> rings_m,
                          const std::vector<Eigen::Matrix3Xd>& ring_error_m) {
  std::vector<TableFrame> frames;
  for (const Eigen::Matrix3Xd& error_m : ring_error_m) frames.push_back(frame_of_rings(rings_m, error_m));
  return through_frame(table, std::move(frames));
}

FrameCourse through_best_frame(const TableErrors& table, const std::vector<Eigen::Matrix3Xd>& believed_m) {
  std::vector<TableFrame> frames;
  for (const Eigen::Matrix3Xd& error_m : believed_m)
    frames.push_back(fit_minimax_frame(pairs(table.points_m, error_m)).frame);
  return through_frame(table, std::move(frames));
}

std::vector<Eigen::Matrix3Xd> held_rings(const std::vector<double>& time_s,
                                         const std::vector<Eigen::Matrix3Xd>& true_ring_error_m, const RingPlan& plan) {
  const std::vector<Eigen::Matrix3Xd> nothing(time_s.size(), Eigen::Matrix3Xd::Zero(3, true_ring_error_m.front().cols()));
  return carried_rings(time_s, true_ring_error_m, nothing, plan);
}

std::vector<Eigen::Matrix3Xd> carried_rings(const std::vector<double>& time_s,
                                            const std::vector<Eigen::Matrix3Xd>& true_ring_error_m,
                                            const std::vector<Eigen::Matrix3Xd>& model_ring_error_m, const RingPlan& plan) {
  Random random(plan.seed, 3);
  std::vector<Eigen::Matrix3Xd> believed;
  Eigen::Matrix3Xd measured_less_model_m;
  double next_s = time_s.front();
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (time_s[i] >= next_s - 1e-6) {
      Eigen::Matrix3Xd measured_m = true_ring_error_m[i];
      for (double& value : measured_m.reshaped()) value += plan.noise_m * random.normal();
      measured_less_model_m = measured_m - model_ring_error_m[i];
      while (next_s <= time_s[i] + 1e-6) next_s += plan.every_s;
    }
    believed.emplace_back(measured_less_model_m + model_ring_error_m[i]);
  }
  return believed;
}

std::vector<Eigen::Matrix3Xd> carried_table(const TableErrors& table, std::span<const Eigen::Vector3d> rings_m,
                                            const std::vector<Eigen::Matrix3Xd>& true_ring_error_m,
                                            const std::vector<Eigen::Matrix3Xd>& model_error_m,
                                            const std::vector<Eigen::Matrix3Xd>& model_ring_error_m, const RingPlan& plan) {
  const auto rings = carried_rings(table.time_s, true_ring_error_m, model_ring_error_m, plan);
  std::vector<Eigen::Matrix3Xd> believed;
  for (std::size_t i = 0; i < table.time_s.size(); ++i) {
    const Frame mend = frame_of_rings(rings_m, rings[i] - model_ring_error_m[i]).frame();
    Eigen::Matrix3Xd error_m = model_error_m[i];
    for (std::size_t p = 0; p < table.points_m.size(); ++p)
      error_m.col(static_cast<Eigen::Index>(p)) += mend.map(table.points_m[p]) - table.points_m[p];
    believed.push_back(std::move(error_m));
  }
  return believed;
}

std::vector<Eigen::Matrix3Xd> rings_by_temperature(std::span<const double> train_K,
                                                   std::span<const Eigen::Matrix3Xd> train_error_m,
                                                   std::span<const double> temperature_K) {
  const Eigen::Index n_rings = train_error_m.empty() ? 0 : train_error_m.front().cols();
  std::vector<Eigen::Matrix3Xd> believed(temperature_K.size(), Eigen::Matrix3Xd(3, n_rings));
  for (Eigen::Index k = 0; k < 3 * n_rings; ++k) {
    std::vector<double> values;
    for (const Eigen::Matrix3Xd& error_m : train_error_m) values.push_back(error_m.reshaped()[k]);
    const Line line = fit_line(train_K, values);
    for (std::size_t i = 0; i < temperature_K.size(); ++i) believed[i].reshaped()[k] = line.at(temperature_K[i]);
  }
  return believed;
}

AxisTemperature fit_axis_temperature(std::span<const double> train_K, std::span<const Eigen::Matrix3Xd> train_error_m,
                                     std::span<const Eigen::Vector3d> rings_m) {
  std::vector<double> slopes, absolutes_m;
  for (const Eigen::Matrix3Xd& error_m : train_error_m) {
    const TempFrame x = frame_of_rings(rings_m, error_m).x;
    slopes.push_back(x.scale - 1.0);
    absolutes_m.push_back(x.scale * x.shift_m);
  }
  const Line slope = fit_line(train_K, slopes), absolute = fit_line(train_K, absolutes_m);
  // tan_beta is zero at T0. If the errors do not depend on the temperature there is no such T0, and the mean of the training
  // data is used
  const double zero_K = slope.slope != 0.0 ? slope.mean_x - slope.mean / slope.slope : slope.mean_x;
  return {.reference_K = zero_K, .k0_m = absolute.at(zero_K), .k0_m_K = absolute.slope, .slope_1_K = slope.slope};
}

PeakErrors peaks(const std::vector<Eigen::Matrix3Xd>& error_m) {
  PeakErrors peak;
  for (const Eigen::Matrix3Xd& e : error_m) {
    peak.x_m = std::max(peak.x_m, e.row(0).cwiseAbs().maxCoeff());
    peak.y_m = std::max(peak.y_m, e.row(1).cwiseAbs().maxCoeff());
    peak.z_m = std::max(peak.z_m, e.row(2).cwiseAbs().maxCoeff());
    peak.position_m = std::max(peak.position_m, e.colwise().norm().maxCoeff());
  }
  return peak;
}

}  // namespace driftwright::compensation
