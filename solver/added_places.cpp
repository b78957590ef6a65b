#include "solver/added_places.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace driftwright::solver {
namespace {

using effects::Body, effects::BodyKind;

const HeatSource* source_at(const ReducedSystem& system, const Body& body) {
  const auto found =
      std::find_if(system.sources.begin(), system.sources.end(), [&](const HeatSource& s) { return s.body == body; });
  return found == system.sources.end() ? nullptr : &*found;
}

/// Index of a node among those added, or -1.
Eigen::Index index_of(const AddedPlaces& added, const Body& body) {
  for (std::size_t i = 0; i < added.nodes.size(); ++i) {
    if (body == effects::node(added.nodes[i].first)) return static_cast<Eigen::Index>(i);
  }
  return -1;
}

/// w: mean temperature of a body = w'z, for the system's own and the added unknowns.
Eigen::VectorXd mean_weights(const ReducedSystem& system, const AddedPlaces& added, const Body& body) {
  const Eigen::Index n = system.size();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(n + static_cast<Eigen::Index>(added.nodes.size()));
  if (const Eigen::Index i = index_of(added, body); i >= 0) {
    weights[n + i] = 1.0 / std::sqrt(added.nodes[static_cast<std::size_t>(i)].second);
    return weights;
  }
  const HeatSource* source = source_at(system, body);
  if (!source) throw std::logic_error("with_places: the temperature of " + body.name + " is not known");
  weights.head(n) = source->load;
  return weights;
}

/// Extends a quadratic form of the system's own unknowns by zeros for the added ones.
Eigen::MatrixXd grown(const Eigen::MatrixXd& a, Eigen::Index n) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  all.topLeftCorner(a.rows(), a.cols()) = a;
  return all;
}
void grow(Eigen::VectorXd& v, Eigen::Index n) {
  if (v.size() == 0) return;
  const Eigen::Index before = v.size();
  v.conservativeResize(n);
  v.tail(n - before).setZero();
}

/// ∫ T² over a body divided by its size, as a quadratic form; and the load for a temperature of 1 K.
struct Square {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd of_ones;
};
Square square_of(const ReducedSystem& system, const AddedPlaces& added, const Body& body) {
  const Eigen::VectorXd weights = mean_weights(system, added, body);
  if (body.kind == BodyKind::kNode) return {weights * weights.transpose(), weights};
  for (const auto& e : system.exchanges) {
    if (!(e.place.body == body) || e.place.per != effects::Per::kTotal || e.medium.size() == 0) continue;
    Eigen::VectorXd of_ones = e.medium;
    grow(of_ones, weights.size());
    return {grown(e.matrix, weights.size()), std::move(of_ones)};
  }
  throw std::logic_error("with_places: nothing flows along " + body.name);
}

Exchange<Eigen::MatrixXd> exchange_at(const ReducedSystem& system, const AddedPlaces& added, const ExchangePlace& place) {
  Square square = square_of(system, added, place.body);
  Exchange<Eigen::MatrixXd> e;
  e.name = place.body.name + " - " + place.surrounding;
  e.place = place;
  e.coefficient = BoundLaw([](const effects::Inputs&) { return 0.0; });
  e.matrix = std::move(square.matrix);
  e.flow = mean_weights(system, added, place.body);
  if (place.surrounding == effects::kAmbientName) {
    e.to_ambient = std::move(square.of_ones);
    e.ambient_sum = 1.0;
    return e;
  }
  const Eigen::VectorXd other = mean_weights(system, added, effects::node(place.surrounding));
  e.matrix += other * other.transpose() - e.flow * other.transpose() - other * e.flow.transpose();
  e.flow -= other;
  e.to_ambient = Eigen::VectorXd::Zero(e.flow.size());
  return e;
}

}  // namespace

AddedPlaces places_lacking(const ReducedSystem& system, const effects::HeatBalance& balance) {
  AddedPlaces lacking;
  for (const effects::LumpedNode& n : balance.nodes) {
    if (!source_at(system, effects::node(n.name))) lacking.nodes.emplace_back(n.name, n.capacity_J_K);
  }
  for (const effects::Exchange& asked : balance.exchanges) {
    if (asked.per != effects::Per::kTotal || asked.medium_K || asked.body.kind == BodyKind::kJoint) continue;
    const ExchangePlace place = place_of(asked);
    const bool is_there =
        std::any_of(system.exchanges.begin(), system.exchanges.end(),
                    [&](const auto& e) { return !e.prescribes && e.medium.size() == 0 && e.place == place; }) ||
        std::find(lacking.exchanges.begin(), lacking.exchanges.end(), place) != lacking.exchanges.end();
    if (!is_there) lacking.exchanges.push_back(place);
  }
  return lacking;
}

ReducedSystem with_places(const ReducedSystem& system, const AddedPlaces& added) {
  const Eigen::Index own = system.size(), n = own + static_cast<Eigen::Index>(added.nodes.size());
  ReducedSystem s = system;
  s.parts.clear();
  for (const ExchangePlace& place : added.exchanges) s.exchanges.push_back(exchange_at(system, added, place));
  if (n == own) return s;
  s.mass = grown(system.mass, n);
  s.mass.bottomRightCorner(n - own, n - own).setIdentity();
  s.conduction = grown(system.conduction, n);
  for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
    s.exchanges[e].matrix = grown(system.exchanges[e].matrix, n);
    for (Eigen::VectorXd* v :
         {&s.exchanges[e].to_ambient, &s.exchanges[e].flow, &s.exchanges[e].offset, &s.exchanges[e].medium})
      grow(*v, n);
  }
  for (HeatSource& source : s.sources) grow(source.load, n);
  for (const auto& [name, capacity_J_K] : added.nodes) {  // a law may use its temperature
    HeatSource heat{.name = name, .body = effects::node(name), .load = {}, .power_W = BoundLaw([](const effects::Inputs&) {
                                                                             return 0.0;
                                                                           })};
    heat.load = mean_weights(system, added, heat.body);
    s.sources.push_back(std::move(heat));
  }
  for (Probe& probe : s.probes) grow(probe.weights, n);
  s.outputs.state = Eigen::MatrixXd::Zero(n, system.outputs.state.cols());
  s.outputs.state.topRows(own) = system.outputs.state;
  grow(s.ones, n);
  for (std::size_t i = 0; i < added.nodes.size(); ++i)
    s.ones[own + static_cast<Eigen::Index>(i)] = std::sqrt(added.nodes[i].second);
  return s;
}

Eigen::VectorXd with_places(const Eigen::VectorXd& state, const ReducedSystem& system, const AddedPlaces& added) {
  Eigen::VectorXd all = state;
  grow(all, state.size() + static_cast<Eigen::Index>(added.nodes.size()));
  for (std::size_t i = 0; i < added.nodes.size(); ++i) {
    const auto& [name, capacity_J_K] = added.nodes[i];
    double sum_K = 0.0;
    int n_bodies = 0;
    for (const ExchangePlace& place : added.exchanges) {
      if (place.surrounding != name) continue;
      sum_K += mean_weights(system, added, place.body).dot(all);
      ++n_bodies;
    }
    if (n_bodies > 0) all[state.size() + static_cast<Eigen::Index>(i)] = std::sqrt(capacity_J_K) * sum_K / n_bodies;
  }
  return all;
}

}  // namespace driftwright::solver
