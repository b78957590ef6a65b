#include "solver/rigid_motion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "base/dense.hpp"
#include "base/errors.hpp"
#include "solver/sparse.hpp"

namespace driftwright::solver {
namespace {

using mesh::Mesh;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Motions = Eigen::Matrix<double, 6, Eigen::Dynamic>;  // columns (t, w size): u = t + w x (x - centre)

/// Limit of the relative stiffness of a free motion. A held machine has feet of more than a thousandth of its size: 1e-6; a
/// free motion has only rounding, 1e-16.
constexpr double kFree = 1e-11;
/// Components of a free motion below this are errors of normals.
constexpr double kSmall = 1e-2;

/// The origin of motions, and the length that makes a rotation comparable with a translation.
struct Frame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double size_m = 1.0;
};

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

/// A point that is fixed in some directions.
struct Hold {
  Eigen::Vector3d position_m;
  Eigen::Matrix3d directions;  // projector
  double weight, normal_error;
};

/// The directions in which a stiffness resists, for any magnitude.
Eigen::Matrix3d directions_of(const Eigen::Matrix3d& stiffness_N_m) {
  const dense::SymmetricEigen eigen(stiffness_N_m);
  Eigen::Matrix3d projector = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (eigen.eigenvalues()[i] > 1e-12 * eigen.eigenvalues()[2]) {
      projector += eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose();
    }
  }
  return projector;
}

/// Mean squares over a set of points as quadratic forms of the motions in `frame`: of the motion that the points prevent,
/// and of the whole motion there.
struct MeanSquares {
  Matrix6d stopped = Matrix6d::Zero(), all = Matrix6d::Zero();
};
MeanSquares mean_squares(const std::vector<Hold>& holds, const Frame& frame) {
  double sum = 0.0;
  for (const Hold& h : holds) sum += h.weight;
  MeanSquares form;
  for (const Hold& h : holds) {
    Eigen::Matrix<double, 3, 6> u;
    u << Eigen::Matrix3d::Identity(), -cross_matrix((h.position_m - frame.centre) / frame.size_m);
    form.stopped += h.weight / sum * u.transpose() * h.directions * u;
    form.all += h.weight / sum * u.transpose() * u;
  }
  return form;
}

/// The resistance of a set of points that is certain. Motions along a curved surface are resisted only through errors of its
/// normals. Of the motions whose resistance is within the error of normals, the largest resistance shows the actual error;
/// four times this share of every motion is not counted. Negative for the motions themselves.
Matrix6d resistance(const std::vector<Hold>& holds, const Frame& frame) {
  double sum = 0.0, error2 = 0.0;
  Eigen::AlignedBox3d box;
  for (const Hold& h : holds) {
    box.extend(h.position_m);
    sum += h.weight;
    error2 += h.weight * h.normal_error * h.normal_error;
  }
  const MeanSquares in_frame = mean_squares(holds, frame);
  if (error2 == 0.0) return in_frame.stopped;
  const MeanSquares own = mean_squares(holds, {box.center(), box.diagonal().norm()});
  const dense::SymmetricEigen eigen(own.stopped);
  double in_doubt = 0.0;
  for (int i = 0; i < 6; ++i) {
    const Vector6d motion = eigen.eigenvectors().col(i);
    const double share = eigen.eigenvalues()[i] / motion.dot(own.all * motion);
    if (share < error2 / sum) in_doubt = std::max(in_doubt, share);
  }
  return in_frame.stopped - 4.0 * in_doubt * in_frame.all;
}

/// An orthonormal basis of a subspace of space, with the axes x, y and z as far as they lie in it.
std::vector<Eigen::Vector3d> plain_basis(const Eigen::Matrix3Xd& orthonormal) {
  std::vector<Eigen::Vector3d> basis;
  const auto add_what_is_new = [&](Eigen::Vector3d v) {
    for (const Eigen::Vector3d& b : basis) v -= b.dot(v) * b;
    if (v.norm() < 2 * kSmall || static_cast<Eigen::Index>(basis.size()) == orthonormal.cols()) return;
    v.normalize();
    Eigen::Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    basis.emplace_back(v[largest] < 0.0 ? -v : v);
  };
  for (int d = 0; d < 3; ++d) {
    const Eigen::Vector3d e = Eigen::Vector3d::Unit(d);
    if ((e - orthonormal * (orthonormal.transpose() * e)).norm() < kSmall) add_what_is_new(e);
  }
  for (Eigen::Index i = 0; i < orthonormal.cols(); ++i) add_what_is_new(orthonormal.col(i));
  return basis;
}

