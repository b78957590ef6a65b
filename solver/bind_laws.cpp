#include "solver/bind_laws.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "effects/law_steps.hpp"

namespace driftwright::solver {
namespace {

using effects::Body;
using effects::Inputs;
using effects::Law;

/// The sum of several laws as one law; their probes follow each other.
Law sum_of(const std::vector<const Law*>& laws) {
  if (laws.empty()) return Law([](const Inputs&) { return 0.0; });
  if (laws.size() == 1) return *laws.front();
  Law sum;
  std::vector<std::pair<std::function<double(const Inputs&)>, std::size_t>> terms;
  sum.thermostat = laws.front()->thermostat;
  for (const Law* law : laws) {
    if (law->thermostat != sum.thermostat) throw std::logic_error("bind_laws: one place with and without a thermostat");
    terms.emplace_back(law->value, law->probes.size());
    sum.probes.insert(sum.probes.end(), law->probes.begin(), law->probes.end());
  }
  sum.value = [terms](const Inputs& u) {
    double total = 0.0;
    auto from = u.probe_K.begin();
    for (const auto& [value, n_probes] : terms) {
      if (n_probes == 0) {
        total += value(u);
        continue;
      }
      Inputs own = u;
      own.probe_K.assign(from, from + static_cast<std::ptrdiff_t>(n_probes));
      from += static_cast<std::ptrdiff_t>(n_probes);
      total += value(own);
    }
    return total;
  };
  sum.steps = effects::sum_of_steps(laws);
  return sum;
}

/// Finds the entry that each law of a list belongs to.
template <class Entry, class Asked, class SamePlace>
std::vector<std::size_t> entries_of(const std::vector<Entry>& entries, const std::vector<Asked>& asked, SamePlace same) {
  std::vector<char> taken(entries.size(), 0);
  std::vector<std::size_t> index(asked.size(), entries.size());
  const auto fits = [&](std::size_t e, const Asked& a) {
    return !taken[e] && entries[e].name == a.name && same(entries[e], a);
  };
  for (std::size_t a = 0; a < asked.size(); ++a) {
    std::size_t e = a;  // the order is usually the same
    if (e >= entries.size() || !fits(e, asked[a])) {
      for (e = 0; e < entries.size() && !fits(e, asked[a]);) ++e;
    }
    if (e == entries.size()) continue;
    taken[e] = 1;
    index[a] = e;
  }
  for (std::size_t a = 0; a < asked.size(); ++a) {
    for (std::size_t e = entries.size(); e-- > 0 && index[a] == entries.size();) {  // entries added last are tried first
      if (same(entries[e], asked[a])) index[a] = e;
    }
    if (index[a] == entries.size()) throw std::logic_error("bind_laws: the system has no place for " + asked[a].name);
  }
  return index;
}

class Finder {
 public:
  explicit Finder(ReducedSystem& system, const effects::HeatBalance& balance) : system_(system), balance_(balance) {}

  /// @param before  surface whose air replaces the ambient, or ""
  void bind(BoundLaw& bound, Law law, const std::string& before) {
    if (!bound.frozen_K.empty()) {  // its temperatures are constants
      bound.law = std::move(law);
      return;
    }
    bound.probes.clear();
    for (const Body& body : law.probes) bound.probes.push_back(probe(body, before));
    bound.thermostat = -1;
    for (std::size_t t = 0; t < balance_.thermostats.size(); ++t) {
      if (balance_.thermostats[t].name == law.thermostat) bound.thermostat = static_cast<int>(t);
    }
    if (!law.thermostat.empty() && bound.thermostat < 0)
      throw std::logic_error("bind_laws: there is no thermostat " + law.thermostat);
    bound.law = std::move(law);
  }
  int probe(const Body& body, const std::string& before) {
    const bool is_ambient = body == effects::ambient_node();
    for (std::size_t p = 0; p < system_.probes.size(); ++p) {  // air before a surface, in a stratified ambient
      if (is_ambient && !before.empty() && system_.probes[p].body == body && system_.probes[p].before == before)
        return static_cast<int>(p);
    }
    for (std::size_t p = 0; p < system_.probes.size(); ++p) {
      if (system_.probes[p].body == body && system_.probes[p].before.empty()) return static_cast<int>(p);
    }
    Probe further;
    further.body = body;
    if (is_ambient) {
      further.weights = Eigen::VectorXd::Zero(system_.size());
      further.ambient_share = 1.0;
    } else {  // the mean temperature of a body is read with the weights of its heat load
      const auto source =
          std::find_if(system_.sources.begin(), system_.sources.end(), [&](const HeatSource& s) { return s.body == body; });
      if (source == system_.sources.end())
        throw std::logic_error("bind_laws: the temperature of " + body.name + " is not known");
      further.weights = source->load;
    }
    system_.probes.push_back(std::move(further));
    return static_cast<int>(system_.probes.size()) - 1;
  }

