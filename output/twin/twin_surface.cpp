#include "output/twin/twin_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "mesh/machine_skin.hpp"

namespace driftwright::output {
namespace {

constexpr double kSharp = 0.85;  // cosine between the normals of two triangles, below which their edge is drawn

}  // namespace

Quantised quantised(const Eigen::MatrixXf& modes) {
  constexpr double kMost = 32767.0;
  Quantised q;
  q.value.reserve(static_cast<std::size_t>(modes.size()));
  for (Eigen::Index c = 0; c < modes.cols(); ++c) {
    const double most = modes.rows() > 0 ? static_cast<double>(modes.col(c).cwiseAbs().maxCoeff()) : 0.0;
    const double scale = most > 0.0 ? most / kMost : 1.0;
    q.scale.push_back(scale);
    for (Eigen::Index r = 0; r < modes.rows(); ++r)
      q.value.push_back(static_cast<std::int16_t>(std::lround(static_cast<double>(modes(r, c)) / scale)));
  }
  return q;
}

std::vector<std::uint32_t> drawn_edges(const TwinSurface& surface, const std::vector<int>& region) {
  const auto normal = [&](std::size_t t) -> Eigen::Vector3f {
    const auto at = [&](std::size_t k) { return surface.coords_m.col(surface.triangle[3 * t + k]); };
    return (at(1) - at(0)).cross(at(2) - at(0)).normalized();
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> triangles_at;
  for (std::size_t t = 0; t < region.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = surface.triangle[3 * t + k], b = surface.triangle[3 * t + (k + 1) % 3];
      triangles_at[{std::min(a, b), std::max(a, b)}].push_back(t);
    }
  }
  std::vector<std::uint32_t> edges;
  for (const auto& [ends, at] : triangles_at) {
    const bool is_drawn = at.size() != 2 || region[at[0]] != region[at[1]] || normal(at[0]).dot(normal(at[1])) < kSharp;
    if (is_drawn) edges.insert(edges.end(), {ends.first, ends.second});
  }
  return edges;
}

TwinSurface twin_surface(const scenarios::ReducedMachine& machine) {
  if (machine.temperature.rows() != machine.mesh.n_nodes()) throw std::logic_error("twin_surface: a machine without fields");
  const mesh::MachineSkin skin = mesh::skin_of(machine.mesh);
  TwinSurface surface;
  std::vector<std::int64_t> place(static_cast<std::size_t>(machine.mesh.n_nodes()), -1);
  for (const auto& triangle : skin.triangle) {
    for (int node : triangle) {
      std::int64_t& at = place[static_cast<std::size_t>(node)];
      if (at < 0) {
        at = static_cast<std::int64_t>(surface.node.size());
        surface.node.push_back(node);
      }
      surface.triangle.push_back(static_cast<std::uint32_t>(at));
    }
  }
  const auto n = static_cast<Eigen::Index>(surface.node.size()), n_modes = machine.temperature.cols();
  surface.coords_m.resize(3, n);
  Eigen::MatrixXf temperature(n, n_modes), displacement_m(machine.displacement_m.size() > 0 ? 3 * n : 0, n_modes);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index node = surface.node[static_cast<std::size_t>(i)];
    surface.coords_m.col(i) = machine.mesh.coords.col(node).cast<float>();
    temperature.row(i) = machine.temperature.row(node);
    if (displacement_m.rows() > 0) displacement_m.middleRows(3 * i, 3) = machine.displacement_m.middleRows(3 * node, 3);
  }
  surface.edge = drawn_edges(surface, skin.region);
  surface.temperature = quantised(temperature);
  surface.displacement_m = quantised(displacement_m);
  return surface;
}

}  // namespace driftwright::output
