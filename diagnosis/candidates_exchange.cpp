#include <fmt/format.h>

#include <algorithm>

#include "diagnosis/candidate_scene.hpp"
#include "diagnosis/scatter.hpp"

namespace driftwright::diagnosis {

void add_exchanges(const Scene& s, std::vector<Candidate>& list) {
  const auto changed = [](const std::string& name, double ChangedExchange::*member) {
    return [name, member](TwinState& t, double value) {
      ChangedExchange c{name};
      c.*member = value;
      t.exchanges.push_back(c);
    };
  };
  const auto find = [&](const std::string& effect, const std::string& where) -> Candidate& {
    for (Candidate& c : list) {
      if (c.effect == effect && c.where == where) return c;
    }
    list.push_back({effect, where, {}});
    return list.back();
  };
  const auto add_from_a_time_on = [&](const std::string& what, const std::string& name, Candidate& c) {
    for (const MeasuredRun& run : s.runs) {
      Knob other = factor([name, in = run.name](TwinState& t, double value) {
        ChangedExchange e{name, value};
        e.in = in;
        t.exchanges.push_back(e);
      });
      c.variants.push_back(
          {what + " from a time on, in " + run.name,
           {other, time_knob("time", length_s(run),
                             [](TwinState& t, double value) { t.exchanges.back().from_s = std::max(1.0, value); })},
           0.3,
           time_grid(length_s(run), 8)});
    }
  };
  const effects::HeatBalance all = scenarios::reducible(effects::heat_balance(s.twin.augmented().model.effects));
  for (std::size_t i = 0; i < all.films.size(); ++i) {
    const effects::Film& f = all.films[i];
    const bool is_own = i < s.own.films.size();
    double standing = 0.0, turning = 0.0;
    if (is_own && f.htc_W_m2K.probes.empty()) {
      standing = f.htc_W_m2K(effects::Inputs{});
      turning = f.htc_W_m2K(effects::Inputs{.drive = {.speed_rpm = s.typical_rpm}});
    }
    const bool grows = turning > standing;
    const bool is_constant = is_own && (!grows || !f.htc_W_m2K.probes.empty());
    if (is_constant) {
      Candidate& c = find("convection", f.surface);
      c.variants.push_back({"another film", {factor(changed(f.name, &ChangedExchange::factor))}, 0.2});
      add_from_a_time_on("another film", f.name, c);
      const bool has_grown =
          std::any_of(all.films.begin(), all.films.begin() + static_cast<std::ptrdiff_t>(s.own.films.size()),
                      [&](const effects::Film& other) {
                        return other.surface == f.surface && other.htc_W_m2K.probes.empty() &&
                               other.htc_W_m2K(effects::Inputs{.drive = {.speed_rpm = s.typical_rpm}}) >
                                   other.htc_W_m2K(effects::Inputs{});
                      });
      if (!has_grown) {
        Knob growth =
            knob("growth", "W/(m^2 K)", 15.0, 2.0, [name = f.name, rpm = s.typical_rpm](TwinState& t, double value) {
              ChangedExchange e{name};
              e.growth = value;
              e.at_speed_rpm = rpm;
              t.exchanges.push_back(e);
            });
        growth.low = 0.0;
        Knob exponent =
            knob("exponent", "1", 0.2, 0.05, [](TwinState& t, double value) { t.exchanges.back().exponent = value; });
        exponent.nominal = 0.75;
        exponent.low = 0.3;
        exponent.high = 1.5;
        find("forced_convection", f.surface)
            .variants.push_back({fmt::format("a film that grows with speed, at {:.0f} rpm", s.typical_rpm),
                                 {growth, exponent},
                                 4.0,
                                 {{0.0}}});
      }
    } else if (is_own) {
      find("forced_convection", f.surface)
          .variants.push_back({"another growth of the film", {factor(changed(f.name, &ChangedExchange::factor))}, 0.2});
    } else {
      Knob film = knob("film", "W/(m^2 K)", 10.0, 1.0, changed(f.name, &ChangedExchange::added));
      film.low = 0.0;
      find("convection", f.surface).variants.push_back({"a film where the scenario has none", {film}, 3.0});
      Knob growth = knob("growth", "W/(m^2 K)", 15.0, 2.0, [name = f.name, rpm = s.typical_rpm](TwinState& t, double value) {
        ChangedExchange e{name};
        e.growth = value;
        e.at_speed_rpm = rpm;
        t.exchanges.push_back(e);
      });
      growth.low = 0.0;
      find("forced_convection", f.surface)
          .variants.push_back({fmt::format("a film that grows with speed, at {:.0f} rpm", s.typical_rpm), {growth}, 4.0});
    }
  }
  const auto conductance = [&](const std::string& where, const std::string& name) {
    Candidate& c = find("contact", where);
    c.variants.push_back({"another conductance", {factor(changed(name, &ChangedExchange::factor))}, 0.2});
    add_from_a_time_on("another conductance", name, c);
  };
  for (const effects::Contact& c : all.contacts) conductance(c.joint, c.name);
  for (const effects::Effect& e : s.twin.augmented().model.effects) {
    if (e.kind->key != "link" && e.kind->key != "air_node") continue;
    const effects::HeatBalance alone = effects::heat_balance({e});
    const std::string where = e.kind->key == "link" ? where_of(e) : e.place + ",hall";
    for (const effects::Link& l : alone.links) conductance(where, l.name);
  }
}

void add_materials(const Scene& s, std::vector<Candidate>& list) {
  for (const Knob& k : scatter(s.twin)) {
    const bool is_material = k.effect == "conductivity" || k.effect == "heat_capacity" || k.effect == "expansion";
    if (!is_material && k.effect != "coolant" && k.effect != "radiation") continue;
    Knob wide = k;
    wide.prior_sd = kFactor;
    wide.step = 0.05;
    const auto same = std::find_if(list.begin(), list.end(),
                                   [&](const Candidate& c) { return c.effect == k.effect && c.where == k.where; });
    const Variant variant{is_material ? "another value" : "another " + k.name, {wide}, 0.2};
    if (same != list.end()) {
      same->variants.push_back(variant);
    } else {
      list.push_back({k.effect, k.where, {variant}});
    }
  }
}

}  // namespace driftwright::diagnosis
