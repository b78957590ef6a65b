#include "findings/film_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/machine_picture.hpp"

namespace driftwright::findings {
namespace {

using output::Datum;
using output::Table;

/// "at 3000 rpm", "at 5 min", or nothing.
std::string state_words(const scenarios::MappedFilm& film, const scenarios::MappedState& state) {
  if (film.over == effects::FieldOver::kSpeed) return fmt::format(" at {:g} rpm", state.at);
  if (film.over == effects::FieldOver::kTime) return fmt::format(" at {:g} min", state.at / 60.0);
  return "";
}

Table films_table(std::span<const scenarios::MappedFilm> films) {
  Table table{.key = "films",
              .title = "Films of files on the mesh",
              .caption =
                  "The integral of the film coefficient over the cells of the file, and over the faces of the machine; "
                  "points of a CSV or raw file have no areas of their own.",
              .columns = {{.key = "film", .title = "film"},
                          {.key = "speed_rpm", .title = "at", .unit = "rpm", .digits = output::decimals(0)},
                          {.key = "time_min", .title = "at", .unit = "min"},
                          {.key = "values", .title = "values"},
                          {.key = "covered_share", .title = "covered", .digits = output::percent(2)},
                          {.key = "uncovered_cm2", .title = "not covered", .unit = "cm2"},
                          {.key = "mean_film_W_m2K", .title = "mean film", .unit = "W/(m2 K)"},
                          {.key = "in_file_W_K", .title = "in the file", .unit = "W/K", .digits = output::decimals(4)},
                          {.key = "mapped_W_K", .title = "on the mesh", .unit = "W/K", .digits = output::decimals(4)}}};
  for (const scenarios::MappedFilm& film : films) {
    const double covered_m2 = film.area_m2 - film.uncovered_m2;
    for (const scenarios::MappedState& state : film.states) {
      table.rows.push_back({film.name, film.over == effects::FieldOver::kSpeed ? Datum(state.at) : Datum(),
                            film.over == effects::FieldOver::kTime ? Datum(state.at / 60.0) : Datum(), film.n_values,
                            covered_m2 / film.area_m2, 1e4 * film.uncovered_m2,
                            covered_m2 > 0.0 ? Datum(state.mapped_W_K / covered_m2) : Datum(),
                            std::isnan(state.in_file_W_K) ? Datum() : Datum(state.in_file_W_K), state.mapped_W_K});
    }
  }
  return table;
}

}  // namespace

void add_films(output::Section& section, std::span<const scenarios::MappedFilm> films, const mesh::Mesh& mesh) {
  if (films.empty()) return;
  add(section, films_table(films));
  for (const scenarios::MappedFilm& film : films) {
    const auto largest = std::max_element(film.states.begin(), film.states.end(),
                                          [](const auto& a, const auto& b) { return a.mapped_W_K < b.mapped_W_K; });
    if (!(film.uncovered_m2 < film.area_m2)) continue;  // no node has a value
    const auto surface =
        static_cast<int>(std::find(mesh.surfaces.begin(), mesh.surfaces.end(), film.surface) - mesh.surfaces.begin());
    const std::string title = film.name + state_words(film, *largest);
    add(section,
        output::Picture{
            .title = title,
            .svg = output::draw_machine(
                {.mesh = &mesh, .field = output::PictureField{"film [W/(m² K)]", largest->node_film_W_m2K, surface}})});
  }
}

}  // namespace driftwright::findings
