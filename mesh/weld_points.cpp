#include "mesh/weld_points.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace driftwright::mesh {
namespace {

constexpr double kOnePlace = 1e-6;  // of the mesh's size: coordinates of single precision differ by less

/// Finds nodes by region and place. Places are sorted into boxes that are much larger than what counts as one place.
class Places {
 public:
  Places(const Eigen::Matrix3Xd& coords, double reach) : coords_(coords), reach_(reach) {}

  [[nodiscard]] std::optional<int> find(int region, const Eigen::Vector3d& x) const {
    for (int corner = 0; corner < 8; ++corner) {  // a box, and those next to it that the reach touches
      Key key = key_of(region, x);
      bool is_other = corner == 0;
      for (int d = 0; d < 3; ++d) {
        if ((corner >> d & 1) == 0) continue;
        const long beside = box(x[d] + (x[d] - size_of_box() * static_cast<double>(key[d + 1]) < reach_ ? -reach_ : reach_));
        is_other = is_other || beside != key[d + 1];
        key[d + 1] = beside;
      }
      if (!is_other) continue;
      const auto [begin, end] = nodes_.equal_range(key);
      for (auto at = begin; at != end; ++at) {
        if ((coords_.col(at->second) - x).norm() <= reach_) return at->second;
      }
    }
    return std::nullopt;
  }
  void add(int region, int node) { nodes_.emplace(key_of(region, coords_.col(node)), node); }

 private:
  using Key = std::array<long, 4>;
  [[nodiscard]] double size_of_box() const { return 8.0 * reach_; }
  [[nodiscard]] long box(double x) const { return static_cast<long>(std::floor(x / size_of_box())); }
  [[nodiscard]] Key key_of(int region, const Eigen::Vector3d& x) const { return {region, box(x[0]), box(x[1]), box(x[2])}; }

  const Eigen::Matrix3Xd& coords_;
  double reach_;
  std::multimap<Key, int> nodes_;
};

}  // namespace

void weld_points(RawMesh& raw) {
  if (raw.cells.size() < 2) return;
  std::vector<bool> is_used(static_cast<std::size_t>(raw.coords.cols()), false);
  for (int n : raw.cells.node) {
    if (is_used[n]) return;
    is_used[n] = true;
  }
  const double reach = kOnePlace * (raw.coords.rowwise().maxCoeff() - raw.coords.rowwise().minCoeff()).maxCoeff();
  if (!(reach > 0.0) || !std::isfinite(reach)) return;
  Places places(raw.coords, reach);
  std::vector<int> kept(is_used.size(), -1);  // the node that each has become
  std::size_t n_welded = 0;
  for (int c = 0; c < raw.cells.size(); ++c) {
    for (int n : raw.cells.nodes(c)) {
      const auto first = places.find(raw.cells.group[c], raw.coords.col(n));
      kept[n] = first.value_or(n);
      n_welded += first ? 1 : 0;
      if (!first) places.add(raw.cells.group[c], n);
    }
  }
  if (n_welded == 0) return;
  for (int& n : raw.cells.node) n = kept[n];
  for (RawMesh::FacetSurface& surface : raw.facet_surfaces) {
    for (std::vector<int>& corners : surface.corners) {
      for (int region = 0; region < static_cast<int>(raw.regions.size()); ++region) {
        std::vector<int> there;
        for (int n : corners) {
          if (const auto at = places.find(region, raw.coords.col(n))) there.push_back(*at);
        }
        if (there.size() != corners.size()) continue;
        corners = there;
        break;
      }
    }
  }
  std::vector<int> new_number(is_used.size(), -1);
  Eigen::Index n_kept = 0;
  std::vector<long> numbers;
  for (std::size_t n = 0; n < kept.size(); ++n) {
    const bool is_welded_away = kept[n] >= 0 && kept[n] != static_cast<int>(n);
    if (is_welded_away) continue;
    raw.coords.col(n_kept) = Eigen::Vector3d(raw.coords.col(static_cast<Eigen::Index>(n)));
    new_number[n] = static_cast<int>(n_kept++);
    numbers.push_back(raw.node_number[n]);
  }
  raw.coords.conservativeResize(3, n_kept);
  raw.node_number = std::move(numbers);
  for (int& n : raw.cells.node) n = new_number[n];
  for (RawMesh::FacetSurface& surface : raw.facet_surfaces) {
    for (std::vector<int>& corners : surface.corners) {
      for (int& n : corners) n = new_number[n];
    }
  }
  raw.notes.push_back(
      fmt::format("the cells of the file share no points; points of one region at one place were made one, {} of {} remain",
                  n_kept, is_used.size()));
}

}  // namespace driftwright::mesh
