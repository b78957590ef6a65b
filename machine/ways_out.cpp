#include "machine/ways_out.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "solver/sparse.hpp"

namespace driftwright::scenarios {
namespace {

/// Vertices: the mesh's nodes, the lumped nodes, and the outside.
class Paths {
 public:
  Paths(const mesh::Mesh& mesh, const effects::HeatBalance& balance) : mesh_(mesh) {
    for (const effects::LumpedNode& node : balance.nodes) {
      lumped_[node.name] = mesh.n_nodes() + static_cast<int>(lumped_.size());
    }
    outside_ = mesh.n_nodes() + static_cast<int>(lumped_.size());
    for (int c = 0; c < mesh.cells.size(); ++c) paths_.add(mesh.cells.nodes(c));
  }
  /// Some vertex of a body; its parts are connected or heated alike.
  void connect(const effects::Body& a, int b) {
    for (int vertex : vertices(a)) paths_.add(std::vector<int>{vertex, b});
  }
  void connect_joint(const mesh::Joint& joint) {
    const int a = mesh_.facets.nodes(mesh_.facets_on(mesh_.surface(joint.side_a)).front())[0];
    const int b = mesh_.facets.nodes(mesh_.facets_on(mesh_.surface(joint.side_b)).front())[0];
    paths_.add(std::vector<int>{a, b});
  }
  [[nodiscard]] int of_surrounding(const std::string& name) const {
    return name == effects::kAmbientName ? outside_ : lumped_.at(name);
  }
  [[nodiscard]] int outside() const { return outside_; }

  /// Names of regions and nodes that are not connected with the outside.
  [[nodiscard]] std::set<std::string> shut_in() const {
    const std::vector<int> set_of = solver::connected_sets(outside_ + 1, paths_);
    std::set<std::string> names;
    for (int c = 0; c < mesh_.cells.size(); ++c) {
      if (set_of[mesh_.cells.nodes(c)[0]] != set_of[outside_]) names.insert("region " + mesh_.regions[mesh_.cells.group[c]]);
    }
    for (const auto& [name, vertex] : lumped_) {
      if (set_of[vertex] != set_of[outside_]) names.insert("node " + name);
    }
    return names;
  }

 private:
  [[nodiscard]] std::vector<int> vertices(const effects::Body& body) const {
    if (body.kind == effects::BodyKind::kNode) return {of_surrounding(body.name)};
    std::vector<int> found;
    if (body.kind == effects::BodyKind::kRegion) {
      for (int c : mesh_.cells_in(mesh_.region(body.name))) found.push_back(mesh_.cells.nodes(c)[0]);
    } else {
      for (int f : mesh_.facets_on(mesh_.surface(body.name))) found.push_back(mesh_.facets.nodes(f)[0]);
    }
    return found;
  }

  const mesh::Mesh& mesh_;
  std::map<std::string, int> lumped_;
  int outside_ = 0;
  solver::Cliques paths_;
};

/// Laws that depend on temperatures count as open; they vanish at single temperatures at most.
bool is_open(const effects::Law& law) {
  return !law.probes.empty() || !law.thermostat.empty() || law(effects::Inputs{}) != 0.0;
}

/// Exchanges whose law counts as open, radiation, and prescribed temperatures.
template <class IsOpen>
void add_exchanges(Paths& paths, const mesh::Mesh& mesh, const effects::HeatBalance& balance, IsOpen open) {
  for (const effects::Exchange& e : balance.exchanges) {
    if (!open(e.coefficient)) continue;
    if (e.body.kind == effects::BodyKind::kJoint) {
      paths.connect_joint(*mesh.joint(e.body.name));
    } else {
      paths.connect(e.body, e.medium_K ? paths.outside() : paths.of_surrounding(e.surrounding));
    }
  }
  for (const auto& radiation : balance.radiations) {
    paths.connect(effects::surface(radiation.surface), paths.of_surrounding(radiation.surrounding));
  }
  for (const auto& fixed : balance.fixed) paths.connect(fixed.body, paths.outside());
}

}  // namespace

void require_ways_out(const mesh::Mesh& mesh, const effects::HeatBalance& balance, const Where& where) {
  Paths paths(mesh, balance);
  add_exchanges(paths, mesh, balance, is_open);
  const std::set<std::string> shut_in = paths.shut_in();
  if (shut_in.empty()) return;
  throw InputError(
      where, fmt::format("heat cannot leave {} while the spindle is at rest: no film, contact, link, radiation or fixed "
                         "temperature leads to the ambient, so there is no steady state and there are no thermal "
                         "modes. Add one (a film of 0.001 W/(m^2 K) insulates), or take `solver: {{model: full}}`",
                         fmt::join(shut_in, ", ")));
}

void require_reached(const mesh::Mesh& mesh, const effects::HeatBalance& balance, const Where& where) {
  Paths paths(mesh, balance);
  add_exchanges(paths, mesh, balance, [](const effects::Law&) { return true; });
  for (const auto& heat : balance.heats) paths.connect(heat.body, paths.outside());
  const std::set<std::string> unreached = paths.shut_in();
  if (unreached.empty()) return;
  throw InputError(where, fmt::format("no heat reaches or leaves {}: no source, film, contact, link, radiation or fixed "
                                      "temperature among `effects` names it or a neighbour",
                                      fmt::join(unreached, ", ")));
}

}  // namespace driftwright::scenarios
