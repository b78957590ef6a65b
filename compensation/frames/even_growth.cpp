#include "compensation/frames/even_growth.hpp"

namespace driftwright::compensation {

std::vector<Eigen::Matrix3Xd> even_growth(std::span<const Eigen::Vector3d> points_m, const EvenAxis& x,
                                          const std::optional<EvenAxis>& y, std::span<const EvenTemperatures> temperatures) {
  std::vector<Eigen::Matrix3Xd> errors;
  for (const EvenTemperatures& T : temperatures) {
    Eigen::Matrix3Xd error_m(3, static_cast<Eigen::Index>(points_m.size()));
    for (std::size_t p = 0; p < points_m.size(); ++p) {
      error_m.col(static_cast<Eigen::Index>(p)) << x.error_m(points_m[p][0], T.table_K, T.scale_x_K),
          y ? y->error_m(points_m[p][1], T.table_K, T.scale_y_K) : 0.0, 0.0;
    }
    errors.push_back(std::move(error_m));
  }
  return errors;
}

}  // namespace driftwright::compensation
