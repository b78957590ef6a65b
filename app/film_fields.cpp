#include "app/film_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.hpp"

namespace driftwright::app {

std::vector<output::FacetField> facet_fields(const std::vector<scenarios::MappedFilm>& films) {
  std::vector<output::FacetField> fields;
  const auto add = [&](const std::string& name, const std::vector<double>& value) {
    const auto same = std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; });
    if (same == fields.end()) {
      fields.push_back({name, value});
      return;
    }
    for (std::size_t f = 0; f < value.size(); ++f) {  // another surface
      if (!std::isnan(value[f])) same->value[f] = value[f];
    }
  };
  for (const scenarios::MappedFilm& film : films) {
    for (const scenarios::MappedState& state : film.states) {
      const std::string at = film.over == effects::FieldOver::kSpeed  ? fmt::format("_at_{:g}_rpm", state.at)
                             : film.over == effects::FieldOver::kTime ? fmt::format("_at_{:g}_min", state.at / 60.0)
                                                                      : "";
      add("h_W_m2K" + at, state.facet_film_W_m2K);
      if (state.facet_air_K.empty()) continue;
      std::vector<double> air_C = state.facet_air_K;
      for (double& value : air_C) value -= kZeroCelsius_K;
      add("T_air_degC" + at, air_C);
    }
  }
  return fields;
}

void write_films(const scenarios::MachineModel& model, const scenarios::Model& machine, output::ResultsFolder& folder) {
  if (std::none_of(model.effects.begin(), model.effects.end(), [](const effects::Effect& e) { return e.field != nullptr; }))
    return;
  const auto write = [&](const scenarios::PlacedMachine& placed) {
    output::write_mesh(placed.mesh, {}, folder.path("films.vtu"), facet_fields(placed.films));
  };
  if (const scenarios::Machine* full = machine.full()) {
    write(full->placed);
  } else {
    write(scenarios::place(model));
  }
}

}  // namespace driftwright::app
