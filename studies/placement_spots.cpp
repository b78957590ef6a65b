#include "studies/placement_spots.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "base/characters.hpp"
#include "base/lists.hpp"
#include "mesh/reach.hpp"

namespace driftwright::studies {
namespace {

constexpr int kLeastOfRegion = 12;

bool is_no_place(const std::string& its_name) {
  const std::string name = lower_case(its_name);
  return std::any_of(std::begin(kNoPlace), std::end(kNoPlace),
                     [&](const char* word) { return name.find(word) != std::string::npos; });
}

/// The known names that the rules allow; those left out because of their names are added to `spots`.
std::vector<std::string> allowed(const std::vector<std::string>& known, const SpotRules& rules, const char* what,
                                 Spots& spots) {
  const auto check = [&](const char* option, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      if (!is_in(known, name))
        throw InputError(fmt::format("{} '{}': the machine has no such {}; there are {}.{}", option, name, what,
                                     fmt::join(known, ", "), did_you_mean(name, known)));
    }
  };
  check("--region", rules.regions);
  check("--exclude", rules.excluded);
  std::vector<std::string> names;
  for (const std::string& name : known) {
    if (is_in(rules.excluded, name) || (!rules.regions.empty() && !is_in(rules.regions, name))) continue;
    if (rules.regions.empty() && is_no_place(name)) {
      spots.left_out.push_back(name);
    } else {
      names.push_back(name);
    }
  }
  if (names.empty())
    throw InputError(
        fmt::format("no {} is left to carry a thermometer; there are {}. Those that turn, flow or hang by their names "
                    "require --region; --exclude takes away what --region gives",
                    what, fmt::join(known, ", ")));
  return names;
}

/// The first n nodes of a sequence in which each is the node furthest from all previous ones. The first is furthest from
/// the centre.
std::vector<int> spread(const mesh::Mesh& mesh, const std::vector<int>& nodes, std::size_t n) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (int node : nodes) middle += mesh.coords.col(node) / static_cast<double>(nodes.size());
  std::vector<double> distance_m2(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) distance_m2[i] = (mesh.coords.col(nodes[i]) - middle).squaredNorm();
  std::vector<int> chain;
  while (chain.size() < std::min(n, nodes.size())) {
    const auto furthest =
        static_cast<std::size_t>(std::max_element(distance_m2.begin(), distance_m2.end()) - distance_m2.begin());
    if (!chain.empty() && !(distance_m2[furthest] > 0.0)) break;
    if (chain.empty()) std::fill(distance_m2.begin(), distance_m2.end(), std::numeric_limits<double>::infinity());
    chain.push_back(nodes[furthest]);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      distance_m2[i] = std::min(distance_m2[i], (mesh.coords.col(nodes[i]) - mesh.coords.col(chain.back())).squaredNorm());
  }
  return chain;
}

}  // namespace

Spots spots_of(const mesh::Mesh& mesh, const SpotRules& rules) {
  Spots spots;
  const std::vector<std::string> names = allowed(mesh.regions, rules, "region", spots);
  const mesh::MachineSkin skin = mesh::skin_of(mesh);
  const std::vector<bool> reached = mesh::reachable_nodes(mesh, skin);
  std::vector<double> area_m2(mesh.regions.size());
  std::vector<std::vector<int>> nodes(mesh.regions.size());
  for (std::size_t i = 0; i < skin.triangle.size(); ++i) {
    const auto& t = skin.triangle[i];
    if (!std::all_of(t.begin(), t.end(), [&](int node) { return reached[static_cast<std::size_t>(node)]; })) continue;
    const auto region = static_cast<std::size_t>(skin.region[i]);
    area_m2[region] +=
        0.5 * (mesh.coords.col(t[1]) - mesh.coords.col(t[0])).cross(mesh.coords.col(t[2]) - mesh.coords.col(t[0])).norm();
    nodes[region].insert(nodes[region].end(), t.begin(), t.end());
  }
  double all_m2 = 0.0;
  for (const std::string& name : names) all_m2 += area_m2[static_cast<std::size_t>(mesh.region(name))];
  for (const std::string& name : names) {
    const auto region = static_cast<std::size_t>(mesh.region(name));
    if (nodes[region].empty()) continue;  // no node on the outside
    std::sort(nodes[region].begin(), nodes[region].end());
    nodes[region].erase(std::unique(nodes[region].begin(), nodes[region].end()), nodes[region].end());
    const double share = area_m2[region] / all_m2;
    const auto n = static_cast<std::size_t>(std::max<long>(kLeastOfRegion, std::lround(share * rules.n_points)));
    spots.regions.push_back(name);
    for (int node : spread(mesh, nodes[region], n))
      spots.points.push_back({.region = name, .at_m = mesh.coords.col(node), .node = node});
  }
  if (spots.points.empty())
    throw InputError(fmt::format("no point of {} can be reached from outside", fmt::join(names, ", ")));
  return spots;
}

Spots spots_of(const std::vector<std::string>& nodes, const SpotRules& rules) {
  Spots spots;
  spots.regions = allowed(nodes, rules, "lumped node", spots);
  for (const std::string& name : spots.regions) spots.points.push_back({.region = name});
  return spots;
}

}  // namespace driftwright::studies
