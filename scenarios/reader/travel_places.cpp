#include "scenarios/reader/travel_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/lists.hpp"
#include "effects/feed_axis.hpp"

namespace driftwright::scenarios {

void read_axis_error(MachineModel& m, const effects::Effect& feed_axis, DisplacementOutput& d) {
  for (const auto& [body, sensitivity_m_K] : effects::axis_error_at(feed_axis, *d.on_screw->at_m)) {
    d.by_sensitivity->terms.push_back({body, sensitivity_m_K});
    m.written += fmt::format("{}: {} {:.17g}\n", d.name, body.name, sensitivity_m_K);
  }
}

std::vector<DisplacementOutput> places_along(const MachineModel& m, const std::string& displacement) {
  const auto is_place = [](const DisplacementOutput& d) { return d.on_screw && d.on_screw->at_m; };
  const auto self = std::find_if(m.displacements.begin(), m.displacements.end(),
                                 [&](const DisplacementOutput& d) { return d.name == displacement && is_place(d); });
  if (self == m.displacements.end()) return {};
  std::vector<DisplacementOutput> places;
  for (const DisplacementOutput& d : m.displacements) {
    if (is_place(d) && d.on_screw->screw == self->on_screw->screw && d.on_screw->entry == self->on_screw->entry)
      places.push_back(d);
  }
  if (places.size() < 2) return {};
  std::sort(places.begin(), places.end(),
            [](const DisplacementOutput& a, const DisplacementOutput& b) { return *a.on_screw->at_m < *b.on_screw->at_m; });
  return places;
}

void add_places_between(MachineModel& m, const std::string& displacement) {
  const std::vector<DisplacementOutput> places = places_along(m, displacement);
  for (std::size_t k = 1; k < places.size(); ++k) {
    DisplacementOutput between = places[k];
    OnScrew& on = *between.on_screw;
    on.at_m = 0.5 * (*places[k - 1].on_screw->at_m + *on.at_m);
    between.name = fmt::format("{}_{:.0f}", on.entry, 1e3 * *on.at_m);
    const auto has = [&](const auto& list) { return is_in(names_of(list), between.name); };
    if (has(m.displacements) || has(m.sensors) || has(m.tilts)) continue;
    const effects::Effect* axis = effects::feed_axis_of(m.effects, on.screw);
    if (!axis) throw std::logic_error("a displacement reads a screw that no effect makes");
    between.by_sensitivity->terms.resize(on.n_own);
    read_axis_error(m, *axis, between);
    m.displacements.push_back(std::move(between));
  }
}

}  // namespace driftwright::scenarios
