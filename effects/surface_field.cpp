#include "effects/surface_field.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace driftwright::effects {

double SurfaceField::area_m2(int cell) const {
  const auto c = static_cast<std::size_t>(cell);
  const Eigen::Index first = corner_from[c], end = corner_from[c + 1];
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (Eigen::Index i = first + 1; i + 1 < end; ++i) {
    const Eigen::Vector3d a = corner_m.col(i) - corner_m.col(first), b = corner_m.col(i + 1) - corner_m.col(first);
    twice += a.cross(b);
  }
  return 0.5 * twice.norm();
}

double SurfaceField::film_W_K(int state) const {
  if (!has_cells()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (int c = 0; c < n_values(); ++c) sum += area_m2(c) * film_W_m2K(c, state);
  return sum;
}

void set_means(SurfaceField& field) {
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(field.n_values());
  if (field.has_cells()) {
    for (int c = 0; c < field.n_values(); ++c) weight[c] = field.area_m2(c);
  }
  const double sum = weight.sum();
  field.states.mean_film_W_m2K.clear();
  double film = 0.0, film_air = 0.0;
  for (Eigen::Index s = 0; s < field.film_W_m2K.cols(); ++s) {
    const double weighted = weight.dot(field.film_W_m2K.col(s));
    field.states.mean_film_W_m2K.push_back(weighted / sum);
    if (field.air_K.size() == 0) continue;
    film += weighted;
    film_air += weight.dot(field.film_W_m2K.col(s).cwiseProduct(field.air_K.col(s)));
  }
  if (field.air_K.size() == 0) return;
  field.states.air_K = film > 0.0 ? film_air / film : field.air_K.mean();
}

double FieldPart::film_W_m2K(int value) const {
  if (to == kUncovered) return value < 0 ? 1.0 : 0.0;
  if (value < 0) return 0.0;
  return field->film_W_m2K(value, to) - (from == kNone ? 0.0 : field->film_W_m2K(value, from));
}

double FieldPart::film_times_air_W_m2(int value) const {
  if (to == kUncovered || value < 0) return 0.0;
  if (field->air_K.size() == 0) return std::isnan(even_air_K) ? 0.0 : even_air_K * film_W_m2K(value);
  const auto at = [&](int state) { return field->film_W_m2K(value, state) * field->air_K(value, state); };
  return at(to) - (from == kNone ? 0.0 : at(from));
}

}  // namespace driftwright::effects
