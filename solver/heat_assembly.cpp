#include "solver/heat_assembly.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>

#include "mesh/shape.hpp"
#include "solver/cell_heat.hpp"
#include "solver/film_mapping.hpp"
#include "solver/joint.hpp"
#include "solver/radiation.hpp"
#include "solver/share.hpp"

namespace driftwright::solver {
namespace {

using effects::Body;
using effects::BodyKind;
using mesh::Mesh;

int must_exist(int index, const std::string& name) {
  if (index < 0) throw std::logic_error("assemble_heat: the mesh has no '" + name + "'");
  return index;
}

/// Maps names of the machine to unknowns and integrals. With a share the mesh is a part: vectors and matrices are then
/// additive (share.hpp), sizes are those of the whole machine.
class Places {
 public:
  Places(const Mesh& mesh, const effects::HeatBalance& balance, const Share* share)
      : mesh_(mesh), balance_(balance), share_(share) {}

  [[nodiscard]] double of_all(double own) const { return share_ ? share_->sum(own) : own; }
  /// True on one process: for what is no integral over the mesh.
  [[nodiscard]] bool is_first() const { return !share_ || share_->is_first; }
  /// Own part of a sum over the machine, never zero if the sum of all is not: whether it is zero decides what a flow is.
  [[nodiscard]] double own_part(double own) const {
    const double all = of_all(own);
    return own == 0.0 && all != 0.0 ? std::numeric_limits<double>::min() : own;
  }

  [[nodiscard]] int n_unknowns() const { return mesh_.n_nodes() + static_cast<int>(balance_.nodes.size()); }
  [[nodiscard]] int unknown_of_node(const std::string& name) const {
    for (std::size_t i = 0; i < balance_.nodes.size(); ++i) {
      if (balance_.nodes[i].name == name) return mesh_.n_nodes() + static_cast<int>(i);
    }
    return must_exist(-1, name);
  }
  /// -1 for the ambient.
  [[nodiscard]] int unknown_of_surrounding(const std::string& name) const {
    return name == effects::kAmbientName ? -1 : unknown_of_node(name);
  }
  [[nodiscard]] int surface(const std::string& name) const { return must_exist(mesh_.surface(name), name); }
  [[nodiscard]] int region(const std::string& name) const { return must_exist(mesh_.region(name), name); }

  /// Cells of a region or facets of a surface.
  [[nodiscard]] std::pair<const mesh::Cells&, std::vector<int>> pieces(const Body& body) const {
    if (body.kind == BodyKind::kRegion) return {mesh_.cells, mesh_.cells_in(region(body.name))};
    return {mesh_.facets, mesh_.facets_on(surface(body.name))};
  }

  /// ∫ N_i over the volume or area of a body divided by its size; one for a lumped node. Sums to one.
  [[nodiscard]] Eigen::VectorXd mean_weights(const Body& body) const {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(n_unknowns());
    if (body.kind == BodyKind::kNode) {
      weights[unknown_of_node(body.name)] = is_first() ? 1.0 : 0.0;
      return weights;
    }
    for_each_point(body, [&](std::span<const int> nodes, const mesh::ShapeValues& s, double size, const Eigen::Vector3d&) {
      for (int i = 0; i < s.n; ++i) weights[nodes[i]] += size * s.N[i];
    });
    return weights / of_all(weights.sum());
  }

  /// Calls work(nodes, shape values, volume or area of the point, position) at each quadrature point of a region or surface.
  template <class Work>
  void for_each_point(const Body& body, Work work) const {
    const auto [cells, members] = pieces(body);
    for (int c : members) {
      const auto nodes = cells.nodes(c);
      const auto x = mesh::cell_coords(mesh_, nodes);
      for (const auto& q : mesh::mass_rule(cells.shape[c])) {
        const mesh::ShapeValues s = mesh::shape_values(cells.shape[c], q.xi);
        const Eigen::Vector3d position = x * s.N.head(s.n).transpose();
        work(nodes, s, q.weight * mesh::jacobian(s, x, cells.shape[c]).det, position);
      }
    }
  }

