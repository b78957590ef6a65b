#include "effects/heat_balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "effects/law_steps.hpp"

namespace driftwright::effects {
namespace {

constexpr double kStefanBoltzmann_W_m2K4 = 5.670374419e-8;  // CODATA 2018

int rank(const Exchange& e) {
  return e.body.kind == BodyKind::kJoint ? 2 : e.per == Per::kTotal ? 1 : 0;
}

template <class T>
void move_behind(std::vector<T>& list, std::vector<T>& more) {
  list.insert(list.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

void HeatBalance::append(HeatBalance other) {
  move_behind(heats, other.heats);
  move_behind(exchanges, other.exchanges);
  move_behind(radiations, other.radiations);
  move_behind(nodes, other.nodes);
  move_behind(fixed, other.fixed);
  move_behind(stratifications, other.stratifications);
  move_behind(thermostats, other.thermostats);
  move_behind(change_times_s, other.change_times_s);
  const auto before = [](const auto& a, const auto& b) { return rank(a) < rank(b); };
  if (!std::is_sorted(exchanges.begin(), exchanges.end(), before))
    std::stable_sort(exchanges.begin(), exchanges.end(), before);
}

HeatBalance with_radiation_as_films(HeatBalance balance) {
  HeatBalance films;
  for (const Radiation& r : balance.radiations) {
    const auto coefficient_W_m2K = [emissivity = r.emissivity](const Inputs& u) {
      const double t_K = u.probe_K[0], around_K = u.probe_K[1];
      return kStefanBoltzmann_W_m2K4 * emissivity * (t_K * t_K + around_K * around_K) * (t_K + around_K);
    };
    Law film(coefficient_W_m2K, {surface(r.surface), node(r.surrounding)});
    film.steps = [emissivity = r.emissivity] {
      return law_steps(fmt::format("{}*(T0^2 + T1^2)*(T0 + T1)", written(kStefanBoltzmann_W_m2K4 * emissivity)), 2);
    };
    films.exchanges.push_back(
        {.name = r.name, .body = surface(r.surface), .coefficient = std::move(film), .surrounding = r.surrounding});
  }
  balance.radiations.clear();
  balance.append(std::move(films));
  return balance;
}

}  // namespace driftwright::effects
