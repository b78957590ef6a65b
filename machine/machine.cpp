#include "machine/machine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <span>

#include "base/quantity.hpp"
#include "base/shown_units.hpp"
#include "machine/channel_sections.hpp"
#include "machine/found_in_mesh.hpp"
#include "machine/poses.hpp"
#include "machine/runnable.hpp"
#include "machine/ways_out.hpp"
#include "mesh/locate.hpp"
#include "mesh/shape.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/share.hpp"
#include "solver/steady_state.hpp"
#include "solver/thermal_load.hpp"

namespace driftwright::scenarios {
namespace {

using mesh::Mesh;
using solver::DisplacementFunctional;

constexpr double kSnap_m = 5e-3;  ///< largest distance by which a sensor is moved onto its region

/// The point of a region nearest to the position given by the user, which is where the region was drawn.
mesh::MeshPoint place_point(const MachineModel& model, const Mesh& mesh, const PointOnRegion& point) {
  must_be_one_of(point.where, "region", point.region, mesh.regions);
  const std::vector<int> cells = mesh.cells_in(mesh.region(point.region));
  const mesh::Motion motion = motion_of(model.axes, point.region);
  const mesh::MeshPoint found = mesh::nearest_point(mesh, mesh.cells, cells, motion(point.at_m));
  if (!(found.distance_m <= kSnap_m)) {
    const Eigen::Vector3d drawn_m = motion.before(found.position_m);
    throw InputError(
        point.where,
        fmt::format("the point lies {:.1f} mm outside region '{}' (at most {:.0f} mm is moved); its nearest point is "
                    "[{:.1f} mm, {:.1f} mm, {:.1f} mm]",
                    1e3 * found.distance_m, point.region, 1e3 * kSnap_m, 1e3 * drawn_m[0], 1e3 * drawn_m[1],
                    1e3 * drawn_m[2]));
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

/// Adds -e·(u_foot + ω_foot × arm): what a stand on the foot takes with it.
void add_stand(DisplacementFunctional& d, const Mesh& mesh, const mesh::MeshPoint& foot, const Eigen::Vector3d& arm_m,
               const Eigen::Vector3d& direction) {
  add_displacement(d, mesh, foot, -direction);
  add_rotation(d, mesh, foot, -arm_m.cross(direction));
}

DisplacementFunctional tool_against_table(const MachineModel& model, const Mesh& mesh, const ToolAgainstTable& output) {
  const mesh::MeshPoint tool = place_point(model, mesh, output.tool);
  const Eigen::Vector3d direction = Eigen::Vector3d::Unit(output.axis);
  DisplacementFunctional d;  // e·(u_tool - u_table - ω_table × arm)
  add_displacement(d, mesh, tool, direction);
  if (!output.table) return d;
  PointOnRegion foot = *output.table;  // the point of the table that its travel has brought there
  foot.at_m -= output.travel_m;
  const mesh::MeshPoint table = place_point(model, mesh, foot);
  add_stand(d, mesh, table, tool.position_m - (table.position_m + output.travel_m), direction);
  return d;
}

DisplacementFunctional tilt_against_table(const MachineModel& model, const Mesh& mesh, const TiltOutput& output) {
  const mesh::MeshPoint from = place_point(model, mesh, output.from), to = place_point(model, mesh, output.to);
  const Eigen::Vector3d line = to.position_m - from.position_m;
  // A rigid rotation ω turns the line by ω × line; the part about the axis is axis·(line × Δu)/|line_perpendicular|².
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(output.axis);
  const Eigen::Vector3d across = axis.cross(line) / axis.cross(line).squaredNorm();
  DisplacementFunctional d;
  add_displacement(d, mesh, to, across);
  add_displacement(d, mesh, from, -across);
  add_rotation(d, mesh, place_point(model, mesh, output.table), -axis);
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

std::optional<solver::Elasticity> factorise(const MachineModel& model, const PlacedMachine& placed, int n_solves,
                                            std::shared_ptr<const solver::Share> share = nullptr) {
  if (placed.mesh.n_nodes() == 0) return std::nullopt;
  try {
    return solver::Elasticity(placed.mesh, placed.materials, placed.supports, placed.joints,
                              solver::ElasticMethod::kAutomatic, n_solves, std::move(share));
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

/// @param mesh  of the machine, or of the part of it that the responses are of
Eigen::MatrixXd influences(const MachineModel& model, const PlacedMachine& placed, const Mesh& mesh,
                           std::span<const Eigen::VectorXd> responses) {
  Eigen::MatrixXd influence = Eigen::MatrixXd::Zero(mesh.n_nodes(), static_cast<Eigen::Index>(placed.functionals.size()));
  std::optional<solver::ThermalLoad> load;
  for (std::size_t i = 0; i < placed.functionals.size(); ++i) {
    if (!has_points(model, i)) continue;
    if (responses.empty()) throw std::logic_error("influences: a displacement without elasticity");
    if (!load) load.emplace(mesh, placed.materials);
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
  add_channel_sections(model, meshed);
  move_bodies(model, meshed);
  return place_again(model, std::move(meshed));
}

PlacedMachine place_again(const MachineModel& model, mesh::Mesh meshed) {
  PlacedMachine placed;
  placed.mesh = std::move(meshed);
  const Mesh& mesh = placed.mesh;
  placed.materials = region_materials(model, mesh);
  placed.balance = effects::heat_balance(model.effects);
  check_effects(model, mesh, placed.balance);
  placed.films = mapped_films(model.effects, mesh);
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
    placed.joints.push_back(mechanics_at_pose(model, mesh, j));
  }
  for (const Sensor& sensor : model.sensors) {
    std::vector<std::pair<int, double>> weights;
    if (const auto* point = std::get_if<PointOnRegion>(&sensor.place)) {
      const mesh::MeshPoint at = place_point(model, mesh, *point);
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
    placed.functionals.push_back(d.points ? tool_against_table(model, mesh, *d.points) : DisplacementFunctional{});
    if (d.by_sensitivity) check_bodies(*d.by_sensitivity, mesh, placed.balance);
  }
  for (const TiltOutput& t : model.tilts) placed.functionals.push_back(tilt_against_table(model, mesh, t));
  return placed;
}

ToolAgainstWork tool_against_work(const MachineModel& model, const Mesh& mesh, const PointOnRegion& tool,
                                  const std::string& work, const Where& where, const std::optional<ToolAndBall>& between) {
  must_be_one_of(where, "region", work, mesh.regions);
  const mesh::MeshPoint at = place_point(model, mesh, tool);
  const auto [end_m, ball_m] = between.value_or(ToolAndBall{at.position_m, at.position_m});
  const mesh::MeshPoint foot = mesh::nearest_point(mesh, mesh.cells, mesh.cells_in(mesh.region(work)), ball_m);
  ToolAgainstWork error{.place_m = motion_of(model.axes, work).before(end_m), .functionals = {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i));
    add_stand(error.functionals[i], mesh, at, end_m - at.position_m, -direction);
    add_stand(error.functionals[i], mesh, foot, ball_m - foot.position_m, direction);
    add_rotation(error.functionals[3 + i], mesh, at, direction);
    add_rotation(error.functionals[3 + i], mesh, foot, -direction);
  }
  return error;
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
  return influences(model, placed, placed.mesh,
                    elasticity ? responses(model, placed, *elasticity) : std::vector<Eigen::VectorXd>{});
}

Machine build(const MachineModel& model, PlacedMachine placed, bool with_elasticity, int n_fields,
              const solver::Ranks* ranks) {
  const std::shared_ptr<const solver::Share> share = ranks ? ranks->split(placed.mesh, placed.balance) : nullptr;
  std::optional<solver::Elasticity> elasticity =
      with_elasticity ? factorise(model, placed, n_functionals(placed) + n_fields, share) : std::nullopt;
  std::vector<Eigen::VectorXd> solved;
  if (elasticity) solved = responses(model, placed, *elasticity);
  const Eigen::MatrixXd influence = influences(model, placed, share ? share->mesh : placed.mesh, solved);
  if (share) solved.clear();
  Machine machine = build_with_influences(model, std::move(placed), influence, share);
  machine.responses = std::move(solved);
  if (elasticity) machine.elasticity.emplace(std::move(*elasticity));
  return machine;
}

std::vector<effects::Body> bodies_of_readings(const MachineModel& model) {
  std::vector<effects::Body> bodies;
  for (const effects::Effect& e : model.effects) {
    for (const effects::Body& body : effects::bodies_read(e)) {
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

Machine build_with_influences(const MachineModel& model, PlacedMachine placed, const Eigen::MatrixXd& influence,
                              std::shared_ptr<const solver::Share> share) {
  Machine machine{std::move(placed), std::nullopt, {}, {}};
  const Mesh& mesh = share ? share->mesh : machine.placed.mesh;
  machine.system = solver::assemble_heat(mesh, machine.placed.materials, machine.placed.balance, model.reference_K, share);
  solver::Outputs& out = machine.system.outputs;
  const auto n_sensors = model.sensors.size();
  out = output_names(model, machine.placed);
  out.state = Eigen::MatrixXd::Zero(machine.system.size(), static_cast<Eigen::Index>(out.name.size()));
  for (std::size_t i = 0; i < n_sensors; ++i) {
    for (const auto& [unknown, weight] : machine.placed.sensor_weights[i]) {
      const int at = share ? share->held_index(unknown) : unknown;
      if (at >= 0) out.state(at, static_cast<Eigen::Index>(i)) += weight;
    }
  }
  const std::vector<effects::MaterialFactor> factors = effects::material_factors(model.effects);
  for (std::size_t i = 0; i < machine.placed.functionals.size(); ++i) {
    auto output = out.state.col(static_cast<Eigen::Index>(n_sensors + i));
    if (has_points(model, i)) output.head(mesh.n_nodes()) = influence.col(static_cast<Eigen::Index>(i));
    if (i >= model.displacements.size() || !model.displacements[i].by_sensitivity) continue;
    for (const auto& [body, sensitivity_m_K] : model.displacements[i].by_sensitivity->terms) {
      output += effects::sensitivity_factor(factors, body, model.displacements[i].name) * sensitivity_m_K *
                solver::mean_weights(mesh, machine.placed.balance, body, share.get());
    }
  }
  Eigen::Index mean = out.state.cols() - static_cast<Eigen::Index>(bodies_of_readings(model).size());
  for (const effects::Body& body : bodies_of_readings(model)) {
    out.state.col(mean++) = solver::mean_weights(mesh, machine.placed.balance, body, share.get());
  }
  return machine;
}

Eigen::VectorXd start_state(const MachineModel& model, const Machine& machine) {
  const int n = machine.n_unknowns();
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

}  // namespace driftwright::scenarios