 private:
  const Mesh& mesh_;
  const effects::HeatBalance& balance_;
  const Share* share_;
};

SparseRow from_entries(int n, const std::vector<Eigen::Triplet<double>>& entries) {
  SparseRow g(n, n);
  g.setFromTriplets(entries.begin(), entries.end());
  return g;
}

/// ∫ (T - T_s)² over a region or surface as a quadratic form: ∫ N N', and its coupling if the surrounding is an unknown.
SparseRow body_matrix(const Places& places, const Body& body, int surrounding) {
  std::vector<Eigen::Triplet<double>> entries;
  if (body.kind == BodyKind::kNode) {
    const int i = places.unknown_of_node(body.name);
    if (!places.is_first()) return from_entries(places.n_unknowns(), entries);
    entries.emplace_back(i, i, 1.0);
    if (surrounding >= 0) {
      entries.emplace_back(i, surrounding, -1.0);
      entries.emplace_back(surrounding, i, -1.0);
      entries.emplace_back(surrounding, surrounding, 1.0);
    }
    return from_entries(places.n_unknowns(), entries);
  }
  places.for_each_point(body,
                        [&](std::span<const int> nodes, const mesh::ShapeValues& s, double size, const Eigen::Vector3d&) {
                          for (int i = 0; i < s.n; ++i) {
                            for (int j = 0; j < s.n; ++j) entries.emplace_back(nodes[i], nodes[j], size * s.N[i] * s.N[j]);
                            if (surrounding >= 0) {
                              entries.emplace_back(nodes[i], surrounding, -size * s.N[i]);
                              entries.emplace_back(surrounding, nodes[i], -size * s.N[i]);
                            }
                          }
                          if (surrounding >= 0) entries.emplace_back(surrounding, surrounding, size);
                        });
  return from_entries(places.n_unknowns(), entries);
}

/// Exchange between a body and its surrounding.
Exchange<SparseRow> to_surrounding(const Places& places, const effects::Exchange& exchange, BoundLaw coefficient,
                                   const std::vector<effects::Stratification>& air, double reference_K) {
  const Body& body = exchange.body;
  const bool total = exchange.per == effects::Per::kTotal;
  const int unknown = exchange.medium_K ? -1 : places.unknown_of_surrounding(exchange.surrounding);
  Exchange<SparseRow> e{.name = exchange.name,
                        .place = place_of(exchange),
                        .matrix = body_matrix(places, body, unknown),
                        .to_ambient = {},
                        .coefficient = std::move(coefficient),
                        .flow = places.mean_weights(body),
                        .offset = {}};
  const bool spread = body.kind != BodyKind::kNode;
  double size = 1.0;
  if (spread) {
    size = 0.0;
    places.for_each_point(body, [&](auto, auto&, double point_size, auto&) { size += point_size; });
    size = places.of_all(size);
    if (total) e.matrix /= size;
  }
  const double flow_size = spread && !total ? size : 1.0;
  e.flow *= flow_size;
  if (unknown >= 0) {
    if (places.is_first()) e.flow[unknown] -= flow_size;
    e.to_ambient = Eigen::VectorXd::Zero(places.n_unknowns());
    return e;
  }
  e.to_ambient = e.matrix * Eigen::VectorXd::Ones(e.matrix.cols());
  if (exchange.medium_K) {
    e.medium = std::move(e.to_ambient);
    e.medium_sum = places.own_part(e.medium.sum());
    e.to_ambient = Eigen::VectorXd::Zero(places.n_unknowns());
    e.hold_medium(*exchange.medium_K - reference_K);
    return e;
  }
  e.ambient_sum = places.own_part(e.to_ambient.sum());
  if (!air.empty() && body.kind == BodyKind::kSurface) {
    e.offset = Eigen::VectorXd::Zero(places.n_unknowns());
    places.for_each_point(
        body, [&](std::span<const int> nodes, const mesh::ShapeValues& s, double area_m2, const Eigen::Vector3d& position) {
          const double share = (total ? area_m2 / size : area_m2) * ambient_offset_K(air, position.z());
          for (int i = 0; i < s.n; ++i) e.offset[nodes[i]] += share * s.N[i];
        });
    e.offset_sum = e.offset.sum();
  }
  return e;
}

/// What a pattern of a film exchanges with a surrounding or with the air temperatures of its file:
/// G_ij = ∫ h N_i N_j dA, o_i = ∫ N_i h (T_air - T_ref) dA.
Exchange<SparseRow> of_pattern(const Mesh& mesh, const Places& places, const FilmMapping& mapping,
                               const effects::Exchange& exchange, BoundLaw coefficient,
                               const std::vector<effects::Stratification>& air, double reference_K) {
  const int n = places.n_unknowns();
  const int unknown = exchange.medium_K ? -1 : places.unknown_of_surrounding(exchange.surrounding);
  Exchange<SparseRow> e{.name = exchange.name,
                        .place = place_of(exchange),
                        .matrix = {},
                        .to_ambient = Eigen::VectorXd::Zero(n),
                        .coefficient = std::move(coefficient),
                        .flow = Eigen::VectorXd::Zero(n),
                        .offset = {}};
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(n);
  std::vector<Eigen::Triplet<double>> entries;
  double film_W_K = 0.0;
  for (std::size_t p = 0; p < mapping.points.size();) {
    const int facet = mapping.points[p].facet;
    const auto nodes = mesh.facets.nodes(facet);
    const mesh::CellShape shape = mesh.facets.shape[facet];
    const auto x = mesh::cell_coords(mesh, nodes);
    const auto n_nodes = static_cast<Eigen::Index>(nodes.size());
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(n_nodes, n_nodes);  // one entry a pair of nodes, of many points
    Eigen::VectorXd once = Eigen::VectorXd::Zero(n_nodes), excess = once;
    for (; p < mapping.points.size() && mapping.points[p].facet == facet; ++p) {
      const FilmPoint& point = mapping.points[p];
      const double film = point.area_m2 * exchange.part.film_W_m2K(point.value);
      double excess_W = 0.0;  // h (T_air - T_ref) or h (T_air(z) - T_ambient)
      const mesh::ShapeValues s = mesh::shape_values(shape, point.xi);
      const Eigen::RowVectorXd values = s.N.head(s.n);
      if (exchange.medium_K) {
        excess_W = point.area_m2 * exchange.part.film_times_air_W_m2(point.value) - film * reference_K;
      } else if (!air.empty() && unknown < 0) {
        excess_W = film * ambient_offset_K(air, (x * values.transpose()).z());
      }
      square.noalias() += film * values.transpose() * values;
      once += film * values.transpose();
      excess += excess_W * values.transpose();
      film_W_K += film;
    }
    for (Eigen::Index i = 0; i < n_nodes; ++i) {
      const int row = nodes[static_cast<std::size_t>(i)];
      e.flow[row] += once[i];
      offset[row] += excess[i];
      for (Eigen::Index j = 0; j < n_nodes; ++j) entries.emplace_back(row, nodes[static_cast<std::size_t>(j)], square(i, j));
      if (unknown < 0) continue;
      entries.emplace_back(row, unknown, -once[i]);
      entries.emplace_back(unknown, row, -once[i]);
    }
  }
  if (unknown >= 0) {
    entries.emplace_back(unknown, unknown, film_W_K);
    e.flow[unknown] -= film_W_K;
    e.matrix = from_entries(n, entries);
    return e;
  }
  e.matrix = from_entries(n, entries);
  // A change between two states may have no film in all, and yet reaches its surrounding: the smallest sum says so.
  const double sum = film_W_K == 0.0 && e.flow.cwiseAbs().maxCoeff() > 0.0 ? std::numeric_limits<double>::min() : film_W_K;
  if (exchange.medium_K) {
    e.medium = e.flow;
    e.medium_sum = sum;
    e.offset = std::move(offset);
    e.offset_sum = e.offset.sum();
    return e;
  }
  e.to_ambient = e.flow;
  e.ambient_sum = sum;
  if (!air.empty()) {
    e.offset = std::move(offset);
    e.offset_sum = e.offset.sum();
  }
  return e;
}

Exchange<SparseRow> across_joint(const std::vector<JointPoint>& points, const Places& places,
                                 const effects::Exchange& exchange, BoundLaw coefficient) {
  const int n = places.n_unknowns();
  Exchange<SparseRow> e{.name = exchange.name,
                        .place = place_of(exchange),
                        .matrix = {},
                        .to_ambient = Eigen::VectorXd::Zero(n),
                        .coefficient = std::move(coefficient),
                        .flow = Eigen::VectorXd::Zero(n),
                        .offset = {}};
  std::vector<Eigen::Triplet<double>> entries;
  for (const JointPoint& p : points) {
    std::vector<int> node = p.node_a;
    node.insert(node.end(), p.node_b.begin(), p.node_b.end());
    std::vector<double> jump = p.weight_a;
    for (double w : p.weight_b) jump.push_back(-w);
    for (std::size_t i = 0; i < node.size(); ++i) {
      e.flow[node[i]] += p.area_m2 * jump[i];
      for (std::size_t j = 0; j < node.size(); ++j) entries.emplace_back(node[i], node[j], p.area_m2 * jump[i] * jump[j]);
    }
  }
  e.matrix = from_entries(n, entries);
  return e;
}

/// Finds the probes and thermostats of laws, and collects each probe once.
class Binder {
 public:
  Binder(const Places& places, const effects::HeatBalance& balance, FullSystem& system)
      : places_(places), balance_(balance), system_(system) {}

