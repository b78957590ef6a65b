#include "machine/mapped_films.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "machine/found_in_mesh.hpp"
#include "mesh/shape.hpp"
#include "solver/film_mapping.hpp"

namespace driftwright::scenarios {
namespace {

/// A smaller part of a surface is rounding, and none that a user would look for.
constexpr double kNoticedShare = 1e-6;

void require_covered(const effects::Effect& e, const solver::FilmMapping& mapping) {
  const double share = mapping.uncovered_m2 / mapping.area_m2;
  if (e.has("elsewhere") || !(share > kNoticedShare)) return;
  const Eigen::Vector3d x_mm = 1e3 * mapping.uncovered_at_m;
  throw InputError(
      e.where,
      fmt::format(
          "the file does not cover {:.3g} cm2 ({:.2g} %) of surface '{}', such as the face at [{:.1f} mm, {:.1f} mm, "
          "{:.1f} mm]; values count up to {:.3g} mm from their point or cell. Give these faces a film with "
          "`elsewhere: ... W/(m^2 K)`, let values count further with `reach`, or check `units`",
          1e4 * mapping.uncovered_m2, 100.0 * share, e.place, x_mm[0], x_mm[1], x_mm[2], 1e3 * mapping.reach_m));
}

/// How much larger than its surface a file may be. Metres read as millimetres, or the other way, are a factor of 1000; a
/// file of a whole machine or its room for one of its surfaces is seldom beyond 30.
constexpr double kLargestFile = 100.0;

/// Points that are far apart count far away, so that a file in another unit would cover everything.
void require_size(const effects::Effect& e, const mesh::Mesh& mesh) {
  if (e.has("reach")) return;
  Eigen::AlignedBox3d of_surface;
  for (const int facet : mesh.facets_on(mesh.surface(e.place))) {
    for (const int node : mesh.facets.nodes(facet)) of_surface.extend(Eigen::Vector3d(mesh.coords.col(node)));
  }
  const Eigen::Matrix3Xd& point_m = e.field->point_m;
  const double file_m = (point_m.rowwise().maxCoeff() - point_m.rowwise().minCoeff()).norm();
  const double surface_m = of_surface.diagonal().norm();
  if (file_m <= kLargestFile * surface_m) return;
  throw InputError(e.where,
                   fmt::format("the file is {:.4g} mm large, and surface '{}' {:.4g} mm; check the unit of its "
                               "lengths (`units`, or the header of a CSV), or say with `reach` how far a value counts",
                               1e3 * file_m, e.place, 1e3 * surface_m));
}

MappedState state_of(const effects::Effect& e, const mesh::Mesh& mesh, const solver::FilmMapping& mapping, int state) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto n_facets = static_cast<std::size_t>(mesh.facets.size());
  const effects::FieldPart part{.field = e.field, .id = "state", .to = state, .even_air_K = e["air"]};
  const bool has_air = e.field->air_K.size() > 0 || e.has("air");
  MappedState mapped{.at = e.field->states.at[static_cast<std::size_t>(state)],
                     .in_file_W_K = e.field->film_W_K(state) * e["factor"],
                     .mapped_W_K = mapping.film_W_K(part) * e["factor"],
                     .facet_film_W_m2K = std::vector<double>(n_facets, 0.0),
                     .facet_air_K = std::vector<double>(has_air ? n_facets : 0, 0.0),
                     .node_film_W_m2K = Eigen::VectorXd::Zero(mesh.n_nodes())};
  std::vector<double> area_m2(n_facets, 0.0);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(mesh.n_nodes());
  for (const solver::FilmPoint& p : mapping.points) {
    if (p.value < 0) continue;
    const auto facet = static_cast<std::size_t>(p.facet);
    const double film = p.area_m2 * part.film_W_m2K(p.value) * e["factor"];
    area_m2[facet] += p.area_m2;
    mapped.facet_film_W_m2K[facet] += film;
    if (has_air) mapped.facet_air_K[facet] += p.area_m2 * part.film_times_air_W_m2(p.value) * e["factor"];
    const auto nodes = mesh.facets.nodes(p.facet);
    const mesh::ShapeValues s = mesh::shape_values(mesh.facets.shape[p.facet], p.xi);
    // Shape functions of second order are negative in places, and sum to zero at a corner: |N_i| is a mean about the node.
    for (int i = 0; i < s.n; ++i) {
      const double share = std::abs(s.N[i]);
      weight[nodes[static_cast<std::size_t>(i)]] += p.area_m2 * share;
      mapped.node_film_W_m2K[nodes[static_cast<std::size_t>(i)]] += film * share;
    }
  }
  for (std::size_t f = 0; f < n_facets; ++f) {
    if (has_air) mapped.facet_air_K[f] = area_m2[f] > 0.0 ? mapped.facet_air_K[f] / mapped.facet_film_W_m2K[f] : kNone;
    mapped.facet_film_W_m2K[f] = area_m2[f] > 0.0 ? mapped.facet_film_W_m2K[f] / area_m2[f] : kNone;
  }
  for (Eigen::Index n = 0; n < weight.size(); ++n)
    mapped.node_film_W_m2K[n] = weight[n] > 0.0 ? mapped.node_film_W_m2K[n] / weight[n] : kNone;
  return mapped;
}

}  // namespace

std::vector<MappedFilm> mapped_films(const std::vector<effects::Effect>& effects, const mesh::Mesh& mesh) {
  std::vector<MappedFilm> films;
  for (const effects::Effect& e : effects) {
    if (!e.field) continue;
    must_be_one_of(e.where, "surface", e.place, outer_surfaces(mesh));
    require_size(e, mesh);
    const solver::FilmMapping mapping = solver::map_film(mesh, mesh.surface(e.place), *e.field, e["reach"]);
    require_covered(e, mapping);
    films.push_back({.name = e.name(),
                     .surface = e.place,
                     .over = e.field->states.over,
                     .n_values = e.field->n_values(),
                     .has_cells = e.field->has_cells(),
                     .reach_m = mapping.reach_m,
                     .area_m2 = mapping.area_m2,
                     .uncovered_m2 = std::max(0.0, mapping.uncovered_m2),
                     .states = {}});
    for (int s = 0; s < static_cast<int>(e.field->states.at.size()); ++s)
      films.back().states.push_back(state_of(e, mesh, mapping, s));
  }
  return films;
}

}  // namespace driftwright::scenarios
