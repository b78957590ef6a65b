#include "effects/screw_rod.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "effects/require.hpp"

namespace driftwright::effects {
namespace {

double square_of_positive(double x) {
  return x > 0.0 ? x * x : 0.0;
}

/// Share of the sum of two independent, evenly spread distances about zero that is below x.
/// @param a_m, b_m  their widths, a > 0
double share_below(double x_m, double a_m, double b_m) {
  constexpr double kNoStroke = 1e-6;  // of the nut's length; the trapezoid below would divide by it
  if (b_m <= kNoStroke * a_m) return std::clamp(x_m / a_m + 0.5, 0.0, 1.0);
  const double outer_m = 0.5 * (a_m + b_m), inner_m = 0.5 * std::abs(a_m - b_m);
  const double share = (square_of_positive(x_m + outer_m) - square_of_positive(x_m + inner_m) -
                        square_of_positive(x_m - inner_m) + square_of_positive(x_m - outer_m)) /
                       (2.0 * a_m * b_m);
  return std::clamp(share, 0.0, 1.0);
}

/// Compliance of the rod from the fixed bearing to s, with that bearing.
double compliance_to_m_N(const ScrewRod& rod, double s_m) {
  return rod.fixed_compliance_m_N + s_m / rod.stiffness_N;
}

/// Share of the whole growth by which a restrained rod is pushed back at s.
double pushed_back(const ScrewRod& rod, double s_m) {
  return compliance_to_m_N(rod, s_m) / (compliance_to_m_N(rod, rod.length_m) + rod.far_compliance_m_N);
}

double growth_m(const ScrewRod& rod, double s_m, const std::vector<double>& theta_K) {
  const std::vector<double> weights = free_growth_m_K(rod, s_m);
  return std::inner_product(weights.begin(), weights.end(), theta_K.begin(), 0.0);
}

}  // namespace

double nut_share(const ScrewRod& rod, int i, double position_m, double stroke_m) {
  const double middle_m = rod.along_m(position_m);
  const double below = i == 0 ? 0.0 : share_below(i * rod.section_m() - middle_m, rod.nut_length_m, stroke_m);
  const double below_next =
      i + 1 == rod.n_sections ? 1.0 : share_below((i + 1) * rod.section_m() - middle_m, rod.nut_length_m, stroke_m);
  return below_next - below;
}

std::vector<double> free_growth_m_K(const ScrewRod& rod, double s_m) {
  constexpr double kRounding = 1e-9;
  require(s_m >= -kRounding * rod.length_m && s_m <= (1.0 + kRounding) * rod.length_m, "place on the screw [m]", s_m);
  const double sections = std::clamp(s_m / rod.section_m(), 0.0, static_cast<double>(rod.n_sections));
  const int last = rod.n_sections - 1, j = std::min(static_cast<int>(sections), last);
  const double u = sections - j, scale_m_K = rod.expansion_1_K * rod.section_m();
  std::vector<double> weights(static_cast<std::size_t>(rod.n_sections), 0.0);
  const auto add = [&](int i, double weight) { weights[static_cast<std::size_t>(i)] += scale_m_K * weight; };
  // the temperature at the face before section i, times a weight
  const auto add_face = [&](int i, double weight) {
    const int a = i == 0 ? 0 : i == rod.n_sections ? last : i - 1, b = i == 0 ? 1 : i == rod.n_sections ? last - 1 : i;
    const bool is_end = i == 0 || i == rod.n_sections;
    add(a, (is_end ? 1.5 : 0.5) * weight);
    add(b, (is_end ? -0.5 : 0.5) * weight);
  };
  for (int i = 0; i < j; ++i) add(i, 1.0);
  add(j, u * u * (3.0 - 2.0 * u));  // cubic of Hermite of the growth: values and slopes at both faces
  add_face(j, u * (1.0 - u) * (1.0 - u));
  add_face(j + 1, u * u * (u - 1.0));
  return weights;
}

std::vector<double> axis_error_m_K(const ScrewRod& rod, double position_m) {
  const double s_m = rod.along_m(position_m);
  std::vector<double> weights = free_growth_m_K(rod, s_m);
  const double back = rod.is_held_at_both_ends ? pushed_back(rod, s_m) : 0.0;
  for (double& weight : weights) weight = rod.sense * (weight - back * rod.expansion_1_K * rod.section_m());
  return weights;
}

double axis_error_m(const ScrewRod& rod, double position_m, const std::vector<double>& theta_K) {
  const double s_m = rod.along_m(position_m), free_m = growth_m(rod, s_m, theta_K);
  if (!rod.is_held_at_both_ends) return rod.sense * free_m;
  const double whole_m = growth_m(rod, rod.length_m, theta_K);
  double back_m = pushed_back(rod, s_m) * whole_m;
  if (rod.stretch_m >= 0.0) {  // the tension cannot fall by more than it was: E A stretch / L
    const double tension_N = rod.stiffness_N * rod.stretch_m / rod.length_m;
    back_m = std::min(back_m, tension_N * compliance_to_m_N(rod, s_m));
  }
  return rod.sense * (free_m - back_m);
}

}  // namespace driftwright::effects
