#pragma once
// Makes the quadrature rules of the reference cells. Use quadrature(), mass_rule() and stiffness_rule() of shape.hpp, which
// store them.

#include <vector>

#include "mesh/shape.hpp"

namespace driftwright::mesh {

using QuadratureRule = std::vector<QuadraturePoint>;

/// Exact for polynomials up to the total degree `degree`. @throws std::logic_error  above 5
[[nodiscard]] QuadratureRule tetrahedron_rule(int degree);
[[nodiscard]] QuadratureRule triangle_rule(int degree);
/// Gauss-Legendre in each direction, exact up to `degree` in each. @throws std::logic_error  above 7
[[nodiscard]] QuadratureRule quad_rule(int degree);
[[nodiscard]] QuadratureRule hexahedron_rule(int degree);
/// Product of a triangle rule and a line rule. @throws std::logic_error  as triangle_rule, quad_rule
[[nodiscard]] QuadratureRule wedge_rule(int degree_in_triangle, int degree_along);

}  // namespace driftwright::mesh