std::string direction_words(const Eigen::Vector3d& v) {
  for (int d = 0; d < 3; ++d) {
    if ((v - Eigen::Vector3d::Unit(d)).norm() < kSmall) return std::string(1, "xyz"[d]);
  }
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", v[0] + 0.0, v[1] + 0.0, v[2] + 0.0);
}

/// A rotation and the position of its axis, as far as other free translations leave it determined.
std::string axis_words(const Eigen::Vector3d& direction, const Eigen::Vector3d& point_m, const Eigen::Matrix3Xd& shifts) {
  std::vector<std::string> words;
  const std::string name = direction_words(direction);
  const Eigen::Matrix3Xd open = cross_matrix(direction) * shifts;
  for (int d = 0; d < 3; ++d) {
    if (name == std::string(1, "xyz"[d])) continue;
    if (shifts.cols() > 0 && (name.size() > 1 ? open.norm() : open.row(d).norm()) > kSmall) continue;
    const double at_mm = 1e3 * point_m[d];
    words.push_back(fmt::format("{} = {:.1f} mm", "xyz"[d], std::abs(at_mm) < 0.05 ? 0.0 : at_mm));
  }
  return words.empty() ? "rotate about " + name : fmt::format("rotate about {} through {}", name, fmt::join(words, ", "));
}

/// A space of motions in words. First translations, then rotations; the axis of a rotation has a position only if no
/// translation moves it.
std::string motion_words(const Motions& motions, const Frame& frame) {
  std::vector<std::string> words;
  const auto turns = dense::SingularValues::with_u_and_full_v(motions.bottomRows<3>());
  Eigen::Index n_turns = 0;
  while (n_turns < turns.sigma.size() && turns.sigma[n_turns] > kSmall) ++n_turns;
  const Eigen::Index n_shifts = motions.cols() - n_turns;
  Eigen::Matrix3Xd shifts(3, n_shifts);
  if (n_shifts > 0) {
    const Eigen::Matrix3Xd all = motions.topRows<3>() * turns.v.rightCols(n_shifts);
    shifts = dense::SingularValues::with_u(all).u.leftCols(n_shifts);
  }
  for (const Eigen::Vector3d& v : plain_basis(shifts)) words.push_back("translate along " + direction_words(v));
  for (const Eigen::Vector3d& w : plain_basis(turns.u.leftCols(n_turns))) {
    const Eigen::VectorXd factors = turns.v.leftCols(n_turns) * turns.sigma.head(n_turns).cwiseInverse().asDiagonal() *
                                    (turns.u.leftCols(n_turns).transpose() * w);
    Eigen::Vector3d t_m = frame.size_m * motions.topRows<3>() * factors;  // per radian
    t_m -= shifts * (shifts.transpose() * t_m);
    const double pitch_m = t_m.dot(w);
    std::string turn = axis_words(w, frame.centre + w.cross(t_m), shifts);
    if (std::abs(pitch_m) > kSmall * frame.size_m)
      turn += fmt::format(" while it moves {:.1f} mm per radian", 1e3 * pitch_m);
    words.push_back(turn);
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

/// Number of the part of each node; -1 for nodes in no cell.
std::vector<int> parts_of_nodes(const Mesh& mesh, int& n_parts) {
  Cliques neighbours;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) neighbours.add(mesh.cells.nodes(cell));
  const std::vector<int> set_of = connected_sets(mesh.n_nodes(), neighbours);
  std::vector<int> part_of(mesh.n_nodes(), -1);
  std::map<int, int> part_of_set;
  for (int node : mesh.cells.node) {
    part_of[node] = part_of_set.try_emplace(set_of[node], static_cast<int>(part_of_set.size())).first->second;
  }
  n_parts = static_cast<int>(part_of_set.size());
  return part_of;
}

}  // namespace

