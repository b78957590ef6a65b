#include "solver/reduction_demand.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"

namespace driftwright::solver {
namespace {

constexpr double kWarmer_K[] = {2.0, 20.0, 40.0};  // above the ambient: temperatures at which laws are evaluated

double up(double value) {
  return value == 0.0 ? 0.0 : std::exp2(std::ceil(std::log2(value) - 1e-9));
}
double down(double value) {
  return value == 0.0 ? 0.0 : std::exp2(std::floor(std::log2(value) + 1e-9));
}

struct Range {
  double low = std::numeric_limits<double>::max(), high = 0.0;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Extends a range by the value of a law at a drive and a time.
void look(const effects::Law& law, effects::Inputs at, double reference_K, Range& range) {
  if (!law.thermostat.empty()) range.take(0.0);
  if (law.probes.empty()) return range.take(std::abs(law(at)));
  const auto take_where = [&](const auto& warmer_K_of) {
    at.probe_K.clear();
    for (const effects::Body& body : law.probes) {
      at.probe_K.push_back(reference_K + at.ambient_K +
                           (body == effects::node(effects::kAmbientName) ? 0.0 : warmer_K_of(body)));
    }
    try {
      range.take(std::abs(law(at)));
    } catch (const RangeError&) {  // a run that gets there reports the law's range
    }
  };
  for (double warmer_K : kWarmer_K) {
    take_where([&](const effects::Body&) { return warmer_K; });
    for (const effects::Body& one : law.probes) {  // a law of differences is the same if all bodies have one temperature
      if (one == effects::node(effects::kAmbientName)) continue;
      take_where([&](const effects::Body& body) { return body == one ? warmer_K : 0.0; });
    }
  }
}

}  // namespace

void ReductionDemand::include(const ReductionDemand& other) {
  power_W = power_W.cwiseMax(other.power_W);
  ambient_K = std::max(ambient_K, other.ambient_K);
  duration_s = std::max(duration_s, other.duration_s);
  for (Eigen::Index e = 0; e < low.size(); ++e) {
    const double l = std::min(low[e], other.low[e]), h = std::max(high[e], other.high[e]);
    low[e] = l < h ? down(l) : l;
    high[e] = l < h ? up(h) : h;
  }
}

std::vector<Eigen::VectorXd> ReductionDemand::points() const {
  std::vector<Eigen::VectorXd> sets = {0.5 * (low + high)};
  if (low != high) sets.insert(sets.end(), {low, high});
  return sets;
}

ReductionDemand reduction_demand(const effects::HeatBalance& balance, const std::vector<const Cyclogram*>& cyclograms,
                                 const TimeSeries& ambient, double reference_K) {
  std::vector<const effects::Law*> sources, exchanges;
  for (const effects::HeatInput& h : balance.heats) sources.push_back(&h.power_W);
  for (const effects::Exchange& e : balance.exchanges) exchanges.push_back(&e.coefficient);
  std::vector<Range> of_source(sources.size()), of_exchange(exchanges.size());

  double duration_s = 3600.0, ambient_K = 1.0;
  std::vector<std::pair<Drive, std::string_view>> drives = {{Drive{}, {}}};  // with the run that it belongs to
  for (const Cyclogram* c : cyclograms) {
    duration_s = std::max(duration_s, c->duration_s());
    for (const auto& section : c->sections) drives.emplace_back(section.drive, c->name);
  }
  for (double value_K : ambient.value) ambient_K = std::max(ambient_K, std::abs(value_K));
  std::vector<double> times_s = {0.0};  // one in each interval between changes
  for (double t_s : balance.change_times_s) times_s.push_back(t_s * (1.0 + 1e-9));
  for (const auto& [drive, run] : drives) {
    for (double t_s : times_s) {
      effects::Inputs at{.drive = drive, .ambient_K = ambient.at(t_s), .time_s = t_s};
      at.run = run;
      for (std::size_t s = 0; s < sources.size(); ++s) look(*sources[s], at, reference_K, of_source[s]);
      for (std::size_t e = 0; e < exchanges.size(); ++e) look(*exchanges[e], at, reference_K, of_exchange[e]);
    }
  }
  ReductionDemand demand;
  demand.ambient_K = up(ambient_K);
  demand.duration_s = up(duration_s);
  demand.power_W.resize(static_cast<Eigen::Index>(sources.size()));
  demand.low.resize(static_cast<Eigen::Index>(exchanges.size()));
  demand.high.resize(demand.low.size());
  for (std::size_t s = 0; s < sources.size(); ++s) demand.power_W[static_cast<Eigen::Index>(s)] = up(of_source[s].high);
  for (std::size_t e = 0; e < exchanges.size(); ++e) {
    const Range& r = of_exchange[e];
    const bool moves = r.low < r.high;
    demand.low[static_cast<Eigen::Index>(e)] = moves ? down(r.low) : r.high;
    demand.high[static_cast<Eigen::Index>(e)] = moves ? up(r.high) : r.high;
  }
  return demand;
}

}  // namespace driftwright::solver
