#include "machine/machine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <span>

#include "base/quantity.hpp"
#include "base/shown_units.hpp"
#include "machine/runnable.hpp"
#include "machine/ways_out.hpp"
#include "mesh/locate.hpp"
#include "mesh/shape.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/steady_state.hpp"
#include "solver/thermal_load.hpp"

namespace driftwright::scenarios {
namespace {

using mesh::Mesh;
using solver::DisplacementFunctional;

constexpr double kSnap_m = 5e-3;  ///< largest distance by which a sensor is moved onto its region

[[noreturn]] void unknown_name(const Where& where, const std::string& what, const std::string& name,
                               const std::vector<std::string>& known) {
  if (known.empty()) throw InputError(where, fmt::format("the machine has no {} '{}', nor any other", what, name));
  const std::string near = nearest_word(name, known);
  throw InputError(where, fmt::format("the mesh has no {} '{}'; there are {}.{}", what, name, fmt::join(known, ", "),
                                      near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
}

std::vector<std::string> outer_surfaces(const Mesh& mesh) {  // surfaces that may have films: not the sides of joints
  std::vector<std::string> names;
  for (const std::string& s : mesh.surfaces) {
    if (s.find('@') == std::string::npos) names.push_back(s);
  }
  return names;
}

std::vector<std::string> joint_names(const Mesh& mesh) {
  std::vector<std::string> names;
  for (const mesh::Joint& j : mesh.joints) names.push_back(j.name);
  return names;
}

void must_be_one_of(const Where& where, const std::string& what, const std::string& name,
                    const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end()) unknown_name(where, what, name, known);
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

/// Films and supports must be outside: a surface must not contain a facet between two cells.
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
      const bool has_medium = std::any_of(balance.exchanges.begin(), balance.exchanges.end(),
                                          [&](const auto& x) { return x.name == e.place && x.medium_K.has_value(); });
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

/// Checks the bodies of a displacement by sensitivities: regions and lumped nodes.
void check_bodies(const BySensitivity& by, const Mesh& mesh, const effects::HeatBalance& balance) {
  std::vector<std::string> nodes;
  for (const effects::LumpedNode& n : balance.nodes) nodes.push_back(n.name);
  for (const auto& [body, sensitivity_m_K] : by.terms) {
    const bool is_node = body.kind == effects::BodyKind::kNode;
    must_be_one_of(by.where, is_node ? "lumped node" : "region", body.name, is_node ? nodes : mesh.regions);
  }
}

/// The point of a region nearest to the position given by the user.
mesh::MeshPoint place_point(const Mesh& mesh, const PointOnRegion& point) {
  must_be_one_of(point.where, "region", point.region, mesh.regions);
  const std::vector<int> cells = mesh.cells_in(mesh.region(point.region));
  const mesh::MeshPoint found = mesh::nearest_point(mesh, mesh.cells, cells, point.at_m);
  if (!(found.distance_m <= kSnap_m)) {
    throw InputError(
        point.where,
        fmt::format("the point lies {:.1f} mm outside region '{}' (at most {:.0f} mm is moved); its nearest point is "
                    "[{:.1f} mm, {:.1f} mm, {:.1f} mm]",
                    1e3 * found.distance_m, point.region, 1e3 * kSnap_m, 1e3 * found.position_m[0],
                    1e3 * found.position_m[1], 1e3 * found.position_m[2]));
  }
  return found;
}

void add_displacement(DisplacementFunctional& d, const Mesh& mesh, const mesh::MeshPoint& at,
                      const Eigen::Vector3d& direction) {
  const auto s = mesh::shape_values(mesh.cells.shape[at.cell], at.xi);
  const auto nodes = mesh.cells.nodes(at.cell);
  for (int i = 0; i < s.n; ++i) d.terms.push_back({nodes[i], s.N[i] * direction});
}

/// Adds c·ω with the rotation ω = ½ curl u at a point: c·(∇N × u)/2 = u·(c × ∇N)/2.
void add_rotation(DisplacementFunctional& d, const Mesh& mesh, const mesh::MeshPoint& at, const Eigen::Vector3d& c) {
  const auto shape = mesh.cells.shape[at.cell];
  const auto s = mesh::shape_values(shape, at.xi);
  const auto nodes = mesh.cells.nodes(at.cell);
  const Eigen::Matrix3d inverse_t = mesh::jacobian(s, mesh::cell_coords(mesh, nodes), shape).dx_dxi.inverse().transpose();
  for (int i = 0; i < s.n; ++i) d.terms.push_back({nodes[i], 0.5 * c.cross(inverse_t * s.dN.col(i))});
}

DisplacementFunctional tool_against_table(const Mesh& mesh, const ToolAgainstTable& output) {
  const mesh::MeshPoint tool = place_point(mesh, output.tool);
  const Eigen::Vector3d direction = Eigen::Vector3d::Unit(output.axis);
  DisplacementFunctional d;  // e·(u_tool - u_table - ω_table × arm)
  add_displacement(d, mesh, tool, direction);
  if (!output.table) return d;
  PointOnRegion foot = *output.table;  // the point of the table that its travel has brought there
  foot.at_m -= output.travel_m;
  const mesh::MeshPoint table = place_point(mesh, foot);
  const Eigen::Vector3d arm = tool.position_m - (table.position_m + output.travel_m);
  add_displacement(d, mesh, table, -direction);
  add_rotation(d, mesh, table, -arm.cross(direction));
  return d;
}

DisplacementFunctional tilt_against_table(const Mesh& mesh, const TiltOutput& output) {
  const mesh::MeshPoint from = place_point(mesh, output.from), to = place_point(mesh, output.to);
  const Eigen::Vector3d line = to.position_m - from.position_m;
  // A rigid rotation ω turns the line by ω × line; the part about the axis is axis·(line × Δu)/|line_perpendicular|².
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(output.axis);
  const Eigen::Vector3d across = axis.cross(line) / axis.cross(line).squaredNorm();
  DisplacementFunctional d;
  add_displacement(d, mesh, to, across);
  add_displacement(d, mesh, from, -across);
  add_rotation(d, mesh, place_point(mesh, output.table), -axis);
  return d;
}

void multiply(solver::Material& material, const effects::MaterialFactor& factor) {
  material.conductivity_W_mK *= factor.conductivity;
  for (double& value : material.conductivity_curve.value) value *= factor.conductivity;
  material.heat_capacity_J_kgK *= factor.heat_capacity;
  for (double& value : material.heat_capacity_curve.value) value *= factor.heat_capacity;
  const solver::Expansion& e = material.expansion_1_K;
  material.expansion_1_K = {factor.expansion * e.x, factor.expansion * e.y, factor.expansion * e.z};
}

std::optional<solver::Elasticity> factorise(const MachineModel& model, const PlacedMachine& placed, int n_solves) {
  if (placed.mesh.n_nodes() == 0) return std::nullopt;
  try {
    return solver::Elasticity(placed.mesh, placed.materials, placed.supports, placed.joints,
                              solver::ElasticMethod::kAutomatic, n_solves);
  } catch (const InputError& e) {
    throw located(model, e);
  }
}

int n_functionals(const PlacedMachine& placed) {
  return static_cast<int>(placed.functionals.size());
}

/// True if a displacement or tilt is defined by points of the mesh, at least in part.
bool has_points(const MachineModel& model, std::size_t functional) {
  return functional >= model.displacements.size() || model.displacements[functional].points;
}

/// Elastic responses, one of each displacement or tilt; empty where that has no points.
std::vector<Eigen::VectorXd> responses(const MachineModel& model, const PlacedMachine& placed,
                                       const solver::Elasticity& elasticity) {
  std::vector<Eigen::VectorXd> all(placed.functionals.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (has_points(model, i)) all[i] = elasticity.response(placed.functionals[i]);
  }
  return all;
}

Eigen::MatrixXd influences(const MachineModel& model, const PlacedMachine& placed,
                           std::span<const Eigen::VectorXd> responses) {
  Eigen::MatrixXd influence =
      Eigen::MatrixXd::Zero(placed.mesh.n_nodes(), static_cast<Eigen::Index>(placed.functionals.size()));
  std::optional<solver::ThermalLoad> load;
  for (std::size_t i = 0; i < placed.functionals.size(); ++i) {
    if (!has_points(model, i)) continue;
    if (responses.empty()) throw std::logic_error("influences: a displacement without elasticity");
    if (!load) load.emplace(placed.mesh, placed.materials);
    influence.col(static_cast<Eigen::Index>(i)) = load->transposed(responses[i]);
  }
  return influence;
}

}  // namespace

solver::RegionMaterials region_materials(const MachineModel& model, const Mesh& mesh) {
  solver::RegionMaterials materials(mesh.regions.size());
  std::vector<bool> given(mesh.regions.size(), false);
  for (const MaterialEntry& entry : model.materials) {
    must_be_one_of(entry.where, "region", entry.region, mesh.regions);
    materials[mesh.region(entry.region)] = entry.material;
    given[mesh.region(entry.region)] = true;
  }
  for (std::size_t r = 0; r < given.size(); ++r) {
    if (!given[r])
      throw InputError(model.where, fmt::format("region '{}' has no material; add it under `materials`", mesh.regions[r]));
  }
  for (const effects::MaterialFactor& factor : effects::material_factors(model.effects)) {
    const auto region = std::find(mesh.regions.begin(), mesh.regions.end(), factor.body.name);
    if (factor.body.kind != effects::BodyKind::kRegion || !factor.displacement.empty() || region == mesh.regions.end())
      continue;  // place() reports this at the effect
    multiply(materials[static_cast<std::size_t>(region - mesh.regions.begin())], factor);
  }
  return materials;
}

PlacedMachine place(const MachineModel& model) {
  return place(model, build_mesh(model.mesh));
}

PlacedMachine place(const MachineModel& model, mesh::Mesh meshed) {
  PlacedMachine placed;
  placed.mesh = std::move(meshed);
  const Mesh& mesh = placed.mesh;
  placed.materials = region_materials(model, mesh);
  placed.balance = effects::heat_balance(model.effects);
  check_effects(model, mesh, placed.balance);
  require_reached(mesh, placed.balance, model.where);
  for (const SupportEntry& s : model.supports) {
    must_be_one_of(s.where, "surface", s.support.surface, outer_surfaces(mesh));
    require_outside(mesh, s.support.surface, s.where);
    placed.supports.push_back(s.support);
  }
  for (const JointEntry& j : model.joints) {
    must_be_one_of(j.where, "joint", j.mechanics.joint, joint_names(mesh));
    const bool again = std::any_of(placed.joints.begin(), placed.joints.end(),
                                   [&](const auto& other) { return other.joint == j.mechanics.joint; });
    if (again) throw InputError(j.where, fmt::format("joint '{}' is listed twice under `joints`", j.mechanics.joint));
    placed.joints.push_back(j.mechanics);
  }
  for (const Sensor& sensor : model.sensors) {
    std::vector<std::pair<int, double>> weights;
    if (const auto* point = std::get_if<PointOnRegion>(&sensor.place)) {
      const mesh::MeshPoint at = place_point(mesh, *point);
      const auto s = mesh::shape_values(mesh.cells.shape[at.cell], at.xi);
      for (int i = 0; i < s.n; ++i) weights.emplace_back(mesh.cells.nodes(at.cell)[i], s.N[i]);
    } else if (const std::string& node = std::get<std::string>(sensor.place); node != effects::kAmbientName) {
      std::vector<std::string> known = {effects::kAmbientName};
      for (std::size_t i = 0; i < placed.balance.nodes.size(); ++i) {
        known.push_back(placed.balance.nodes[i].name);
        if (known.back() == node) weights.emplace_back(mesh.n_nodes() + static_cast<int>(i), 1.0);
      }
      must_be_one_of(sensor.where, "lumped node", node, known);
    }
    placed.sensor_weights.push_back(std::move(weights));
  }
  for (const DisplacementOutput& d : model.displacements) {
    placed.functionals.push_back(d.points ? tool_against_table(mesh, *d.points) : DisplacementFunctional{});
    if (d.by_sensitivity) check_bodies(*d.by_sensitivity, mesh, placed.balance);
  }
  for (const TiltOutput& t : model.tilts) placed.functionals.push_back(tilt_against_table(mesh, t));
  return placed;
}

bool needs_elasticity(const PlacedMachine& placed, bool with_fields) {
  const auto& f = placed.functionals;
  const bool has_output = std::any_of(f.begin(), f.end(), [](const DisplacementFunctional& d) { return !d.terms.empty(); });
  return placed.mesh.n_nodes() > 0 && (with_fields || has_output);
}

Eigen::MatrixXd influences(const MachineModel& model, const PlacedMachine& placed) {
  const bool is_elastic = needs_elasticity(placed, false);
  const std::optional<solver::Elasticity> elasticity =
      is_elastic ? factorise(model, placed, n_functionals(placed)) : std::nullopt;
  return influences(model, placed, elasticity ? responses(model, placed, *elasticity) : std::vector<Eigen::VectorXd>{});
}

Machine build(const MachineModel& model, PlacedMachine placed, bool with_elasticity, int n_fields) {
  std::optional<solver::Elasticity> elasticity =
      with_elasticity ? factorise(model, placed, n_functionals(placed) + n_fields) : std::nullopt;
  std::vector<Eigen::VectorXd> solved;
  if (elasticity) solved = responses(model, placed, *elasticity);
  const Eigen::MatrixXd influence = influences(model, placed, solved);
  Machine machine = build_with_influences(model, std::move(placed), influence);
  machine.responses = std::move(solved);
  if (elasticity) machine.elasticity.emplace(std::move(*elasticity));
  return machine;
}

std::vector<effects::Body> bodies_of_readings(const MachineModel& model) {
  std::vector<effects::Body> bodies;
  for (const effects::Effect& e : model.effects) {
    if (!e.kind->change_readings) continue;
    for (const auto& [name, body] : e.references) {
      const bool is_new = std::find(bodies.begin(), bodies.end(), body) == bodies.end();
      if (is_new && !(body == effects::ambient_node())) bodies.push_back(body);
    }
  }
  return bodies;
}

solver::Outputs output_names(const MachineModel& model, const PlacedMachine& placed) {
  solver::Outputs out;
  for (const Sensor& s : model.sensors) {
    out.name.push_back(s.name);
    out.unit.emplace_back("K");
  }
  for (const DisplacementOutput& d : model.displacements) {
    out.name.push_back(d.name);
    out.unit.emplace_back("m");
  }
  for (const TiltOutput& t : model.tilts) {
    out.name.push_back(t.name);
    out.unit.emplace_back("rad");
  }
  for (const effects::Body& body : bodies_of_readings(model)) {
    out.name.push_back(effects::mean_output(body.name));
    out.unit.emplace_back("K");
  }
  out.ambient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(out.name.size()));
  for (std::size_t i = 0; i < placed.sensor_weights.size(); ++i) {
    if (placed.sensor_weights[i].empty()) out.ambient[static_cast<Eigen::Index>(i)] = 1.0;
  }
  return out;
}

Machine build_with_influences(const MachineModel& model, PlacedMachine placed, const Eigen::MatrixXd& influence) {
  Machine machine{std::move(placed), std::nullopt, {}, {}};
  machine.system =
      solver::assemble_heat(machine.placed.mesh, machine.placed.materials, machine.placed.balance, model.reference_K);
  solver::Outputs& out = machine.system.outputs;
  const auto n_sensors = model.sensors.size();
  out = output_names(model, machine.placed);
  out.state = Eigen::MatrixXd::Zero(machine.system.size(), static_cast<Eigen::Index>(out.name.size()));
  for (std::size_t i = 0; i < n_sensors; ++i) {
    for (const auto& [unknown, weight] : machine.placed.sensor_weights[i]) {
      out.state(unknown, static_cast<Eigen::Index>(i)) += weight;
    }
  }
  const std::vector<effects::MaterialFactor> factors = effects::material_factors(model.effects);
  for (std::size_t i = 0; i < machine.placed.functionals.size(); ++i) {
    auto output = out.state.col(static_cast<Eigen::Index>(n_sensors + i));
    if (has_points(model, i)) output.head(machine.placed.mesh.n_nodes()) = influence.col(static_cast<Eigen::Index>(i));
    if (i >= model.displacements.size() || !model.displacements[i].by_sensitivity) continue;
    for (const auto& [body, sensitivity_m_K] : model.displacements[i].by_sensitivity->terms) {
      output += effects::sensitivity_factor(factors, body, model.displacements[i].name) * sensitivity_m_K *
                solver::mean_weights(machine.placed.mesh, machine.placed.balance, body);
    }
  }
  Eigen::Index mean = out.state.cols() - static_cast<Eigen::Index>(bodies_of_readings(model).size());
  for (const effects::Body& body : bodies_of_readings(model)) {
    out.state.col(mean++) = solver::mean_weights(machine.placed.mesh, machine.placed.balance, body);
  }
  return machine;
}

Eigen::VectorXd start_state(const MachineModel& model, const Machine& machine) {
  const int n = machine.system.size();
  const double ambient_K = felt_ambient_at_start_K(model);
  switch (model.start) {
    case Start::kReference:
      return Eigen::VectorXd::Zero(n);
    case Start::kAmbient:
      return Eigen::VectorXd::Constant(n, ambient_K);
    case Start::kUniform:
      return Eigen::VectorXd::Constant(n, model.start_K - model.reference_K);
    case Start::kSteady:
      require_ways_out(machine.placed.mesh, machine.placed.balance, model.where);
      return solver::steady_state(machine.system, {.drive = {}, .ambient_K = ambient_K},
                                  Eigen::VectorXd::Constant(n, ambient_K));
  }
  throw std::logic_error("start_state: no such start");
}

namespace {

/// Adds channels for the drives that the cyclogram uses besides the spindle speed.
void add_feeds_and_cutting_power(Record& record, const Cyclogram& cyclogram) {
  const auto add = [&](const char* name, const char* unit, const auto& of_drive) {
    const auto& sections = cyclogram.sections;
    if (std::none_of(sections.begin(), sections.end(), [&](const auto& s) { return of_drive(s.drive) != 0.0; })) return;
    Channel channel{name, unit, {}};
    for (double t_s : record.time_s) channel.values.push_back(of_drive(cyclogram.drive(t_s)));
    record.channels.push_back(std::move(channel));
  };
  constexpr double kMmMin_per_m_s = 60e3;
  add("feed_x", "mm_min", [](const Drive& d) { return kMmMin_per_m_s * d.feed_m_s[0]; });
  add("feed_y", "mm_min", [](const Drive& d) { return kMmMin_per_m_s * d.feed_m_s[1]; });
  add("feed_z", "mm_min", [](const Drive& d) { return kMmMin_per_m_s * d.feed_m_s[2]; });
  add("cutting_power", "W", [](const Drive& d) { return d.cutting_power_W; });
}

}  // namespace

Record to_record(const solver::Trajectory& run, const solver::Outputs& outputs, const Cyclogram& cyclogram,
                 double reference_K) {
  Record record{.source = cyclogram.name, .time_s = run.time_s, .channels = {}};
  Channel speed{"speed", "rpm", {}};
  for (double t_s : run.time_s) speed.values.push_back(cyclogram.speed_rpm(t_s));
  record.channels.push_back(std::move(speed));
  add_feeds_and_cutting_power(record, cyclogram);
  for (std::size_t i = 0; i < outputs.name.size(); ++i) {
    if (effects::is_mean_output(outputs.name[i])) continue;  // not an instrument
    const auto row = run.outputs.row(static_cast<Eigen::Index>(i));
    Channel channel{outputs.name[i], shown_reading_unit(outputs.unit[i]), {}};
    const double factor = shown_scale(outputs.unit[i]);
    const double offset = outputs.unit[i] == "K" ? reference_K - kZeroCelsius_K : 0.0;
    for (Eigen::Index k = 0; k < row.size(); ++k) channel.values.push_back(factor * row[k] + offset);
    record.channels.push_back(std::move(channel));
  }
  return record;
}

std::vector<double> output_times_s(const Cyclogram& cyclogram, double interval_s, const std::vector<double>& further_s) {
  std::vector<double> times_s;
  const double end_s = cyclogram.duration_s();
  for (int i = 0; i * interval_s < end_s * (1 - 1e-12); ++i) times_s.push_back(i * interval_s);
  for (double t_s : further_s) {
    if (t_s < end_s * (1 - 1e-12)) times_s.push_back(t_s);
  }
  times_s.push_back(end_s);
  std::sort(times_s.begin(), times_s.end());
  const auto same = [](double a, double b) { return b - a <= 1e-9 * b; };  // sums of intervals differ by rounding
  times_s.erase(std::unique(times_s.begin(), times_s.end(), same), times_s.end());
  return times_s;
}

}  // namespace driftwright::scenarios
