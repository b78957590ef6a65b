#pragma once
// Small bodies for tests, without a mesher: boxes of cells with named faces, fields on them, and error norms.

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/material.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::fixtures {

/// A box from `low` to `low + size`, of n[0] x n[1] x n[2] bricks: hexahedra, pairs of wedges (triangles in the planes z =
/// constant, split along the diagonal of x and y) or six tetrahedra (Kuhn; the same diagonals).
struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();
  std::array<int, 3> n = {1, 1, 1};
  mesh::CellShape shape = mesh::CellShape::kTet10;  ///< any cell
};

/// Adds a box as a part of its own: region `region`, surfaces `prefix` + x0, x1, y0, y1, z0, z1. Parts share no nodes.
void add_box(mesh::Mesh& mesh, const Box& box, const std::string& region, const std::string& prefix);

/// One box: region "body", surfaces x0 ... z1.
[[nodiscard]] mesh::Mesh box_mesh(const Box& box);

/// Two parts "a" and "b" with the joint "a/b" between the surfaces side_a and side_b, such as "a.x1" and "b.x0".
[[nodiscard]] mesh::Mesh two_boxes(const Box& a, const Box& b, const std::string& side_a, const std::string& side_b);

/// Moves every node, mid-side nodes too: x becomes map(x). Quadratic cells follow with curved edges.
void map_nodes(mesh::Mesh& mesh, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map);
/// Moves the mid-side nodes of all cells to the middle of their edges.
void straighten_edges(mesh::Mesh& mesh);
/// Merges nodes that lie within 1e-9 m of each other: parts that share faces become one body.
void merge_nodes(mesh::Mesh& mesh);

/// A surface for supports alone that consists of one node.
void add_point_surface(mesh::Mesh& mesh, const std::string& name, int node);

/// The node nearest to a point.
[[nodiscard]] int node_at(const mesh::Mesh& mesh, const Eigen::Vector3d& point_m);

using Field = std::function<double(const Eigen::Vector3d&)>;

/// Values of a field at the nodes.
[[nodiscard]] Eigen::VectorXd at_nodes(const mesh::Mesh& mesh, const Field& field);
/// ∫ field N_i dV by a rule of degree 5 or more.
[[nodiscard]] Eigen::VectorXd volume_load(const mesh::Mesh& mesh, const Field& field);
/// ∫ N_i dA over a surface.
[[nodiscard]] Eigen::VectorXd surface_load(const mesh::Mesh& mesh, const std::string& surface);
/// sqrt(∫ (field of nodal values - exact)^2 dV) by a rule of degree 5 or more.
[[nodiscard]] double l2_error(const mesh::Mesh& mesh, const Eigen::VectorXd& nodal, const Field& exact);
/// Order of convergence from the last two errors, which belong to the mesh widths h.
[[nodiscard]] double observed_order(const std::vector<double>& h, const std::vector<double>& error);

/// K(u) of a full system at fixed inputs.
[[nodiscard]] solver::SparseRow stiffness(const solver::FullSystem& system, const effects::Inputs& at = {});
/// Steady temperatures K(u)⁻¹ f(u), by a direct solver that the program itself does not use.
[[nodiscard]] Eigen::VectorXd steady(const solver::FullSystem& system, const effects::Inputs& at = {});

/// Steel-like: rho 8000 kg/m^3, k 40 W/(m K), c 500 J/(kg K), E 200 GPa, nu 0.3, alpha 12e-6 1/K.
[[nodiscard]] solver::Material steel();
/// The same with a conductivity so high that a small body has one temperature.
[[nodiscard]] solver::Material lump(double conductivity_W_mK = 1e4);

/// A law that does not depend on the inputs.
[[nodiscard]] effects::Law constant(double value);

/// Reads outputs from unknowns: one output per listed unknown.
void observe_unknowns(solver::FullSystem& system, const std::vector<int>& unknowns);

/// Two lumped bodies, C1 T1' = P - H1 T1 - G (T1 - T2), C2 T2' = -H2 T2 - G (T2 - T1), in closed form (Sylvester's
/// formula for the exponential of a 2 x 2 matrix). Temperatures above those of a surrounding at zero.
struct TwoBodies {
  double capacity1_J_K, capacity2_J_K, link_W_K, loss1_W_K, loss2_W_K, power1_W;
  [[nodiscard]] Eigen::Vector2d at(double t_s, const Eigen::Vector2d& start_K) const;
};

/// The i-th root (from 0) of z tan z = biot: in (i pi, i pi + pi/2). By bisection.
[[nodiscard]] double slab_root(double biot, int i);

}  // namespace driftwright::fixtures