void require_held(const Mesh& mesh, const std::vector<SpringLayer>& layers, const std::vector<bool>& fixed) {
  int n_parts = 0;
  const std::vector<int> part_of = parts_of_nodes(mesh, n_parts);
  const Eigen::Vector3d low = mesh.coords.rowwise().minCoeff(), high = mesh.coords.rowwise().maxCoeff();
  const Frame frame{0.5 * (low + high), (high - low).norm()};

  std::vector<std::map<std::pair<int, int>, std::vector<Hold>>> held_pairs;  // per layer: points between two parts
  auto& nodes = held_pairs.emplace_back();
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const Eigen::Vector3d held(fixed[3 * node], fixed[3 * node + 1], fixed[3 * node + 2]);
    if (part_of[node] < 0 || held.isZero()) continue;
    nodes[{part_of[node], -1}].push_back({mesh.coords.col(node), held.asDiagonal(), 1.0, 0.0});
  }
  for (const SpringLayer& layer : layers) {
    auto& pairs = held_pairs.emplace_back();
    for (const SpringPoint& p : layer) {
      pairs[{part_of[p.node_a], p.node_b < 0 ? -1 : part_of[p.node_b]}].push_back(
          {p.position_m, directions_of(p.stiffness_N_m), p.area_m2, p.normal_error});
    }
  }

  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(6 * n_parts, 6 * n_parts);
  Cliques joined;
  for (const auto& pairs : held_pairs) {
    for (const auto& [pair, holds] : pairs) {
      const auto [a, b] = pair;
      const Matrix6d r = resistance(holds, frame);
      form.block<6, 6>(6 * a, 6 * a) += r;
      if (b < 0) continue;
      form.block<6, 6>(6 * b, 6 * b) += r;
      form.block<6, 6>(6 * a, 6 * b) -= r;
      form.block<6, 6>(6 * b, 6 * a) -= r;
      joined.add(std::vector<int>{a, b});
    }
  }

  std::vector<std::string> region_of(n_parts);
  for (int cell = mesh.cells.size() - 1; cell >= 0; --cell) {
    region_of[part_of[mesh.cells.nodes(cell)[0]]] = mesh.regions[mesh.cells.group[cell]];
  }
  std::vector<std::string> complaints;
  const std::vector<int> set_of = connected_sets(n_parts, joined);
  for (int set = 0; set < n_parts; ++set) {
    std::vector<int> parts, rows;
    for (int p = 0; p < n_parts; ++p) {
      if (set_of[p] != set) continue;
      parts.push_back(p);
      for (int i = 0; i < 6; ++i) rows.push_back(6 * p + i);
    }
    if (parts.empty()) continue;
    const dense::SymmetricEigen eigen(form(rows, rows));
    const double largest = eigen.eigenvalues().tail<1>()[0];
    Eigen::Index n_free = 0;
    while (n_free < eigen.eigenvalues().size() && !(eigen.eigenvalues()[n_free] > kFree * largest)) ++n_free;
    if (n_free == 0) continue;
    std::map<std::string, std::vector<std::string>> regions_that;  // motion -> regions
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Motions all = eigen.eigenvectors().block(6 * static_cast<Eigen::Index>(i), 0, 6, n_free);
      const auto own = dense::SingularValues::with_u(all);
      Eigen::Index rank = 0;
      while (rank < own.sigma.size() && own.sigma[rank] > kSmall) ++rank;
      if (rank > 0) regions_that[motion_words(own.u.leftCols(rank), frame)].push_back(region_of[parts[i]]);
    }
    for (const auto& [motion, regions] : regions_that) {
      std::string with;
      if (regions.size() > 1) {
        const std::vector<std::string> others(regions.begin() + 1, regions.end());
        with = fmt::format(" (and with it {})", fmt::join(others, ", "));
      }
      complaints.push_back(fmt::format("the part with region '{}'{} is not held: as a rigid body it can still {}",
                                       regions.front(), with, motion));
    }
  }
  if (complaints.empty()) return;
  throw InputError(
      fmt::format("supports: {}. Fix more surfaces or directions, or add springs or joints", fmt::join(complaints, "; ")));
}

Holding holding(const Mesh& mesh, const RegionMaterials& materials, const std::vector<Support>& supports,
                const std::vector<JointMechanics>& joints) {
  Holding held{std::vector<bool>(3 * static_cast<std::size_t>(mesh.n_nodes()), false), {}};
  for (const Support& support : supports) {
    for (int facet : mesh.facets_on(mesh.surface(support.surface))) {
      for (int node : mesh.facets.nodes(facet)) {
        for (int i = 0; i < 3; ++i) {
          if (support.fixed[i]) held.fixed[3 * node + i] = true;
        }
      }
    }
  }
  held.layers = spring_layers(mesh, materials, supports, joints);
  require_held(mesh, held.layers, held.fixed);
  return held;
}

}  // namespace driftwright::solver
