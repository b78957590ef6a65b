// NAFEMS LE11, "Solid cylinder/taper/sphere - temperature": a thermo-elastic body, judged by the convergence of one stress.
// Source: NAFEMS, The Standard NAFEMS Benchmarks, TNSB Rev. 3 (1990); geometry as in FeenoX's examples/nafems-le11.geo.

#include <gmsh.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "mesh/gmsh_parts.hpp"
#include "solver/elasticity.hpp"
#include "solver/stress.hpp"
#include "tests/fixtures.hpp"

namespace driftwright::solver {
namespace {

/// A quarter of the body of revolution about z; surfaces x0, y0, bottom, top and outer.
mesh::Mesh le11_mesh(double size_m) {
  const mesh::GmshSession session;
  return mesh::with_gmsh_errors([&] {
    namespace occ = gmsh::model::occ;
    const auto point = [](double r, double z) { return occ::addPoint(r, 0, z); };
    const double d = std::numbers::sqrt2 / 2, rd = std::sqrt(1.4 * 1.4 - 0.5);
    const double low = d + 0.69, high = d + 1.09;
    const int o = point(0, 0), a = point(1, 0), b = point(1.4, 0), c = point(d, d), e = point(rd, d), f = point(d, high),
              g = point(1, high), h = point(1, low);
    const std::vector<int> lines = {occ::addLine(a, b),        occ::addCircleArc(b, o, e), occ::addLine(e, h),
                                    occ::addLine(h, g),        occ::addLine(g, f),         occ::addLine(f, c),
                                    occ::addCircleArc(c, o, a)};
    const int face = occ::addPlaneSurface({occ::addCurveLoop(lines)});
    gmsh::vectorpair solid;
    occ::revolve({{2, face}}, 0, 0, 0, 0, 0, 1, std::numbers::pi / 2, solid);
    occ::synchronize();
    gmsh::vectorpair volumes;
    gmsh::model::getEntities(volumes, 3);
    return mesh::mesh_parts({{"body", {volumes.at(0).second}, size_m}}, 2, [&](const mesh::OuterFace& at) -> std::string {
      const auto flat_at = [&](int axis, double x) {
        return std::abs(at.low[axis] - x) + std::abs(at.high[axis] - x) < 1e-4;
      };
      if (flat_at(0, 0.0)) return "x0";
      if (flat_at(1, 0.0)) return "y0";
      if (flat_at(2, 0.0)) return "bottom";
      return flat_at(2, high) ? "top" : "outer";
    });
  });
}

TEST(NafemsLe11, AxialStressAtAConvergesToMinus105MPa) {
  Material m = fixtures::steel();
  m.youngs_modulus_Pa = 210e9;
  m.poisson_ratio = 0.3;
  m.expansion_1_K = 2.3e-4;
  for (double size_m : {0.2, 0.14, 0.1, 0.07}) {
    const auto start = std::chrono::steady_clock::now();
    const mesh::Mesh mesh = le11_mesh(size_m);
    const Elasticity elastic(mesh, {m},
                             {{"x0", {true, false, false}},
                              {"y0", {false, true, false}},
                              {"bottom", {false, false, true}},
                              {"top", {false, false, true}}});
    const Eigen::VectorXd theta =
        fixtures::at_nodes(mesh, [](const Eigen::Vector3d& x) { return x.head<2>().norm() + x[2]; });
    const NodalStress stress = nodal_stress_Pa(mesh, {m}, elastic.displacement(theta), theta);
    const int at = fixtures::node_at(mesh, {1, 0, 0}), other = fixtures::node_at(mesh, {0, 1, 0});
    printf("h %g  nodes %d  szz(A) %.3f %.3f MPa  %.1f s\n", size_m, mesh.n_nodes(), stress(2, at) / 1e6,
           stress(2, other) / 1e6, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace driftwright::solver
