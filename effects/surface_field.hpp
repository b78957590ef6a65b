#pragma once
// Film coefficients and air temperatures before a surface, from a file: values at points or cells, for one state or for
// several operating points or times. No mesh is known here; solver/film_mapping carries the values onto one.

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace driftwright::effects {

/// What the states of a field follow.
enum class FieldOver { kNothing, kSpeed, kTime };

/// The states of a field as numbers: all that its laws use, without the file.
struct FieldStates {
  FieldOver over = FieldOver::kNothing;
  std::vector<double> at = {0.0};                           ///< rising: speeds [rpm] or times [s]; a single 0 for one state
  std::vector<double> mean_film_W_m2K = {1.0};              ///< of each state
  double air_K = std::numeric_limits<double>::quiet_NaN();  ///< mean air temperature; NaN: the file has none
};

/// The values of a file. They never change once they are read.
struct SurfaceField {
  Eigen::Matrix3Xd point_m;      ///< one column per value: the point, or the middle of the cell
  std::vector<int> corner_from;  ///< corners of cell c: columns corner_from[c] to corner_from[c + 1] - 1; empty: points
  Eigen::Matrix3Xd corner_m;     ///< corners of plane convex polygons, in order
  Eigen::MatrixXd film_W_m2K;    ///< values x states, >= 0
  Eigen::MatrixXd air_K;         ///< values x states, absolute; empty without air temperatures
  FieldStates states;
  std::string hash;  ///< of these values

  [[nodiscard]] int n_values() const { return static_cast<int>(point_m.cols()); }
  [[nodiscard]] bool has_cells() const { return !corner_from.empty(); }
  /// Area of a cell [m^2].
  [[nodiscard]] double area_m2(int cell) const;
  /// ∫ h dA of a state over the cells [W/K]; NaN for points, which have no areas.
  [[nodiscard]] double film_W_K(int state) const;
};

/// Fills in the means of `states` from the values: weighted by area for cells, plain for points. The mean of the air
/// temperature is weighted by the film as well, over all states; it is left unchanged if the file has no air temperatures.
void set_means(SurfaceField& field);

/// A film that differs from place to place is a sum of parts, each a fixed pattern times a number:
///
///     h(x, n) = h_b(x) + Σ_k r_k(n) [h_k(x) - h_(k-1)(x)],  r_k(n) = clamp((n - n_(k-1)) / (n_k - n_(k-1)), 0, 1)
///
/// which is h(x) interpolated linearly between the states next to n, and constant beyond the ends; h T_air likewise. If the
/// mean film falls over the states, they are counted from the last one, so that r = 0 and r = 1 everywhere are real states
/// and no change removes more film than there is on average: a reduced model is built at these.
struct FieldPart {
  static constexpr int kNone = -1, kUncovered = -2;
  std::shared_ptr<const SurfaceField> field = {};  ///< shared, because effects are copied often; null: no mesh is needed
  std::string id = {};                             ///< of the pattern; "": an even film
  int from = kNone,
      to = 0;            ///< states: the pattern is `to`, or `to` minus `from`; kUncovered: 1 where the file has no value
  double reach_m = 0.0;  ///< see film_mapping; NaN: the default
  double even_air_K = std::numeric_limits<double>::quiet_NaN();  ///< air temperature of all values if the file has none

  [[nodiscard]] bool is_even() const { return id.empty(); }
  /// The pattern at a value of the file [W/(m^2 K)]; `value` -1 means faces without a value.
  [[nodiscard]] double film_W_m2K(int value) const;
  /// The same of h T_air [W/m^2], T_air absolute; 0 without air temperatures.
  [[nodiscard]] double film_times_air_W_m2(int value) const;
};

}  // namespace driftwright::effects
