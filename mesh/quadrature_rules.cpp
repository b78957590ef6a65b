#include "mesh/quadrature_rules.hpp"

#include <cmath>
#include <stdexcept>

namespace driftwright::mesh {
namespace {

struct LinePoint {
  double x, weight;
};

/// Gauss-Legendre on [0, 1], exact to `degree`: 1 to 4 points (Abramowitz & Stegun 25.4.30).
std::vector<LinePoint> line_rule(int degree) {
  std::vector<LinePoint> rule;
  const auto add_pair = [&](double r, double weight) {  // +-r and weight on [-1, 1]
    rule.push_back({0.5 * (1.0 - r), 0.5 * weight});
    rule.push_back({0.5 * (1.0 + r), 0.5 * weight});
  };
  if (degree <= 1) return {{0.5, 1.0}};
  if (degree <= 3) {
    add_pair(std::sqrt(1.0 / 3.0), 1.0);
  } else if (degree <= 5) {
    rule.push_back({0.5, 4.0 / 9.0});
    add_pair(std::sqrt(0.6), 5.0 / 9.0);
  } else if (degree <= 7) {
    const double spread = 2.0 / 7.0 * std::sqrt(1.2), share = std::sqrt(30.0) / 36.0;
    add_pair(std::sqrt(3.0 / 7.0 - spread), 0.5 + share);
    add_pair(std::sqrt(3.0 / 7.0 + spread), 0.5 - share);
  } else {
    throw std::logic_error("line_rule: degree above 7");
  }
  return rule;
}

}  // namespace

QuadratureRule tetrahedron_rule(int degree) {
  if (degree <= 1) return {{{0.25, 0.25, 0.25}, 1.0 / 6.0}};
  QuadratureRule rule;
  const auto add_orbit4 = [&](double a, double weight) {  // (a, a, a) and its permutations with b = 1 - 3a
    const double b = 1.0 - 3.0 * a;
    rule.push_back({{a, a, a}, weight});
    rule.push_back({{b, a, a}, weight});
    rule.push_back({{a, b, a}, weight});
    rule.push_back({{a, a, b}, weight});
  };
  if (degree <= 2) {
    add_orbit4((5.0 - std::sqrt(5.0)) / 20.0, 1.0 / 24.0);
    return rule;
  }
  if (degree > 5) throw std::logic_error("tetrahedron_rule: degree above 5");
  rule.push_back({{0.25, 0.25, 0.25}, 8.0 / 405.0});
  const double r15 = std::sqrt(15.0);
  add_orbit4((7.0 - r15) / 34.0, (2665.0 + 14.0 * r15) / 226800.0);
  add_orbit4((7.0 + r15) / 34.0, (2665.0 - 14.0 * r15) / 226800.0);
  const double c = (10.0 - 2.0 * r15) / 40.0, d = 0.5 - c, weight = 5.0 / 567.0;
  for (const Eigen::Vector3d& xi : {Eigen::Vector3d{c, c, d}, {c, d, c}, {d, c, c}, {c, d, d}, {d, c, d}, {d, d, c}}) {
    rule.push_back({xi, weight});
  }
  return rule;
}

QuadratureRule triangle_rule(int degree) {
  if (degree <= 1) return {{{1.0 / 3.0, 1.0 / 3.0, 0.0}, 0.5}};
  QuadratureRule rule;
  const auto add_orbit3 = [&](double a, double weight) {
    const double b = 1.0 - 2.0 * a;
    rule.push_back({{a, a, 0.0}, weight});
    rule.push_back({{b, a, 0.0}, weight});
    rule.push_back({{a, b, 0.0}, weight});
  };
  if (degree <= 2) {
    add_orbit3(1.0 / 6.0, 1.0 / 6.0);
    return rule;
  }
  if (degree > 5) throw std::logic_error("triangle_rule: degree above 5");
  const double r15 = std::sqrt(15.0);
  rule.push_back({{1.0 / 3.0, 1.0 / 3.0, 0.0}, 9.0 / 80.0});
  add_orbit3((6.0 - r15) / 21.0, (155.0 - r15) / 2400.0);
  add_orbit3((6.0 + r15) / 21.0, (155.0 + r15) / 2400.0);
  return rule;
}

QuadratureRule quad_rule(int degree) {
  QuadratureRule rule;
  const std::vector<LinePoint> line = line_rule(degree);
  for (const LinePoint& a : line) {
    for (const LinePoint& b : line) rule.push_back({{a.x, b.x, 0.0}, a.weight * b.weight});
  }
  return rule;
}

QuadratureRule hexahedron_rule(int degree) {
  QuadratureRule rule;
  for (const QuadraturePoint& q : quad_rule(degree)) {
    for (const LinePoint& c : line_rule(degree)) rule.push_back({{q.xi[0], q.xi[1], c.x}, q.weight * c.weight});
  }
  return rule;
}

QuadratureRule wedge_rule(int degree_in_triangle, int degree_along) {
  QuadratureRule rule;
  for (const QuadraturePoint& q : triangle_rule(degree_in_triangle)) {
    for (const LinePoint& c : line_rule(degree_along)) rule.push_back({{q.xi[0], q.xi[1], c.x}, q.weight * c.weight});
  }
  return rule;
}

}  // namespace driftwright::mesh