  /// @param surface  that the law's film is on: its ambient is the air before this surface, which may be stratified; nullptr
  ///                 for none
  BoundLaw bind(const effects::Law& law, const Body* surface = nullptr) {
    BoundLaw bound(law);
    for (const Body& body : law.probes) {
      const bool before_surface =
          surface && body == effects::node(effects::kAmbientName) && !balance_.stratifications.empty();
      bound.probes.push_back(before_surface ? air_before(*surface) : probe(body));
    }
    for (std::size_t t = 0; t < balance_.thermostats.size() && !law.thermostat.empty(); ++t) {
      if (balance_.thermostats[t].name == law.thermostat) bound.thermostat = static_cast<int>(t);
    }
    if (!law.thermostat.empty()) must_exist(bound.thermostat, law.thermostat);
    return bound;
  }
  int probe(const Body& body) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i] == body) return static_cast<int>(i);
    }
    bodies_.push_back(body);
    if (body == effects::node(effects::kAmbientName)) {
      system_.probes.push_back({body, {}, Eigen::VectorXd::Zero(places_.n_unknowns()), 1.0});
    } else {
      system_.probes.push_back({body, {}, places_.mean_weights(body), 0.0});
    }
    return static_cast<int>(bodies_.size()) - 1;
  }

 private:
  int air_before(const Body& surface) {
    double offset_K_m2 = 0.0, area_m2 = 0.0;
    places_.for_each_point(surface, [&](auto, auto&, double point_m2, const Eigen::Vector3d& position) {
      offset_K_m2 += point_m2 * ambient_offset_K(balance_.stratifications, position.z());
      area_m2 += point_m2;
    });
    offset_K_m2 = places_.of_all(offset_K_m2);
    area_m2 = places_.of_all(area_m2);
    bodies_.push_back({});  // an empty body, which probe() never asks for
    system_.probes.push_back(
        {effects::ambient_node(), surface.name, Eigen::VectorXd::Zero(places_.n_unknowns()), 1.0, offset_K_m2 / area_m2});
    return static_cast<int>(bodies_.size()) - 1;
  }

  const Places& places_;
  const effects::HeatBalance& balance_;
  FullSystem& system_;
  std::vector<Body> bodies_;
};

