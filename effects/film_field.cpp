#include "effects/film_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.hpp"
#include "effects/effect.hpp"

namespace driftwright::effects {

FieldStates film_field_states(const Effect& e) {
  if (e.field) {
    FieldStates states = e.field->states;
    if (e.field->air_K.size() == 0 && e.has("air")) states.air_K = e["air"];
    return states;
  }
  FieldStates states;
  if (e.has("air")) states.air_K = e["air"];
  for (const auto& [name, over] : {std::pair{"over_speed", FieldOver::kSpeed}, {"over_time", FieldOver::kTime}}) {
    const auto table = e.tables.find(name);
    if (table == e.tables.end()) continue;
    states = {over, table->second.time_s, table->second.value, states.air_K};
  }
  return states;
}

Effect without_its_file(Effect e) {
  if (!e.field) return e;
  const FieldStates states = film_field_states(e);
  if (!std::isnan(states.air_K)) e.set("air", states.air_K);
  if (states.over != FieldOver::kNothing)
    e.tables[states.over == FieldOver::kSpeed ? "over_speed" : "over_time"] = {states.at, states.mean_film_W_m2K};
  return e;
}

namespace film_field {

/// The share of a change between two states that has happened at `x`: 0 at `a`, 1 at `b`, constant beyond.
double ramp(double x, double a, double b) {
  return std::clamp((x - a) / (b - a), 0.0, 1.0);
}

/// The middle of the step of a time: laws are constant between two changes, so a film over time goes in kStepsAPeriod steps
/// from one of its times to the next. The step has the mean of the linear course, so its integral over time is exact.
double middle_of_step_s(double time_s, const std::vector<double>& at_s) {
  const auto next = std::upper_bound(at_s.begin(), at_s.end(), time_s);
  if (next == at_s.begin() || next == at_s.end()) return time_s;
  const double from_s = *(next - 1), step_s = (*next - from_s) / kStepsAPeriod;
  return from_s + (std::floor((time_s - from_s) / step_s) + 0.5) * step_s;
}

void contribute(const Effect& e, HeatBalance& balance) {
  const FieldStates states = film_field_states(e);
  const int n = static_cast<int>(states.at.size());
  const bool falls = states.mean_film_W_m2K.back() < states.mean_film_W_m2K.front();
  const double factor = e["factor"];
  const std::string surrounding = e.references.at("surrounding").name;
  const auto add = [&](int from, int to, Law law) {
    Exchange x = make_film(e.name(), e.place, std::move(law), surrounding);
    x.part = {.field = e.field,
              .id = fmt::format("{} {} {} {}", e.words.at("file"), e.words.at("film_column"), from, to),
              .from = from,
              .to = to,
              .reach_m = e["reach"],
              .even_air_K = e["air"]};
    if (!std::isnan(states.air_K) && to != FieldPart::kUncovered) x.medium_K = states.air_K;
    balance.exchanges.push_back(std::move(x));
  };
  add(FieldPart::kNone, falls ? n - 1 : 0, [factor](const Inputs&) { return factor; });
  for (int k = 1; k < n; ++k) {
    const int from = falls ? n - k : k - 1, to = falls ? n - k - 1 : k;
    const double a = states.at[static_cast<std::size_t>(from)], b = states.at[static_cast<std::size_t>(to)];
    if (states.over == FieldOver::kSpeed) {
      add(from, to, [=](const Inputs& u) { return factor * ramp(u.drive.speed_rpm, a, b); });
    } else {
      add(from, to, [=, at = states.at](const Inputs& u) { return factor * ramp(middle_of_step_s(u.time_s, at), a, b); });
    }
  }
  if (states.over == FieldOver::kTime) {
    for (int k = 1; k < n; ++k) {
      const double from_s = states.at[static_cast<std::size_t>(k - 1)], to_s = states.at[static_cast<std::size_t>(k)];
      const int n_steps = static_cast<int>(kStepsAPeriod);
      for (int i = k == 1 ? 0 : 1; i <= n_steps; ++i) {
        const double t_s = i == n_steps ? to_s : from_s + i * (to_s - from_s) / kStepsAPeriod;
        if (t_s > 0.0) balance.change_times_s.push_back(t_s);
      }
    }
  }
  if (e.has("elsewhere"))
    add(FieldPart::kNone, FieldPart::kUncovered, [film = e["elsewhere"]](const Inputs&) { return film; });
}

EffectKind kind() {
  return {
      .key = "film_field",
      .title = "film on a surface that differs from place to place, from a file: a CFD result",
      .law =
          "q = factor h(x) (T - T_air(x)), h and h T_air from a file at points or cells, linear between its speeds or "
          "times and constant beyond; mapped so that the integrals of h and h T_air are kept (docs/how-to/films.md)",
      .places = {Place::kSurface},
      .parameters =
          {{"factor", "1", 0.0, 1e3, 1.0, "on the film coefficients of the file", 0.1, "convection"},
           {"air", "degC", 150.0, 1000.0, kNotGiven,
            "temperature of the air before the whole surface, if the file has none; without both: that of the surrounding"},
           {"elsewhere", "W/(m^2 K)", 0.0, 1e6, kNotGiven,
            "film to the surrounding on faces that the file does not cover; without it, faces that are not covered are an "
            "error",
            0.1, "convection"},
           {"reach", "m", 1e-6, 10.0, kNotGiven,
            "how far from a point or cell of the file a face may be; left out: twice the largest distance from a point to "
            "its nearest neighbour, or the side of a square as large as the largest cell"}},
      .timing = Timing::kInTime,
      .contribute = contribute,
      .references = {surrounding_reference()},
      .choices = {{"units", {"m", "mm"}, "m", "lengths in a .vtu, .vtp, .vtk or raw file; a CSV says it in its header"}},
      .tables = {{"over_speed", "rpm", "W/(m^2 K)", 0.0, 1e9, false,
                  "mean film at each speed, as the program writes it into a model's file; a scenario needs none"},
                 {"over_time", "s", "W/(m^2 K)", 0.0, 1e9, false, "or: at each time"}},
      .mentions =
          {{"file", Mention::Of::kFile, true,
            "CSV, .vtu, .vtp, .vtk or OpenFOAM's raw file, relative to the scenario; with <rpm>, <s> or <min> in its "
            "name all files of that pattern, one an operating point or time"},
           {"film_column", Mention::Of::kText, false,
            "column or array of the film coefficient in W/(m^2 K); left out: h_W_m2K of a CSV, the only value of a "
            "raw file"},
           {"air_column", Mention::Of::kText, false,
            "column or array of the air temperature, in degC if its name ends with _degC, else in K; left out: "
            "T_air_degC or T_air_K of a CSV, if there is one"}},
      .exchange_finding = "convection"};
}

}  // namespace film_field
}  // namespace driftwright::effects
