#include "blind/subject.hpp"

#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "solver/heat_assembly.hpp"

namespace driftwright::blind {
namespace {

using solver::SparseRow;

constexpr double kStratificationLevel_m = 1.2;

std::string text_of(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw InputError("blind: cannot read " + path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void refine(scenarios::MeshRecipe& recipe, double share) {
  if (auto* mill = std::get_if<mesh::KneeMill>(&recipe)) {
    mill->coarse_m *= share;
    mill->fine_m *= share;
  } else if (auto* drawing = std::get_if<mesh::ImportedMesh>(&recipe)) {
    drawing->mesh_size_m *= share;
    for (auto& [region, size_m] : drawing->mesh_size_of_region_m) size_m *= share;
  }
}

/// Standard deviations of logarithms, by effect and parameter. Conditions, dimensions and loads are known.
const std::map<std::string, std::map<std::string, double>>& scatters() {
  constexpr double kValue = 0.10, kExponent = 0.03;
  static const std::map<std::string, std::map<std::string, double>> table = {
      {"bearing_friction", {{"f0", kValue}}},
      {"motor_loss", {{"power", kValue}, {"idle", kValue}, {"exponent", kExponent}}},
      {"heat_source", {{"power", kValue}, {"exponent", kExponent}}},
      {"convection", {{"film", kValue}}},
      {"forced_convection", {{"growth", kValue}, {"exponent", kExponent}}},
      {"contact", {{"conductance", kValue}}},
      {"link", {{"conductance", kValue}}},
      {"node", {{"capacity", kValue}}},
      {"air_node", {{"capacity", kValue}, {"exchange", kValue}}},
      {"radiation", {{"emissivity", kValue}}},
      {"coolant", {{"flow", kValue}, {"passage_conductance", kValue}, {"tank_exchange", kValue}, {"pump_power", kValue}}},
  };
  return table;
}

std::vector<ScatterParameter> scatter_of(const Subject& s) {
  using Of = ScatterParameter::Of;
  std::vector<ScatterParameter> list;
  for (std::size_t e = 0; e < s.model.effects.size(); ++e) {
    const effects::Effect& effect = s.model.effects[e];
    const auto known = scatters().find(effect.kind->key);
    if (known == scatters().end()) continue;
    for (std::size_t p = 0; p < effect.kind->parameters.size(); ++p) {
      const auto& name = effect.kind->parameters[p].name;
      const auto sigma = known->second.find(name);
      if (sigma == known->second.end() || !(effect.values[p] != 0.0)) continue;
      list.push_back({effect.name() + " " + name, sigma->second, Of::kEffect, e, p, effect.name()});
    }
  }
  for (std::size_t r = 0; r < s.placed.mesh.regions.size(); ++r) {
    const std::string& region = s.placed.mesh.regions[r];
    list.push_back({"conductivity " + region, 0.1, Of::kConductivity, r, 0, region});
    list.push_back({"heat_capacity " + region, 0.1, Of::kHeatCapacity, r, 0, region});
    list.push_back({"expansion " + region, 0.1, Of::kExpansion, r, 0, region});
  }
  for (std::size_t d = 0; d < s.model.displacements.size(); ++d) {
    const auto& by = s.model.displacements[d].by_sensitivity;
    for (std::size_t t = 0; by && t < by->terms.size(); ++t) {
      list.push_back({"sensitivity " + s.model.displacements[d].name + " " + by->terms[t].body.name, 0.1, Of::kSensitivity,
                      d, t, s.model.displacements[d].name});
    }
  }
  return list;
}

solver::RegionMaterials scaled_materials(const Subject& s, const Values& v) {
  solver::RegionMaterials materials = s.placed.materials;
  for (std::size_t r = 0; r < materials.size(); ++r) {
    materials[r].conductivity_W_mK *= v.conductivity[r];
    materials[r].heat_capacity_J_kgK *= v.heat_capacity[r];
  }
  return materials;
}

/// Weights of displacements by sensitivities on a basis of means.
template <class Matrix>
void add_sensitivities(const Subject& s, const Values& v, Network<Matrix>& net) {
  for (std::size_t d = 0; d < s.model.displacements.size(); ++d) {
    const auto& by = s.model.displacements[d].by_sensitivity;
    if (!by) continue;
    if (s.model.displacements[d].points) throw std::logic_error("blind: a displacement of both points and sensitivities");
    auto column = net.outputs.col(static_cast<Eigen::Index>(s.n_sensors() + d));
    column.setZero();
    for (std::size_t t = 0; t < by->terms.size(); ++t) {
      column += v.sensitivity[d][t] * by->terms[t].sensitivity_m_K * net.means.at(by->terms[t].body.name);
    }
  }
}

FullNetwork assembled(const Subject& s, const Values& v, bool with_gradient) {
  effects::HeatBalance balance = balance_of(s, v);
  if (with_gradient) balance.stratifications.push_back({1.0, kStratificationLevel_m});
  const solver::RegionMaterials materials = scaled_materials(s, v);
  const solver::FullSystem system = solver::assemble_heat(s.placed.mesh, materials, balance, s.model.reference_K);
  if (!system.nonlinear.empty() || system.capacity || !system.fixed.empty() || !system.thermostats.empty()) {
    throw std::logic_error("blind: a machine with radiation, varying materials, held temperatures or thermostats");
  }
  FullNetwork net;
  net.reference_K = s.model.reference_K;
  net.mass = system.mass;
  net.conduction = system.conduction;
  for (const auto& source : system.sources) net.sources.push_back(source.load);
  for (const auto& e : system.exchanges) net.exchanges.push_back({e.matrix, e.to_ambient, e.offset});
  for (const std::string& r : s.placed.mesh.regions) {
    net.means[r] = solver::mean_weights(s.placed.mesh, balance, effects::region(r));
  }
  for (const std::string& n : s.nodes) net.means[n] = solver::mean_weights(s.placed.mesh, balance, effects::node(n));
  const auto n_outputs = static_cast<Eigen::Index>(s.n_outputs());
  net.outputs = Eigen::MatrixXd::Zero(system.size(), n_outputs);
  net.outputs_ambient = Eigen::VectorXd::Zero(n_outputs);
  for (std::size_t i = 0; i < s.n_sensors(); ++i) {
    for (const auto& [unknown, weight] : s.placed.sensor_weights[i])
      net.outputs(unknown, static_cast<Eigen::Index>(i)) += weight;
    if (s.placed.sensor_weights[i].empty()) net.outputs_ambient[static_cast<Eigen::Index>(i)] = 1.0;
  }
  for (std::size_t r = 0; r < s.influence.size(); ++r) {
    net.outputs.block(0, static_cast<Eigen::Index>(s.n_sensors()), s.influence[r].rows(), s.influence[r].cols()) +=
        v.expansion[r] * s.influence[r];
  }
  add_sensitivities(s, v, net);
  return net;
}

void find_influences(Subject& s) {
  const std::size_t n_regions = s.placed.mesh.regions.size();
  const auto n_outputs = static_cast<Eigen::Index>(s.model.displacements.size());
  for (std::size_t r = 0; r < n_regions; ++r) {
    solver::RegionMaterials one = s.placed.materials;
    for (std::size_t other = 0; other < n_regions; ++other) {
      if (other != r) one[other].expansion_1_K = 0.0;
    }
    const solver::Elasticity elasticity(s.placed.mesh, one, s.placed.supports, s.placed.joints,
                                        solver::ElasticMethod::kFactor, static_cast<int>(n_outputs));
    Eigen::MatrixXd influence(s.placed.mesh.n_nodes(), n_outputs);
    for (Eigen::Index d = 0; d < n_outputs; ++d) {
      influence.col(d) = elasticity.influence(s.placed.functionals[static_cast<std::size_t>(d)]);
    }
    s.influence.push_back(std::move(influence));
  }
}

/// Answers to every source, film, joint and gradient at six shifts, made M-orthonormal.
Eigen::MatrixXd answers(const Subject& s, const FullNetwork& net, const effects::HeatBalance& balance) {
  using Columns = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;
  const Laws laws = laws_of(balance);
  std::vector<Eigen::VectorXd> inputs = net.sources;
  SparseRow k = net.conduction;
  const effects::Inputs u{.drive = {.speed_rpm = 0.5 * s.top_speed_rpm}, .ambient_K = 0.0, .time_s = 0.0, .probe_K = {}};
  for (std::size_t e = 0; e < net.exchanges.size(); ++e) {
    const auto& exchange = net.exchanges[e];
    k += laws.coefficients[e](u) * exchange.matrix;
    if (exchange.ambient.squaredNorm() > 0.0) inputs.push_back(exchange.ambient);
    if (exchange.offset.size() > 0) inputs.push_back(exchange.offset);
  }
  const solver::FullSystem system = solver::assemble_heat(s.placed.mesh, s.placed.materials, balance, s.model.reference_K);
  for (const auto& e : system.exchanges) {
    if (e.place.body.kind == effects::BodyKind::kJoint) inputs.push_back(e.flow);
  }
  const std::vector<double> shifts_1_s = {1e-5, 1e-4, 4e-4, 1.5e-3, 6e-3, 3e-2};
  Eigen::MatrixXd columns(net.size(), static_cast<Eigen::Index>(inputs.size() * shifts_1_s.size()));
  Eigen::Index column = 0;
  for (const double shift : shifts_1_s) {
    const SparseRow shifted = k + shift * net.mass;
    Eigen::CholmodSupernodalLLT<Columns, Eigen::Lower> llt;
    llt.cholmod().print = 0;
    llt.compute(Columns(Eigen::SparseMatrix<double, Eigen::ColMajor, int>(shifted.transpose())));
    for (const Eigen::VectorXd& b : inputs) {
      const Eigen::VectorXd x = llt.solve(b);
      columns.col(column++) = x / std::sqrt(x.dot(net.mass * x));
    }
  }
  const Eigen::MatrixXd gram = columns.transpose() * (net.mass * columns);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (gram + gram.transpose()));
  constexpr Eigen::Index kMostStates = 130;
  Eigen::Index n = 0;
  while (n < std::min(kMostStates, gram.rows()) &&
         eigen.eigenvalues()[gram.rows() - 1 - n] > 1e-11 * eigen.eigenvalues()[gram.rows() - 1]) {
    ++n;
  }
  return columns * (eigen.eigenvectors().rightCols(n) * eigen.eigenvalues().tail(n).cwiseSqrt().cwiseInverse().asDiagonal());
}

void find_small(Subject& s) {
  const Values nominal = nominal_values(s);
  const effects::HeatBalance balance = balance_of(s, nominal);
  const FullNetwork net = assembled(s, nominal, !s.is_lumped());
  Eigen::MatrixXd basis;
  if (s.is_lumped()) {
    basis = Eigen::VectorXd(net.mass.diagonal().cwiseSqrt().cwiseInverse()).asDiagonal();
  } else {
    basis = answers(s, net, balance);
  }
  const auto reduced = [&](const SparseRow& a) -> Eigen::MatrixXd {
    const Eigen::MatrixXd r = basis.transpose() * (a * basis);
    return 0.5 * (r + r.transpose());
  };
  s.small.reference_K = net.reference_K;
  s.small.mass = reduced(net.mass);
  s.small.conduction = reduced(net.conduction);
  for (const auto& b : net.sources) s.small.sources.push_back(basis.transpose() * b);
  for (const auto& e : net.exchanges) {
    s.small.exchanges.push_back({reduced(e.matrix), basis.transpose() * e.ambient,
                                 e.offset.size() > 0 ? Eigen::VectorXd(basis.transpose() * e.offset) : Eigen::VectorXd()});
  }
  for (const auto& [name, weights] : net.means) s.small.means[name] = basis.transpose() * weights;
  s.small.outputs = basis.transpose() * net.outputs;
  s.small.outputs_ambient = net.outputs_ambient;
  for (std::size_t r = 0; r < s.placed.mesh.regions.size(); ++r) {
    Values twice = nominal;
    twice.conductivity[r] = twice.heat_capacity[r] = 2.0;
    const solver::FullSystem more =
        solver::assemble_heat(s.placed.mesh, scaled_materials(s, twice), effects::heat_balance(s.model.effects));
    s.small_mass.push_back(reduced(more.mass) - s.small.mass);
    s.small_conduction.push_back(reduced(more.conduction) - s.small.conduction);
    s.small_displacement.push_back(basis.topRows(s.placed.mesh.n_nodes()).transpose() * s.influence[r]);
  }
  s.small_node = basis.bottomRows(static_cast<Eigen::Index>(s.nodes.size())).transpose();
}

}  // namespace

const std::vector<std::string>& subject_names() {
  static const std::vector<std::string> names = {"motor_spindle",   "knee_mill",      "headstock_chain", "c_frame",
                                                 "gearbox_spindle", "tool_room_mill", "ball_screw_axis", "iron_frame"};
  return names;
}

Subject make_subject(const std::string& folder, const std::string& name, double mesh_share) {
  Subject s;
  s.name = name;
  const std::string path = folder + "/" + name + ".yaml";
  s.yaml = text_of(path);
  const scenarios::Scenario scenario = scenarios::read_scenario(path);
  s.model = scenario.machine.value();
  const std::string mesh_key = "mesh: ../../../";
  if (const auto at = s.yaml.find(mesh_key); at != std::string::npos) {
    s.drawing = std::get<mesh::ImportedMesh>(s.model.mesh).path;
    const auto end = s.yaml.find('\n', at);
    s.yaml.replace(at, end - at, "mesh: ../parts/" + s.drawing.substr(s.drawing.rfind('/') + 1));
  }
  refine(s.model.mesh, mesh_share);
  s.placed = scenarios::place(s.model);
  for (const effects::LumpedNode& n : s.placed.balance.nodes) {
    s.nodes.push_back(n.name);
    s.node_capacity_J_K.push_back(n.capacity_J_K);
  }
  for (const effects::Effect& e : s.model.effects) {
    for (std::size_t p = 0; p < e.values.size(); ++p) {
      if (e.kind->parameters[p].name == "at_speed") s.top_speed_rpm = std::max(s.top_speed_rpm, e.values[p]);
    }
  }
  s.scatter = scatter_of(s);
  if (!s.is_lumped()) find_influences(s);
  find_small(s);
  return s;
}

Values nominal_values(const Subject& s) {
  Values v;
  v.effects = s.model.effects;
  v.conductivity = v.heat_capacity = v.expansion = std::vector<double>(s.placed.mesh.regions.size(), 1.0);
  v.node_capacity.assign(s.nodes.size(), 1.0);
  for (const auto& d : s.model.displacements) {
    v.sensitivity.emplace_back(d.by_sensitivity ? d.by_sensitivity->terms.size() : 0, 1.0);
  }
  return v;
}

void scale(Values& values, const ScatterParameter& p, double factor) {
  switch (p.of) {
    case ScatterParameter::Of::kEffect:
      values.effects[p.index].values[p.term] *= factor;
      return;
    case ScatterParameter::Of::kConductivity:
      values.conductivity[p.index] *= factor;
      return;
    case ScatterParameter::Of::kHeatCapacity:
      values.heat_capacity[p.index] *= factor;
      return;
    case ScatterParameter::Of::kExpansion:
      values.expansion[p.index] *= factor;
      return;
    case ScatterParameter::Of::kSensitivity:
      values.sensitivity[p.index][p.term] *= factor;
      return;
  }
}

effects::HeatBalance balance_of(const Subject& s, const Values& values) {
  effects::HeatBalance balance = effects::heat_balance(values.effects);
  for (std::size_t n = 0; n < balance.nodes.size(); ++n) balance.nodes[n].capacity_J_K *= values.node_capacity[n];
  const auto nothing = [](const effects::Inputs&) { return 0.0; };
  for (const std::string& r : s.placed.mesh.regions) balance.heats.push_back({"spare " + r, effects::region(r), nothing});
  for (const std::string& n : s.nodes) balance.heats.push_back({"spare " + n, effects::node(n), nothing});
  for (const std::string& name : s.placed.mesh.surfaces) {
    if (name.find('@') != std::string::npos) continue;  // a side of a joint
    balance.heats.push_back({"spare " + name, effects::surface(name), nothing});
    effects::HeatBalance spare;
    spare.exchanges.push_back(effects::make_film("spare " + name, name, nothing));
    balance.append(std::move(spare));
  }
  return balance;
}

FullNetwork full_network(const Subject& s, const Values& values) {
  return assembled(s, values, !s.is_lumped());
}

SmallNetwork small_network(const Subject& s, const Values& v) {
  SmallNetwork net = s.small;
  const effects::HeatBalance balance = effects::heat_balance(v.effects);
  for (std::size_t n = 0; n < s.nodes.size(); ++n) {
    const double more_J_K = balance.nodes[n].capacity_J_K * v.node_capacity[n] - s.node_capacity_J_K[n];
    const Eigen::VectorXd column = s.small_node.col(static_cast<Eigen::Index>(n));
    if (more_J_K != 0.0) net.mass += more_J_K * column * column.transpose();
  }
  for (std::size_t r = 0; r < s.small_mass.size(); ++r) {
    if (v.heat_capacity[r] != 1.0) net.mass += (v.heat_capacity[r] - 1.0) * s.small_mass[r];
    if (v.conductivity[r] != 1.0) net.conduction += (v.conductivity[r] - 1.0) * s.small_conduction[r];
    if (v.expansion[r] != 1.0) {
      net.outputs.rightCols(s.small_displacement[r].cols()) += (v.expansion[r] - 1.0) * s.small_displacement[r];
    }
  }
  add_sensitivities(s, v, net);
  return net;
}

}  // namespace driftwright::blind