std::vector<Exchange<SparseRow>> make_exchanges(const Mesh& mesh, const Places& places, const effects::HeatBalance& balance,
                                                Binder& binder, double reference_K, const Share* share) {
  std::vector<Exchange<SparseRow>> exchanges;
  std::map<std::tuple<std::string, const effects::SurfaceField*, double>, FilmMapping> mapped;  // patterns share them
  for (const effects::Exchange& e : balance.exchanges) {
    if (!e.part.is_even()) {
      if (!e.part.field) throw std::logic_error("assemble_heat: the file of " + e.name + " has not been read");
      // NaN has no order: 0 for the usual reach
      const std::tuple key(e.body.name, e.part.field.get(), std::isnan(e.part.reach_m) ? 0.0 : e.part.reach_m);
      if (!mapped.contains(key))
        mapped.emplace(key, map_film(mesh, places.surface(e.body.name), *e.part.field, e.part.reach_m));
      exchanges.push_back(
          of_pattern(mesh, places, mapped.at(key), e, binder.bind(e.coefficient), balance.stratifications, reference_K));
    } else if (e.body.kind == BodyKind::kJoint) {
      if (share) {
        const auto own = std::find_if(share->joint_points.begin(), share->joint_points.end(),
                                      [&](const auto& joint) { return joint.first == e.body.name; });
        must_exist(own == share->joint_points.end() ? -1 : 0, e.body.name);
        exchanges.push_back(across_joint(own->second, places, e, binder.bind(e.coefficient)));
        continue;
      }
      const mesh::Joint* joint = mesh.joint(e.body.name);
      must_exist(joint ? 0 : -1, e.body.name);
      exchanges.push_back(across_joint(joint_points(mesh, *joint), places, e, binder.bind(e.coefficient)));
    } else {
      const Body* before = e.body.kind == BodyKind::kSurface && e.per == effects::Per::kArea ? &e.body : nullptr;
      exchanges.push_back(
          to_surrounding(places, e, binder.bind(e.coefficient, before), balance.stratifications, reference_K));
    }
  }
  return exchanges;
}

std::vector<int> unknowns_of(const Mesh& mesh, const Places& places, const Body& body) {
  if (body.kind == BodyKind::kNode) return {places.unknown_of_node(body.name)};
  std::vector<char> is_member(mesh.n_nodes(), 0);
  const auto [cells, members] = places.pieces(body);
  for (int c : members) {
    for (int node : cells.nodes(c)) is_member[node] = 1;
  }
  std::vector<int> unknowns;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    if (is_member[i]) unknowns.push_back(i);
  }
  return unknowns;
}

