#include "compensation/frames/table_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/dense.hpp"
#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

using Unknowns = Eigen::Matrix<double, 7, 1>;  // scale - 1, shift, shift y, turn, shift z, tilt, scale y - 1

TableFrame of_unknowns(const Unknowns& u) {
  return {.x = {.scale = 1.0 + u[0], .shift_m = u[1]},
          .scale_y = 1.0 + u[6],
          .turn_rad = u[3],
          .tilt_rad = u[5],
          .shift_y_m = u[2],
          .shift_z_m = u[4]};
}

Eigen::VectorXd misfits(std::span<const RingPair> rings, const Unknowns& u) {
  const Frame frame = of_unknowns(u).frame();
  Eigen::VectorXd misfit(3 * static_cast<Eigen::Index>(rings.size()));
  for (std::size_t i = 0; i < rings.size(); ++i)
    misfit.segment<3>(3 * static_cast<Eigen::Index>(i)) = frame.map(*rings[i].before_m) - *rings[i].now_m;
  return misfit;
}

void check_scale(double scale) {
  if (std::abs(scale - 1.0) <= kMostScale) return;
  throw InputError(fmt::format(
      "TEMP_SCALE would be {:.6f}; more than {:g} away from 1 is no temperature (steel: {:.0f} K). Look at the ring "
      "places, the work offset and the probe",
      scale, kMostScale, kMostScale / 11.5e-6));
}

void check_order(double before_m, double now_m) {
  if (!(std::abs(before_m) >= kLeastRingDistance_m)) {
    throw InputError(fmt::format(
        "the rings are identical: {:.3f} mm apart along X; they must be {:g} mm apart or more, best the length of the table",
        1e3 * before_m, 1e3 * kLeastRingDistance_m));
  }
  if (before_m * now_m < 0.0) {
    throw InputError(
        fmt::format("the rings are swapped: the second lay at {:+.3f} mm from the first along X, now at {:+.3f} mm",
                    1e3 * before_m, 1e3 * now_m));
  }
}

}  // namespace

TempFrame temp_frame(double x1_m, double x2_m, double x1_now_m, double x2_now_m) {
  if (!std::isfinite(x1_m + x2_m + x1_now_m + x2_now_m)) throw InputError("a ring is missing: its place is no number");
  check_order(x2_m - x1_m, x2_now_m - x1_now_m);
  const double scale = (x2_now_m - x1_now_m) / (x2_m - x1_m);
  check_scale(scale);
  return {.scale = scale, .shift_m = x1_now_m / scale - x1_m};
}

Frame TableFrame::frame() const {
  const Frame turned = frame_of({.shift_m = {0.0, shift_y_m, shift_z_m}, .rotation_rad = {0.0, tilt_rad, turn_rad}});
  const Frame scaled = frame_of({.scale = {x.scale, scale_y, 1.0}}), shifted = frame_of({.shift_m = {x.shift_m, 0.0, 0.0}});
  return compose(turned, compose(scaled, shifted));
}

bool tells_scale_y(std::span<const RingPair> rings) {
  const auto by_y = [](const RingPair& a, const RingPair& b) { return (*a.before_m)[1] < (*b.before_m)[1]; };
  const auto [front, back] = std::minmax_element(rings.begin(), rings.end(), by_y);
  return rings.size() > 2 && (*back->before_m)[1] - (*front->before_m)[1] >= kLeastRingDistance_m;
}

TableFrame fit_table_frame(std::span<const RingPair> rings) {
  if (rings.size() < 2) throw InputError(fmt::format("a ring is missing: {} given, two are required", rings.size()));
  for (const RingPair& ring : rings) {
    const auto found = [](const std::optional<Eigen::Vector3d>& place) { return place && place->allFinite(); };
    if (!found(ring.before_m)) throw InputError(fmt::format("ring '{}' is missing: it was not measured before", ring.name));
    if (!found(ring.now_m)) throw InputError(fmt::format("ring '{}' is missing: it was not found now", ring.name));
  }
  const auto by_x = [](const RingPair& a, const RingPair& b) { return (*a.before_m)[0] < (*b.before_m)[0]; };
  const auto [first, last] = std::minmax_element(rings.begin(), rings.end(), by_x);
  const double before_m = (*last->before_m)[0] - (*first->before_m)[0], now_m = (*last->now_m)[0] - (*first->now_m)[0];
  check_order(before_m, now_m);
  check_scale(now_m / before_m);
  // Gauss-Newton; the angles are microradians, so each step reduces the misfit to a millionth.
  const int n_unknowns = tells_scale_y(rings) ? 7 : 6;
  Unknowns u = Unknowns::Zero();
  for (int step = 0; step < 4; ++step) {
    const Eigen::VectorXd misfit = misfits(rings, u);
    Eigen::MatrixXd slope(misfit.size(), n_unknowns);
    for (int k = 0; k < n_unknowns; ++k) {
      constexpr double kStep = 1e-4;
      slope.col(k) =
          (misfits(rings, u + kStep * Unknowns::Unit(k)) - misfits(rings, u - kStep * Unknowns::Unit(k))) / (2 * kStep);
    }
    u.head(n_unknowns) -= dense::least_squares(slope, misfit);
  }
  TableFrame table = of_unknowns(u);
  check_scale(table.x.scale);
  const Eigen::VectorXd misfit = misfits(rings, u);
  if (rings.size() > 2) {
    for (Eigen::Index i = 0; i < misfit.size(); i += 3)
      table.misfit_m = std::max(table.misfit_m, misfit.segment<3>(i).norm());
  }
  return table;
}

}  // namespace driftwright::compensation
