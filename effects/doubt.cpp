#include "effects/doubt.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::effects {

double DoubtScene::longest_s() const {
  double longest = 0.0;
  for (const Run& run : runs) longest = std::max(longest, run.length_s);
  return longest;
}

double DoubtScene::unknown_heat_W() const {
  return std::max(20.0, 0.5 * heat_W);
}

double DoubtScene::typical_conductance_W_K() const {
  double sum_log = 0.0;
  int n = 0;
  for (const Exchange& e : balance.exchanges) {
    if (e.per != Per::kTotal || !e.coefficient.probes.empty() || !e.coefficient.thermostat.empty()) continue;
    const double conductance_W_K = e.coefficient(Inputs{.drive = {.speed_rpm = typical_rpm}});
    if (!(conductance_W_K > 0.0)) continue;
    sum_log += std::log(conductance_W_K);
    ++n;
  }
  return n > 0 ? std::exp(sum_log / n) : 0.1 * unknown_heat_W();
}

DoubtedNumber doubted(std::string name, std::string unit, double prior_sd, double step, double nominal) {
  return {.name = std::move(name), .unit = std::move(unit), .nominal = nominal, .prior_sd = prior_sd, .step = step};
}

DoubtedNumber doubted_factor() {
  DoubtedNumber n = doubted("factor", "1", kFactorSd, 0.05, 1.0);
  n.is_log = true;
  return n;
}

DoubtedNumber doubted_time(std::string name, double run_length_s, std::function<void(std::span<Effect>, double)> set) {
  DoubtedNumber n = doubted(std::move(name), "s", run_length_s / std::sqrt(12.0), 20.0, 0.5 * run_length_s);
  n.low = 0.0;
  n.high = run_length_s;
  n.is_time = true;
  n.set = std::move(set);
  return n;
}

std::vector<std::vector<double>> time_grid(double run_length_s, int n) {
  std::vector<std::vector<double>> grid;
  for (int i = 1; i < n; ++i) grid.push_back({run_length_s * (static_cast<double>(i) / n - 0.5)});
  return grid;
}

bool are_joined(const DoubtScene& s, const Body& a, const Body& b) {
  return std::any_of(s.balance.exchanges.begin(), s.balance.exchanges.end(), [&](const Exchange& e) {
    if (e.body.kind == BodyKind::kJoint || e.medium_K) return false;
    return (e.body == a && node(e.surrounding) == b) || (e.body == b && node(e.surrounding) == a);
  });
}

bool have_common_neighbour(const DoubtScene& s, const Body& a, const Body& b) {
  return std::any_of(s.bodies.begin(), s.bodies.end(),
                     [&](const Body& c) { return !(c == a) && !(c == b) && are_joined(s, a, c) && are_joined(s, b, c); });
}

bool has_even_film(const HeatBalance& balance, const std::string& on) {
  return std::any_of(balance.exchanges.begin(), balance.exchanges.end(),
                     [&](const Exchange& e) { return e.body == surface(on) && e.per == Per::kArea && e.part.is_even(); });
}

bool has_film(const HeatBalance& balance, const std::string& on) {
  return std::any_of(balance.exchanges.begin(), balance.exchanges.end(),
                     [&](const Exchange& e) { return e.body == surface(on) && e.per == Per::kArea; });
}

std::string where_of(const Exchange& exchange) {
  return exchange.per == Per::kTotal ? exchange.body.name + "," + exchange.surrounding : exchange.body.name;
}

std::string where_of(const Effect& effect) {
  if (effect.kind->exchange_finding.empty()) return effect.place;
  const HeatBalance alone = heat_balance({effect});
  return alone.exchanges.empty() ? effect.place : where_of(alone.exchanges.front());
}

}  // namespace driftwright::effects