double at_reference(double constant, const PropertyCurve& curve, double reference_K) {
  return curve.empty() ? constant : curve.at(reference_K);
}

}  // namespace

ExchangePlace place_of(const effects::Exchange& exchange) {
  const bool has_surrounding = exchange.body.kind != BodyKind::kJoint && !exchange.medium_K;
  return {exchange.body, has_surrounding ? exchange.surrounding : "", exchange.per, exchange.part.id};
}

Eigen::VectorXd mean_weights(const Mesh& mesh, const effects::HeatBalance& balance, const Body& body, const Share* share) {
  return Places(mesh, balance, share).mean_weights(body);
}

FullSystem assemble_heat(const Mesh& mesh, const RegionMaterials& materials, const effects::HeatBalance& balance,
                         double reference_K, std::shared_ptr<const Share> share) {
  const Places places(mesh, balance, share.get());
  const int n = places.n_unknowns();
  FullSystem system;
  system.reference_K = reference_K;
  Binder binder(places, balance, system);
  system.exchanges = make_exchanges(mesh, places, balance, binder, reference_K, share.get());
  for (const effects::HeatInput& heat : balance.heats) {
    system.sources.push_back({heat.name, heat.body, places.mean_weights(heat.body), binder.bind(heat.power_W)});
  }
  for (const effects::Thermostat& t : balance.thermostats) {
    system.thermostats.push_back({t.name, binder.probe(t.probe), t.on_above_K, t.off_below_K});
  }
  for (const effects::Radiation& r : balance.radiations) {
    system.nonlinear.push_back(radiating_surface(mesh, r, places.surface(r.surface),
                                                 places.unknown_of_surrounding(r.surrounding), balance.stratifications,
                                                 reference_K));
  }
  if (auto term = variable_conduction(mesh, materials, reference_K)) system.nonlinear.push_back(std::move(term));
  system.capacity = VariableCapacity::of(mesh, materials, reference_K);
  std::vector<char> is_fixed(n, 0);
  for (const effects::FixedTemperature& f : balance.fixed) {
    TimeSeries theta = f.temperature_K;
    for (double& value : theta.value) value -= reference_K;
    std::vector<int> unknowns;
    for (int i : unknowns_of(mesh, places, f.body)) {
      if (!is_fixed[i]) unknowns.push_back(i);
      is_fixed[i] = 1;
    }
    system.fixed.push_back({f.name, std::move(unknowns), std::move(theta), f.follows_ambient});
  }
  system.change_times_s = balance.change_times_s;
  std::sort(system.change_times_s.begin(), system.change_times_s.end());
  system.change_times_s.erase(std::unique(system.change_times_s.begin(), system.change_times_s.end()),
                              system.change_times_s.end());

  Cliques cliques;  // the common pattern: cells, and the entries of every exchange and term
  for (int cell = 0; cell < mesh.cells.size(); ++cell) cliques.add(mesh.cells.nodes(cell));
  for (const auto& e : system.exchanges) {
    for (int row = 0; row < n; ++row) {
      for (SparseRow::InnerIterator entry(e.matrix, row); entry; ++entry) {
        if (entry.col() > row) cliques.add(std::array{row, static_cast<int>(entry.col())});
      }
    }
  }
  for (const auto& term : system.nonlinear) term->add_cliques(cliques);
  system.mass = pattern(n, cliques);
  system.conduction = system.mass;
  std::vector<HeatProperties> of_region;
  for (const Material& m : materials) {
    const double c_J_kgK = at_reference(m.heat_capacity_J_kgK, m.heat_capacity_curve, reference_K);
    of_region.push_back({.capacity_J_m3K = m.density_kg_m3 * c_J_kgK,
                         .conductivity_W_mK = at_reference(m.conductivity_W_mK, m.conductivity_curve, reference_K)});
  }
  add_cells(mesh, of_region, system.mass, system.conduction);
  for (std::size_t i = 0; i < balance.nodes.size(); ++i) {
    const int unknown = mesh.n_nodes() + static_cast<int>(i);
    system.mass.coeffRef(unknown, unknown) = places.is_first() ? balance.nodes[i].capacity_J_K : 0.0;
  }
  system.ones = Eigen::VectorXd::Ones(share ? share->n_whole_unknowns() : n);
  system.share = std::move(share);
  return system;
}

}  // namespace driftwright::solver
