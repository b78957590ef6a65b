#include "machine/body_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/quantity.hpp"
#include "base/usual_ranges.hpp"

namespace driftwright::scenarios {
namespace {

constexpr std::size_t kStatesOfReduced =
    16;  // number of states whose node temperatures are computed; some 0.5 ms each on a mesh of 24000 nodes

}  // namespace

BodyRangeWatch::BodyRangeWatch(const MachineModel& machine, const Model& model, std::size_t n_states)
    : model_(model), reference_K_(machine.reference_K), n_states_(n_states) {
  const mesh::Mesh& m = model.mesh();
  if (model.reduced()) {
    every_ = std::max<std::size_t>(1, n_states / kStatesOfReduced);
    if (model.reduced()->temperature.size() == 0) return;
  }
  constexpr double kNone = std::numeric_limits<double>::infinity();
  for (const std::string& region : m.regions) bodies_.push_back({region, kNone, -kNone});
  body_of_unknown_.assign(static_cast<std::size_t>(m.n_nodes()), -1);
  for (int cell = 0; cell < m.cells.size(); ++cell) {
    for (int node : m.cells.nodes(cell)) body_of_unknown_[static_cast<std::size_t>(node)] = m.cells.group[cell];
  }
  if (model.reduced()) return;
  for (const effects::LumpedNode& node : model.balance.nodes) {
    body_of_unknown_.push_back(static_cast<int>(bodies_.size()));
    bodies_.push_back({node.name, kNone, -kNone});
  }
}

void BodyRangeWatch::take(const Eigen::VectorXd& state) {
  const std::size_t index = n_taken_++;
  if (bodies_.empty() || (index % every_ != 0 && index + 1 != n_states_)) return;
  const ReducedMachine* reduced = model_.reduced();
  const Eigen::VectorXd theta_K = reduced ? reduced->node_temperature_K(state) : state;
  for (std::size_t i = 0; i < body_of_unknown_.size(); ++i) {
    if (body_of_unknown_[i] < 0) continue;
    BodyRange& body = bodies_[static_cast<std::size_t>(body_of_unknown_[i])];
    const double temperature_K = reference_K_ + theta_K[static_cast<Eigen::Index>(i)];
    body.low_K = std::min(body.low_K, temperature_K);
    body.high_K = std::max(body.high_K, temperature_K);
  }
}

std::vector<std::string> unusual_temperatures(const std::vector<BodyRange>& bodies, const MachineModel& machine,
                                              const std::string& cyclogram) {
  std::vector<std::string> found;
  const UsualRange& usual = usual_range(Usual::kTemperature);
  const BodyRange* farthest = nullptr;
  double farthest_K = 0.0, farthest_C = 0.0;
  int n_bodies = 0;
  for (const BodyRange& body : bodies) {
    const double high_C = body.high_K - kZeroCelsius_K, low_C = body.low_K - kZeroCelsius_K;
    const double above_K = high_C - usual.high, below_K = usual.low - low_C;
    if (!(std::max(above_K, below_K) > 0.0)) continue;
    ++n_bodies;
    if (std::max(above_K, below_K) > farthest_K) {
      farthest = &body;
      farthest_K = std::max(above_K, below_K);
      farthest_C = above_K > below_K ? high_C : low_C;
    }
  }
  if (farthest)
    found.push_back(fmt::format("{} reaches {}{}", farthest->body,
                                *beyond_usual(Usual::kTemperature, farthest_C, fmt::format(" in cyclogram '{}'", cyclogram)),
                                n_bodies > 1 ? fmt::format(" (bodies outside of it: {})", n_bodies) : ""));
  for (const BodyRange& body : bodies) {
    for (const MaterialEntry& entry : machine.materials) {
      if (entry.region != body.body) continue;
      const auto judge = [&](const char* what, const solver::PropertyCurve& curve) {
        if (curve.empty() || (body.low_K >= curve.temperature_K.front() && body.high_K <= curve.temperature_K.back()))
          return;
        found.push_back(fmt::format(
            "{} has {:.1f} to {:.1f} degC in cyclogram '{}'; the table of its {} ends at {:.1f} and {:.1f} degC and is "
            "constant outside [materials.{}]",
            body.body, body.low_K - kZeroCelsius_K, body.high_K - kZeroCelsius_K, cyclogram, what,
            curve.temperature_K.front() - kZeroCelsius_K, curve.temperature_K.back() - kZeroCelsius_K, body.body));
      };
      judge("conductivity", entry.material.conductivity_curve);
      judge("heat capacity", entry.material.heat_capacity_curve);
    }
  }
  return found;
}

}  // namespace driftwright::scenarios
