#include "solver/distributed/division.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "base/errors.hpp"

namespace driftwright::solver {
namespace {

using mesh::Mesh;

void bisect(const Eigen::Matrix3Xd& centre, std::vector<int>::iterator begin, std::vector<int>::iterator end, int first_part,
            int n_parts, std::vector<int>& part) {
  if (n_parts == 1) {
    std::for_each(begin, end, [&](int cell) { part[static_cast<std::size_t>(cell)] = first_part; });
    return;
  }
  Eigen::Vector3d low = centre.col(*begin), high = low;
  std::for_each(begin, end, [&](int cell) {
    low = low.cwiseMin(centre.col(cell));
    high = high.cwiseMax(centre.col(cell));
  });
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const int left = n_parts / 2;
  const auto middle = begin + (end - begin) * left / n_parts;
  std::nth_element(begin, middle, end,
                   [&](int a, int b) { return std::pair(centre(axis, a), a) < std::pair(centre(axis, b), b); });
  bisect(centre, begin, middle, first_part, left, part);
  bisect(centre, middle, end, first_part + left, n_parts - left, part);
}

/// For each facet the part of a cell that has all its nodes; of a facet without one, part 0.
std::vector<int> parts_of_facets(const Mesh& mesh, const std::vector<int>& cell_part) {
  std::vector<int> start(static_cast<std::size_t>(mesh.n_nodes()) + 1, 0), cells_at(mesh.cells.node.size());
  for (int node : mesh.cells.node) ++start[static_cast<std::size_t>(node) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (int c = 0; c < mesh.cells.size(); ++c) {
    for (int node : mesh.cells.nodes(c)) cells_at[static_cast<std::size_t>(next[static_cast<std::size_t>(node)]++)] = c;
  }
  std::vector<int> part(static_cast<std::size_t>(mesh.facets.size()), 0);
  for (int f = 0; f < mesh.facets.size(); ++f) {
    const auto nodes = mesh.facets.nodes(f);
    for (int k = start[static_cast<std::size_t>(nodes[0])]; k < start[static_cast<std::size_t>(nodes[0]) + 1]; ++k) {
      const auto of_cell = mesh.cells.nodes(cells_at[static_cast<std::size_t>(k)]);
      const bool has_all = std::all_of(nodes.begin(), nodes.end(), [&](int node) {
        return std::find(of_cell.begin(), of_cell.end(), node) != of_cell.end();
      });
      if (!has_all) continue;
      part[static_cast<std::size_t>(f)] = cell_part[static_cast<std::size_t>(cells_at[static_cast<std::size_t>(k)])];
      break;
    }
  }
  return part;
}

/// The cells or facets of a part, with the nodes' own numbers.
mesh::Cells cells_of_part(const mesh::Cells& all, const std::vector<int>& part_of, int part, const std::vector<int>& own) {
  mesh::Cells cells;
  std::vector<int> nodes;
  for (int c = 0; c < all.size(); ++c) {
    if (part_of[static_cast<std::size_t>(c)] != part) continue;
    nodes.clear();
    for (int node : all.nodes(c)) nodes.push_back(own[static_cast<std::size_t>(node)]);
    cells.add(all.shape[static_cast<std::size_t>(c)], nodes, all.group[static_cast<std::size_t>(c)]);
  }
  return cells;
}

}  // namespace

std::vector<int> bisected(const Mesh& mesh, int n_parts) {
  if (n_parts > mesh.cells.size()) {
    throw InputError(fmt::format("--distributed: the mesh has {} cells for {} processes; `mpirun -n` with fewer of them",
                                 mesh.cells.size(), n_parts));
  }
  Eigen::Matrix3Xd centre(3, mesh.cells.size());
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells.nodes(c);
    centre.col(c).setZero();
    for (int node : nodes) centre.col(c) += mesh.coords.col(node) / static_cast<double>(nodes.size());
  }
  std::vector<int> cells(static_cast<std::size_t>(mesh.cells.size())), part(cells.size());
  std::iota(cells.begin(), cells.end(), 0);
  bisect(centre, cells.begin(), cells.end(), 0, n_parts, part);
  return part;
}

Division divide(const Mesh& mesh, const effects::HeatBalance& balance, int n_parts) {
  Division d;
  d.cell_part = bisected(mesh, n_parts);
  d.facet_part = parts_of_facets(mesh, d.cell_part);
  std::vector<int> first_part(static_cast<std::size_t>(mesh.n_nodes()), n_parts);
  std::vector<std::pair<int, int>> has;  // node, part
  const auto add_all = [&](const mesh::Cells& cells, const std::vector<int>& part) {
    for (int c = 0; c < cells.size(); ++c) {
      for (int node : cells.nodes(c)) has.emplace_back(node, part[static_cast<std::size_t>(c)]);
    }
  };
  add_all(mesh.cells, d.cell_part);
  for (const auto& [node, part] : has) {
    int& first = first_part[static_cast<std::size_t>(node)];
    first = std::min(first, part);
  }
  const auto unite = [](auto& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  unite(has);
  add_all(mesh.facets, d.facet_part);
  for (const effects::Exchange& e : balance.exchanges) {
    const bool is_known =
        std::any_of(d.joints.begin(), d.joints.end(), [&](const auto& joint) { return joint.name == e.body.name; });
    const mesh::Joint* joint = e.body.kind == effects::BodyKind::kJoint && !is_known ? mesh.joint(e.body.name) : nullptr;
    if (!joint) continue;
    Division::DividedJoint divided{.name = joint->name, .points = joint_points(mesh, *joint), .part = {}};
    for (const JointPoint& point : divided.points) {
      divided.part.push_back(first_part[static_cast<std::size_t>(point.node_a[0])]);
      for (const auto* nodes : {&point.node_a, &point.node_b}) {
        for (int node : *nodes) has.emplace_back(node, divided.part.back());
      }
    }
    d.joints.push_back(std::move(divided));
  }
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    if (first_part[static_cast<std::size_t>(node)] == n_parts) has.emplace_back(node, 0);  // in no cell
  }
  unite(has);
  d.start.assign(static_cast<std::size_t>(mesh.n_nodes()) + 1, 0);
  for (const auto& [node, part] : has) {
    ++d.start[static_cast<std::size_t>(node) + 1];
    d.part.push_back(part);
  }
  std::partial_sum(d.start.begin(), d.start.end(), d.start.begin());
  return d;
}

std::vector<CommonUnknowns> take_part(const Mesh& mesh, const Division& division, int part, int n_parts, int n_lumped,
                                      Share& share) {
  const auto n = static_cast<std::size_t>(mesh.n_nodes());
  const auto parts_at = [&](std::size_t node) {
    return std::span(division.part)
        .subspan(static_cast<std::size_t>(division.start[node]),
                 static_cast<std::size_t>(division.start[node + 1] - division.start[node]));
  };
  share.n_whole_nodes = mesh.n_nodes();
  share.n_lumped = n_lumped;
  share.is_first = part == 0;
  share.holder.resize(n);
  for (std::size_t node = 0; node < n; ++node) share.holder[node] = parts_at(node)[0];
  const auto take = [&](bool held) {
    for (std::size_t node = 0; node < n; ++node) {
      const auto parts = parts_at(node);
      if ((parts[0] == part) == held && std::find(parts.begin(), parts.end(), part) != parts.end())
        share.whole_node.push_back(static_cast<int>(node));
    }
  };
  take(true);
  share.n_held = static_cast<int>(share.whole_node.size());
  take(false);
  const int n_own = static_cast<int>(share.whole_node.size());
  if (share.is_first) share.n_held = n_own + n_lumped;  // the first part holds each node that it has
  std::vector<int> own(n, -1);
  share.mesh.coords.resize(3, n_own);
  for (int i = 0; i < n_own; ++i) {
    own[static_cast<std::size_t>(share.whole_node[static_cast<std::size_t>(i)])] = i;
    share.mesh.coords.col(i) = mesh.coords.col(share.whole_node[static_cast<std::size_t>(i)]);
  }
  share.mesh.regions = mesh.regions;
  share.mesh.surfaces = mesh.surfaces;
  share.mesh.cells = cells_of_part(mesh.cells, division.cell_part, part, own);
  share.mesh.facets = cells_of_part(mesh.facets, division.facet_part, part, own);
  for (const Division::DividedJoint& joint : division.joints) {
    share.joint_points.push_back({joint.name, {}});
    for (std::size_t p = 0; p < joint.points.size(); ++p) {
      if (joint.part[p] != part) continue;
      JointPoint point = joint.points[p];
      for (auto* nodes : {&point.node_a, &point.node_b}) {
        for (int& node : *nodes) node = own[static_cast<std::size_t>(node)];
      }
      share.joint_points.back().second.push_back(std::move(point));
    }
  }
  std::vector<CommonUnknowns> common(static_cast<std::size_t>(n_parts));
  for (std::size_t node = 0; node < n; ++node) {
    if (own[node] < 0) continue;
    for (int other : parts_at(node)) common[static_cast<std::size_t>(other)].unknown.push_back(own[node]);
  }
  for (int other = 0; other < n_parts; ++other) {
    CommonUnknowns& c = common[static_cast<std::size_t>(other)];
    c.part = other;
    c.n_nodes = static_cast<int>(c.unknown.size());
    for (int i = 0; i < n_lumped; ++i) c.unknown.push_back(n_own + i);
  }
  std::erase_if(common, [&](const CommonUnknowns& c) { return c.part == part || c.unknown.empty(); });
  return common;
}

}  // namespace driftwright::solver
