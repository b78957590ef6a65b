#include "mesh/reach.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"

namespace driftwright::mesh {
namespace {

constexpr int kPixels = 700;
constexpr double kFlattest = 0.25;  // cosine between the outward normal and the direction to the eye
constexpr double kSlack = 1.0;  // pixels by which a point may be farther than the nearest surface and still count as visible

constexpr double kFloor = 0.02;  // distance of the floor below the machine, as a share of its size; it hides what is on it

/// Depths seen from one direction, in pixels.
class DepthBuffer {
 public:
  DepthBuffer(const Eigen::Matrix3Xd& corners_m, const Eigen::Vector3d& towards) {
    const Eigen::Vector3d side = towards.unitOrthogonal();
    frame_.row(0) = side;
    frame_.row(1) = towards.cross(side);
    frame_.row(2) = towards;
    const Eigen::Matrix3Xd seen = frame_ * corners_m;
    low_ = seen.rowwise().minCoeff();
    scale_ = (kPixels - 1) / (seen.topRows(2).rowwise().maxCoeff() - low_.head(2)).maxCoeff();
    nearest_.assign(static_cast<std::size_t>(kPixels) * kPixels, -std::numeric_limits<float>::infinity());
  }

  [[nodiscard]] Eigen::Vector3d pixel(const Eigen::Vector3d& at_m) const { return scale_ * (frame_ * at_m - low_); }

  void draw(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m, const Eigen::Vector3d& c_m) {
    const Eigen::Vector3d a = pixel(a_m), b = pixel(b_m), c = pixel(c_m);
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (std::abs(area) < 1e-9) return;
    const auto [left, right] = std::minmax({a.x(), b.x(), c.x()});
    const auto [low, high] = std::minmax({a.y(), b.y(), c.y()});
    for (int y = std::max(0, static_cast<int>(std::ceil(low))); y <= std::min(kPixels - 1, static_cast<int>(high)); ++y) {
      for (int x = std::max(0, static_cast<int>(std::ceil(left))); x <= std::min(kPixels - 1, static_cast<int>(right));
           ++x) {
        const double v = ((x - a.x()) * (c.y() - a.y()) - (y - a.y()) * (c.x() - a.x())) / area;
        const double w = ((b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x())) / area;
        if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
        float& depth = nearest_[static_cast<std::size_t>(y) * kPixels + static_cast<std::size_t>(x)];
        depth = std::max(depth, static_cast<float>(a.z() + v * (b.z() - a.z()) + w * (c.z() - a.z())));
      }
    }
  }

  [[nodiscard]] bool shows(const Eigen::Vector3d& at_m) const {
    const Eigen::Vector3d p = pixel(at_m);
    const auto x = static_cast<std::size_t>(std::clamp<long>(std::lround(p.x()), 0, kPixels - 1));
    const auto y = static_cast<std::size_t>(std::clamp<long>(std::lround(p.y()), 0, kPixels - 1));
    return p.z() + kSlack / kFlattest >= static_cast<double>(nearest_[y * kPixels + x]);
  }

 private:
  Eigen::Matrix3d frame_;
  Eigen::Vector3d low_;
  double scale_ = 1.0;
  std::vector<float> nearest_;
};

std::vector<Eigen::Vector3d> directions() {
  std::vector<Eigen::Vector3d> all;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) all.push_back(Eigen::Vector3d(x, y, z).normalized());
      }
    }
  }
  return all;
}

}  // namespace

std::vector<bool> reachable_nodes(const Mesh& mesh, const MachineSkin& skin) {
  const Eigen::Index n_nodes = mesh.n_nodes();
  // Sum over all triangles at a node, weighted by their areas.
  Eigen::Matrix3Xd normal = Eigen::Matrix3Xd::Zero(3, n_nodes);
  for (const auto& t : skin.triangle) {
    const Eigen::Vector3d n =
        (mesh.coords.col(t[1]) - mesh.coords.col(t[0])).cross(mesh.coords.col(t[2]) - mesh.coords.col(t[0]));
    for (int node : t) normal.col(node) += n;
  }
  const Eigen::Vector3d low = mesh.coords.rowwise().minCoeff(), high = mesh.coords.rowwise().maxCoeff();
  const std::vector<Eigen::Vector3d> eyes = directions();
  std::vector<std::vector<char>> seen(eyes.size(), std::vector<char>(static_cast<std::size_t>(n_nodes), 0));
  parallel_for(eyes.size(), [&](std::size_t e) {
    DepthBuffer buffer(mesh.coords, eyes[e]);
    for (const auto& t : skin.triangle) buffer.draw(mesh.coords.col(t[0]), mesh.coords.col(t[1]), mesh.coords.col(t[2]));
    // Parts on the floor are not visible past its edge.
    const double beneath_m = kFloor * (high - low).norm(), beyond_m = 2.0 * beneath_m;
    const double left = low.x() - beyond_m, right = high.x() + beyond_m, front = low.y() - beyond_m,
                 back = high.y() + beyond_m;
    const double z = low.z() - beneath_m;
    const Eigen::Vector3d a(left, front, z), b(right, front, z), c(right, back, z), d(left, back, z);
    buffer.draw(a, b, c);
    buffer.draw(a, c, d);
    for (Eigen::Index node = 0; node < n_nodes; ++node) {
      const double length = normal.col(node).norm();
      if (length > 0.0 && normal.col(node).dot(eyes[e]) > kFlattest * length && buffer.shows(mesh.coords.col(node)))
        seen[e][static_cast<std::size_t>(node)] = 1;
    }
  });
  std::vector<bool> reached(static_cast<std::size_t>(n_nodes));
  for (std::size_t node = 0; node < reached.size(); ++node) {
    reached[node] = std::any_of(seen.begin(), seen.end(), [&](const std::vector<char>& s) { return s[node] != 0; });
  }
  return reached;
}

}  // namespace driftwright::mesh