 private:
  ReducedSystem& system_;
  const effects::HeatBalance& balance_;
};

}  // namespace

void bind_laws(ReducedSystem& system, const effects::HeatBalance& balance) {
  if (!balance.radiations.empty()) throw std::logic_error("bind_laws: radiation must be given as films");
  Finder find(system, balance);
  std::vector<std::vector<const Law*>> laws(system.sources.size());
  const auto of_heat =
      entries_of(system.sources, balance.heats, [](const HeatSource& s, const auto& h) { return s.body == h.body; });
  for (std::size_t h = 0; h < balance.heats.size(); ++h) laws[of_heat[h]].push_back(&balance.heats[h].power_W);
  std::vector<Law> powers;
  for (std::size_t s = 0; s < system.sources.size(); ++s) {
    powers.push_back(sum_of(laws[s]));
    find.bind(system.sources[s].power_W, powers.back(), "");
  }

  laws.assign(system.exchanges.size(), {});
  const auto of_exchange = entries_of(system.exchanges, balance.exchanges, [](const auto& e, const auto& asked) {
    return !e.prescribes && e.slope_of < 0 && e.place == place_of(asked) &&
           (e.medium.size() > 0) == asked.medium_K.has_value();
  });
  for (std::size_t x = 0; x < balance.exchanges.size(); ++x) {
    const effects::Exchange& asked = balance.exchanges[x];
    std::size_t entry = of_exchange[x];
    if (asked.medium_K && !laws[entry].empty()) {  // two media at one place need another entry
      system.exchanges.push_back(system.exchanges[entry]);
      laws.emplace_back();
      entry = laws.size() - 1;
    }
    // The air temperatures of a pattern are those of its file, and stay.
    if (asked.medium_K && asked.part.is_even()) system.exchanges[entry].hold_medium(*asked.medium_K - system.reference_K);
    laws[entry].push_back(&asked.coefficient);
  }
  const Law one([](const Inputs&) { return 1.0; });
  for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
    auto& entry = system.exchanges[e];
    if (entry.prescribes) {
      entry.coefficient.law = one;
      continue;
    }
    if (entry.slope_of >= 0) {
      entry.coefficient.law = powers.at(static_cast<std::size_t>(entry.slope_of));
      continue;
    }
    const bool has_air = entry.place.body.kind == effects::BodyKind::kSurface && entry.place.per == effects::Per::kArea;
    find.bind(entry.coefficient, sum_of(laws[e]), has_air ? entry.place.body.name : "");
  }

  std::vector<Thermostat> thermostats;
  for (const effects::Thermostat& t : balance.thermostats)
    thermostats.push_back({t.name, find.probe(t.probe, ""), t.on_above_K, t.off_below_K});
  system.thermostats = std::move(thermostats);
  std::vector<double>& times_s = system.change_times_s = balance.change_times_s;
  std::sort(times_s.begin(), times_s.end());
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
}

}  // namespace driftwright::solver
