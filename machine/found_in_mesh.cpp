#include "machine/found_in_mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/lists.hpp"
#include "effects/flow_path.hpp"

namespace driftwright::scenarios {
namespace {

using mesh::Mesh;

[[noreturn]] void unknown_name(const Where& where, const std::string& what, const std::string& name,
                               const std::vector<std::string>& known) {
  if (known.empty()) throw InputError(where, fmt::format("the machine has no {} '{}', nor any other", what, name));
  const std::string near = nearest_word(name, known);
  throw InputError(where, fmt::format("the mesh has no {} '{}'; there are {}.{}", what, name, fmt::join(known, ", "),
                                      near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
}

/// Lumped nodes and the ambient. @throws InputError  if two effects make a node of the same name, or one called ambient
std::vector<std::string> node_names(const MachineModel& model) {
  std::vector<std::string> nodes = {effects::kAmbientName};
  for (const effects::Effect& e : model.effects) {
    for (const effects::LumpedNode& n : effects::heat_balance({e}).nodes) {
      if (n.name == effects::kAmbientName)
        throw InputError(
            e.where,
            fmt::format("'{}' is the air around every machine and no lumped node; give the node a name of its own", n.name));
      if (std::find(nodes.begin(), nodes.end(), n.name) != nodes.end()) {
        throw InputError(e.where,
                         fmt::format("there is a lumped node '{}' already; each requires a name of its own", n.name));
      }
      nodes.push_back(n.name);
    }
  }
  return nodes;
}

/// Checks that an effect that redirects the exchanges of others finds at least one.
void require_changed_paths(const MachineModel& model) {
  effects::HeatBalance balance;
  for (const effects::Effect& e : model.effects) {
    if (e.kind->contribute) e.kind->contribute(e, balance);
  }
  const auto surroundings = [&] {
    std::vector<std::string> names;
    for (const effects::Exchange& x : balance.exchanges) names.push_back(x.surrounding);
    for (const effects::Radiation& r : balance.radiations) names.push_back(r.surrounding);
    return names;
  };
  for (const effects::Effect& e : model.effects) {
    if (!e.kind->change_paths) continue;
    const std::vector<std::string> before = surroundings();
    e.kind->change_paths(e, balance);
    if (surroundings() == before)
      throw InputError(
          e.where,
          fmt::format("nothing leads from {} to the ambient that a {} could take; films and radiation of a region are "
                      "on its surfaces: name these, each once",
                      e.place, e.kind->key));
  }
}

}  // namespace

void must_be_one_of(const Where& where, const std::string& what, const std::string& name,
                    const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end()) unknown_name(where, what, name, known);
}

std::vector<std::string> outer_surfaces(const Mesh& mesh) {
  std::vector<std::string> names;
  for (const std::string& s : mesh.surfaces) {
    if (s.find('@') == std::string::npos) names.push_back(s);
  }
  return names;
}

std::vector<std::string> joint_names(const Mesh& mesh) {
  return names_of(mesh.joints);
}

void require_outside(const Mesh& mesh, const std::string& surface, const Where& where) {
  const std::vector<int> facets = mesh.facets_on(mesh.surface(surface));
  std::vector<char> is_first(mesh.n_nodes(), 0);  // node is the first corner of some facet
  for (int facet : facets) is_first[mesh.facets.nodes(facet)[0]] = 1;
  std::vector<std::vector<int>> cells_at(mesh.n_nodes());
  for (int c = 0; c < mesh.cells.size(); ++c) {
    for (int node : mesh.cells.nodes(c)) {
      if (is_first[node]) cells_at[node].push_back(c);
    }
  }
  for (int facet : facets) {
    const auto nodes = mesh.facets.nodes(facet);
    const auto n_behind = std::count_if(cells_at[nodes[0]].begin(), cells_at[nodes[0]].end(), [&](int c) {
      const auto of_cell = mesh.cells.nodes(c);
      return std::all_of(nodes.begin(), nodes.end(),
                         [&](int n) { return std::find(of_cell.begin(), of_cell.end(), n) != of_cell.end(); });
    });
    if (n_behind < 2) continue;
    const Eigen::Vector3d x_mm = 1e3 * mesh.coords.col(nodes[0]);
    throw InputError(where, fmt::format("surface '{}' lies inside a body at [{:.1f} mm, {:.1f} mm, {:.1f} mm]; films, heat, "
                                        "radiation, supports and joints require outer faces",
                                        surface, x_mm[0], x_mm[1], x_mm[2]));
  }
}

void check_effects(const MachineModel& model, const Mesh& mesh, const effects::HeatBalance& balance) {
  const std::vector<std::string> nodes = node_names(model);
  const auto must_exist = [&](const Where& where, effects::BodyKind kind, const std::string& name) {
    switch (kind) {
      case effects::BodyKind::kRegion:
        return must_be_one_of(where, "region", name, mesh.regions);
      case effects::BodyKind::kSurface:
        return must_be_one_of(where, "surface", name, outer_surfaces(mesh));
      case effects::BodyKind::kNode:
        return must_be_one_of(where, "lumped node", name, nodes);
      case effects::BodyKind::kJoint:
        return must_be_one_of(where, "joint", name, joint_names(mesh));
    }
  };
  std::vector<std::string> laws;
  balance.for_each_law([&](const std::string& name, const effects::Law&) { laws.push_back(name); });
  for (const effects::Effect& e : model.effects) {
    if (e.place_kind == effects::Place::kSensor || e.place_kind == effects::Place::kDisplacement ||
        e.place_kind == effects::Place::kClock || e.place_kind == effects::Place::kSpindle) {
      // not a part of the machine: check_instruments()
    } else if (e.place_kind == effects::Place::kLaw) {
      must_be_one_of(e.where, "heat or exchange", e.place, laws);
      const bool is_of_joint = std::any_of(balance.exchanges.begin(), balance.exchanges.end(), [&](const auto& x) {
        return x.name == e.place && x.body.kind == effects::BodyKind::kJoint;
      });
      if (const auto over = e.references.find("over"); over != e.references.end()) {
        bool is_own = false;
        for (const effects::HeatInput& h : balance.heats) is_own = is_own || (h.name == e.place && h.body == over->second);
        for (const effects::Exchange& x : balance.exchanges)
          is_own = is_own || (x.name == e.place && x.body == over->second);
        if (is_own)
          throw InputError(e.where,
                           fmt::format("'{}' is of {} itself; `over` names another body, whose temperature that of {} "
                                       "counts over",
                                       e.place, over->second.name, over->second.name));
      }
      if (is_of_joint && e["decay"] != 0.0)
        throw InputError(e.where, "`decay` requires a temperature, but a joint has none of its own");
      const bool has_medium = std::any_of(balance.exchanges.begin(), balance.exchanges.end(), [&](const auto& x) {
        return x.name == e.place && x.medium_K.has_value() && x.part.is_even();
      });
      if (e["warmer"] != 0.0 && !has_medium)
        throw InputError(e.where, fmt::format("'{}' has no medium of a stated temperature, which `warmer` requires: a "
                                              "coolant's `set_point` without `tank`, or a `medium`",
                                              e.place));
    } else if (e.place_kind == effects::Place::kNode && e.place == effects::kAmbientName) {
      throw InputError(e.where, "the ambient is no lumped node; nothing heats or holds it");
    } else {
      must_exist(e.where, e.body().kind, e.body().name);
    }
    for (const auto& [key, body] : e.references) {
      const auto written = e.reference_where.find(key);
      must_exist(written == e.reference_where.end() ? e.where : written->second, body.kind, body.name);
    }
    for (const effects::Mention& m : e.kind->mentions) {
      if (m.of != effects::Mention::Of::kBodies) continue;
      for (const std::string& name : effects::names_of_text(e.words.at(m.name))) {
        const Where& where = e.reference_where.at(m.name);
        if (e.place_kind == effects::Place::kNode && name == effects::kAmbientName)
          throw InputError(where, "the ambient is no lumped node; it cannot be in this list");
        must_exist(where, e.body().kind, name);
        if (e.place_kind == effects::Place::kSurface) require_outside(mesh, name, where);
      }
    }
  }
  for (const effects::Effect& e : model.effects) {
    if (e.place_kind == effects::Place::kSurface) require_outside(mesh, e.place, e.where);
  }
  require_changed_paths(model);
  for (std::size_t i = 0; i < model.effects.size(); ++i) {
    const effects::Effect& e = model.effects[i];
    const bool is_joint = e.kind->key == "contact";  // contacts that follow each other in time are allowed
    const bool is_single = e.kind->key == "fixed_temperature" || e.kind->key == "stratification" || is_joint;
    const auto follows = [&](const effects::Effect& a, const effects::Effect& b) {
      return is_joint && b.from_s >= a.until_s;
    };
    const bool again =
        std::any_of(model.effects.begin(), model.effects.begin() + static_cast<std::ptrdiff_t>(i), [&](auto& other) {
          const bool at_once = other.in.empty() || e.in.empty() || other.in == e.in;
          return other.kind == e.kind && other.place_kind == e.place_kind && other.place == e.place && at_once &&
                 !follows(other, e) && !follows(e, other);
        });
    if (is_single && again) throw InputError(e.where, fmt::format("{} is given twice there; which one is meant?", e.name()));
  }
  for (const mesh::Joint& joint : mesh.joints) {
    const bool has_contact = std::any_of(balance.exchanges.begin(), balance.exchanges.end(),
                                         [&](const effects::Exchange& e) { return e.body == effects::joint(joint.name); });
    for (const std::string& side : {joint.side_a, joint.side_b}) require_outside(mesh, side, model.where);
    if (!has_contact) {
      throw InputError(model.where,
                       fmt::format("joint '{}' has no contact; add {{type: contact, joint: {}, conductance: ... W/(m^2 K)}} "
                                   "to `effects` (0 W/(m^2 K) insulates)",
                                   joint.name, joint.name));
    }
  }
}

void check_bodies(const BySensitivity& by, const Mesh& mesh, const effects::HeatBalance& balance) {
  std::vector<std::string> nodes;
  for (const effects::LumpedNode& n : balance.nodes) nodes.push_back(n.name);
  for (const auto& [body, sensitivity_m_K] : by.terms) {
    const bool is_node = body.kind == effects::BodyKind::kNode;
    must_be_one_of(by.where, is_node ? "lumped node" : "region", body.name, is_node ? nodes : mesh.regions);
  }
}

}  // namespace driftwright::scenarios
