#include "effects/effect.hpp"
#include "effects/film_formulas.hpp"
#include "effects/law_steps.hpp"

namespace driftwright::effects::natural_convection {

Orientation orientation(const std::string& word) {
  if (word == "vertical") return Orientation::kVertical;
  if (word == "up") return Orientation::kUp;
  if (word == "down") return Orientation::kDown;
  return Orientation::kHorizontalCylinder;
}

void contribute(const Effect& e, HeatBalance& balance) {
  const double length_m = e["length"], factor = e["factor"];
  const Orientation looks = orientation(e.words.at("orientation"));
  const std::string surrounding = e.references.at("surrounding").name;
  const auto htc = [=](const Inputs& u) {
    return factor * natural_convection_htc_W_m2K(looks, length_m, u.probe_K.at(0), u.probe_K.at(1));
  };
  Law film(htc, {e.body(), node(surrounding)});
  film.steps = [=] { return law_steps(natural_convection_formula(looks, length_m, factor), 2); };
  balance.exchanges.push_back(make_film(e.name(), e.place, std::move(film), surrounding));
}

EffectKind kind() {
  return {
      .key = "natural_convection",
      .title = "film of free convection, which grows with the difference of mean temperatures",
      .law =
          "Nu(Ra, Pr) of air at film temperature, 200 K to 500 K; vertical and horizontal_cylinder: Churchill & Chu 1975; "
          "up and down: McAdams 1954 (warm plates; the two change places when the plate is the colder)",
      .places = {Place::kSurface},
      .parameters = {{"length", "m", 1e-3, 20.0, {}, "height; of a horizontal plate area / perimeter; diameter"},
                     {"factor", "1", 0.0, 1e3, 1.0, "on the formula's film", 0.1, "convection"}},
      .timing = Timing::kInTime,
      .contribute = contribute,
      .references = {surrounding_reference()},
      .choices = {{"orientation", {"vertical", "up", "down", "horizontal_cylinder"}, {}, "where the surface looks to"}},
      .exchange_finding = "convection"};
}

}  // namespace driftwright::effects::natural_convection
