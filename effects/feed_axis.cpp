#include "effects/feed_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.hpp"
#include "effects/axis.hpp"
#include "effects/film_formulas.hpp"
#include "effects/law_steps.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::effects {
namespace feed_axis {

constexpr double kFewestSections = 4.0;            // the growth within a section looks at its neighbours
constexpr double kMostSections = 200.0;            // of a rod; each is a lumped body
constexpr double kRounding_mm = 1e-6;              // of positions in mm
const char* const kAtNut = "read out at the nut";  // of Effect::words; no key of a scenario

double length_mm(const Effect& e) {
  return e["fixed_gap"] + e["travel"] + e["far_gap"];
}
double sections_of(const Effect& e) {
  return std::max(kFewestSections, std::ceil(length_mm(e) / e["section_length"] - 1e-9));
}
double area_m2(const Effect& e) {
  return 1e-6 * 0.25 * std::numbers::pi * (e["diameter"] * e["diameter"] - e["bore"] * e["bore"]);
}
bool is_stretched(const Effect& e) {
  return e.words.at("mounting") == "stretched";
}
double compliance_m_N(const Effect& e, const char* stiffness) {
  return e.has(stiffness) ? 1e-6 / e[stiffness] : 0.0;
}

/// Share of the nut's heat in section i at a drive: where the record says that the nut is, else evenly over the travel.
std::function<double(const Drive&, int)> share_of(const Effect& e) {
  const std::string &position = e.words.at("position"), &stroke = e.words.at("stroke");
  const auto read = [](const std::string& column) {
    return column.empty() ? [](const Drive&) { return std::optional<double>(); } : signal_of(column, 0.0);
  };
  return [rod = screw_rod(e), position_mm = read(position), stroke_mm = read(stroke)](const Drive& drive, int i) {
    const std::optional<double> middle_mm = position_mm(drive);
    if (!middle_mm) return nut_share(rod, i, rod.lowest_m + 0.5 * rod.travel_m, rod.travel_m);
    return nut_share(rod, i, 1e-3 * *middle_mm, 1e-3 * stroke_mm(drive).value_or(0.0));
  };
}

/// A factor times that share as a formula, share_of() at a recorded position. @param factor  in v, m/s of the axis
std::function<std::vector<Expression::Step>()> share_steps(const Effect& e, const std::string& factor, int i) {
  const std::string &position = e.words.at("position"), &stroke = e.words.at("stroke");
  if (place_index(position) == kPlaces || (!stroke.empty() && place_index(stroke) == kPlaces)) return {};
  return [rod = screw_rod(e), axis = axis_of(e), place = place_index(position),
          way = stroke.empty() ? kPlaces : place_index(stroke), factor, i] {
    const std::string a = written(rod.nut_length_m), b = way == kPlaces ? "0" : "0.001*s",
                      middle = rod.sense > 0.0 ? "(" + written(rod.nearest_m - rod.lowest_m) + " + 0.001*p)"
                                               : "(" + written(rod.nearest_m + rod.lowest_m + rod.travel_m) + " - 0.001*p)";
    const auto within = [](const std::string& share) { return "min(max(" + share + ", 0), 1)"; };
    const auto below = [&](double face_m) {  // share_below() of screw_rod.cpp
      const std::string x = "(" + written(face_m) + " - " + middle + ")", box = within(x + "/" + a + " + 0.5");
      if (way == kPlaces) return box;
      const auto square = [&](const std::string& beyond) { return "max(" + x + beyond + ", 0)^2"; };
      const std::string outer = "0.5*(" + a + " + " + b + ")", inner = "0.5*abs(" + a + " - " + b + ")",
                        parts = square(" + " + outer) + " - " + square(" + " + inner) + " - " + square(" - " + inner) +
                                " + " + square(" - " + outer);
      return "if(" + b + " > 1e-6*" + a + ", " + within("(" + parts + ")/(2*" + a + "*" + b + ")") + ", " + box + ")";
    };
    const std::string share = "max(" + (i + 1 == rod.n_sections ? std::string("1") : below((i + 1) * rod.section_m())) +
                              " - " + (i == 0 ? std::string("0") : below(i * rod.section_m())) +
                              ", 0)";  // below 0 by rounding
    std::vector<Expression::Step> steps =
        with_constants_folded(parse_expression("(" + factor + ")*" + share, {"v", "p", "s"}).steps);
    const std::size_t names[] = {1 + axis, kFirstPlace + place, kFirstPlace + way};  // v_x, v_y, v_z after n
    for (Expression::Step& step : steps) {
      if (step.op == Op::kName) step.name = names[step.name];
    }
    return steps;
  };
}

void add_heat_of_nut(const Effect& e, const std::vector<Body>& sections, HeatBalance& balance) {
  const double in_screw = e["share"], conductance_W_K = e["nut_conductance"];
  const auto friction_W = [axis = axis_of(e), friction = screw_friction(e)](const Inputs& u) {
    return friction.power_W(u.drive.feed_m_s[axis]);
  };
  balance.heats.push_back({e.name(), e.body(), [=](const Inputs& u) { return (1.0 - in_screw) * friction_W(u); }});
  const auto share = share_of(e);
  for (int i = 0; i < static_cast<int>(sections.size()); ++i) {
    const Body& section = sections[static_cast<std::size_t>(i)];
    Law heat_W([=](const Inputs& u) {
      const double all_W = in_screw * friction_W(u);
      return all_W > 0.0 ? all_W * share(u.drive, i) : 0.0;
    });
    heat_W.steps = share_steps(e, written(in_screw * screw_friction(e).power_W(1.0)) + "*v", i);
    balance.heats.push_back({e.name() + " in the screw", section, std::move(heat_W)});
    if (!(conductance_W_K > 0.0)) continue;
    Law link_W_K([=](const Inputs& u) { return conductance_W_K * share(u.drive, i); });
    link_W_K.steps = share_steps(e, written(conductance_W_K), i);
    balance.exchanges.push_back(make_link(e.name() + " - screw", e.body(), std::move(link_W_K), section.name));
  }
}

/// The film of all sections, which grows as the screw turns.
void add_film(const Effect& e, const std::vector<Body>& sections, double section_m, HeatBalance& balance) {
  const double diameter_m = 1e-3 * e["diameter"], lead_m = 1e-3 * e["lead"], still_W_m2K = e["film"],
               factor = e["film_growth"], around_m2 = std::numbers::pi * diameter_m * section_m;
  const Law film_W_K([=, axis = axis_of(e)](const Inputs& u) {
    const double speed_rpm = screw_speed_rpm(u.drive.feed_m_s[axis], lead_m);
    return around_m2 * (still_W_m2K + factor * rotating_cylinder_htc_W_m2K(diameter_m, speed_rpm));
  });
  for (const Body& section : sections)
    balance.exchanges.push_back(
        make_link(e.name() + " film of the screw", section, film_W_K, e.references.at("surrounding").name));
}

/// The coolant in the bore, which enters at the fixed bearing: W (1 - exp(-G / W)) between inlet and a screw of one
/// temperature, each section with its part of it.
void add_coolant(const Effect& e, const std::vector<Body>& sections, HeatBalance& balance) {
  if (!(e["flow"] > 0.0)) return;
  const double stream_W_K = e["flow"] / 60.0 * e["medium_heat_capacity"];
  const double units = e["passage_conductance"] / stream_W_K / static_cast<double>(sections.size());
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const double part_W_K = -stream_W_K * std::exp(-units * static_cast<double>(i)) * std::expm1(-units);
    balance.exchanges.push_back({.name = e.name() + " coolant in the screw",
                                 .body = sections[i],
                                 .coefficient = [=](const Inputs&) { return part_W_K; },
                                 .per = Per::kTotal,
                                 .medium_K = e["set_point"]});
  }
}

void contribute(const Effect& e, HeatBalance& balance) {
  const ScrewRod rod = screw_rod(e);
  const std::vector<Body> sections = screw_sections(e);
  const double along_W_K = e["conductivity"] * area_m2(e) / rod.section_m();
  for (const Body& section : sections)
    balance.nodes.push_back({section.name, e["heat_capacity"] * area_m2(e) * rod.section_m()});
  add_heat_of_nut(e, sections, balance);
  add_film(e, sections, rod.section_m(), balance);
  add_coolant(e, sections, balance);
  const auto constant = [](double W_K) { return [=](const Inputs&) { return W_K; }; };
  for (std::size_t i = 0; i + 1 < sections.size(); ++i)
    balance.exchanges.push_back(
        make_link(e.name() + " along the screw", sections[i], constant(along_W_K), sections[i + 1].name));
  const auto add_end = [&](const char* bearing, const char* conductance, const Body& section) {
    const auto body = e.references.find(bearing);
    if (body == e.references.end()) return;
    const double seat_W_K = e[conductance], half_section_W_K = 2.0 * along_W_K;
    balance.exchanges.push_back(make_link(e.name() + " - " + body->second.name, body->second,
                                          constant(1.0 / (1.0 / seat_W_K + 1.0 / half_section_W_K)), section.name));
  };
  add_end("fixed_bearing", "fixed_conductance", sections.front());
  add_end("far_bearing", "far_conductance", sections.back());
}

/// Checks that no row of a cyclogram moves the nut out of its travel.
void require_within_travel(const Effect& e, const Cyclogram& recorded) {
  const Cyclogram::Column* position = recorded.column(e.words.at("position"));
  const Cyclogram::Column* stroke = e.words.at("stroke").empty() ? nullptr : recorded.column(e.words.at("stroke"));
  if (!position) return;
  for (const Cyclogram::Column* rows_of : {position, stroke}) {
    if (!rows_of) continue;
    for (std::size_t i = 0; i < rows_of->rows.time_s.size(); ++i) {
      const double time_s = rows_of->rows.time_s[i], middle_mm = position->at(time_s),
                   stroke_mm = stroke ? stroke->at(time_s) : 0.0;
      if (is_within_travel(e, middle_mm, stroke_mm)) continue;
      throw InputError(
          e.where,
          fmt::format(
              "cyclogram '{}' moves the axis out of its travel of {:g} mm to {:g} mm: row {} of column '{}', at {:g} "
              "min, has {:g} mm{}; correct the row, or `lowest` and `travel`",
              recorded.name, e["lowest"], e["lowest"] + e["travel"], i + 1, rows_of->name, time_s / 60.0, middle_mm,
              stroke ? fmt::format(" and a stroke of {:g} mm about it", stroke_mm) : ""));
    }
  }
}

void change_drive(const Effect& e, DriveChange& change) {
  if (e.words.at("position").empty()) return;
  change.drive.push_back([effect = e](const Cyclogram& recorded) {
    require_within_travel(effect, recorded);
    const Cyclogram felt = with_signal(recorded, effect.words.at("position"), 0.0);
    const std::string& stroke = effect.words.at("stroke");
    return stroke.empty() ? felt : with_signal(felt, stroke, 0.0);
  });
}

void change_readings(const Effect& e, ReadingChain& chain) {
  const auto displacement = e.words.find(kAtNut);
  if (displacement == e.words.end()) return;
  chain.add(ReadingStage::kGrowth, [rod = screw_rod(e), sections = screw_sections(e), position = e.words.at("position"),
                                    channel = displacement->second](Readings& r) {
    const Cyclogram::Column* column = r.cyclogram.column(position);
    if (!column) return;
    std::vector<Eigen::Index> rows;
    for (const Body& section : sections) rows.push_back(r.mean_of(section.name));
    std::vector<double> theta_K(rows.size());
    auto error_m = r.value.row(r.displacement(channel));
    for (Eigen::Index i = 0; i < r.n_times(); ++i) {
      for (std::size_t k = 0; k < rows.size(); ++k) theta_K[k] = r.value(rows[k], i);
      error_m[i] += axis_error_m(rod, 1e-3 * column->at(r.time(i)), theta_K);
    }
  });
}

std::vector<Body> reads(const Effect& e) {
  return e.words.contains(kAtNut) ? screw_sections(e) : std::vector<Body>{};
}

void check(const Effect& e, const ConfigMap& in) {
  if (!(e["bore"] < e["diameter"])) in.fail("bore", "the bore must be smaller than the `diameter`");
  if (const double n = sections_of(e); n > kMostSections)
    in.fail("section_length", fmt::format("the screw would have {:g} sections; {:g} are allowed: write at least {:.3g} mm",
                                          n, kMostSections, length_mm(e) / kMostSections));
  if (e.words.at("mounting") == "fixed_free" && e.references.contains("far_bearing"))
    in.fail("far_bearing", "a screw that is mounted fixed_free has no bearing at its far end");
  for (const char* key : {"fixed_stiffness", "far_stiffness", "stretch"}) {
    if (e.has(key) && !is_stretched(e))
      in.fail(key, std::string("`") + key + "` is allowed only with `mounting: stretched`; another screw grows freely");
  }
  if ((e["flow"] > 0.0) != (e["passage_conductance"] > 0.0))
    in.fail("flow", "a cooled screw requires both, `flow` and `passage_conductance`");
  if (e["flow"] > 0.0 && !(e["bore"] > 0.0)) in.fail("flow", "coolant flows in the `bore`, which is missing");
  for (const char* key : {"position", "stroke"}) {
    if (is_drive_channel(e.words.at(key)))
      in.fail(key, "this must be a column in mm, such as position_x; feeds and cutting power are no positions");
  }
  if (e.words.at("position").empty() && !e.words.at("stroke").empty())
    in.fail("stroke", "`stroke` is the way of the nut about its `position`, which is missing");
}

EffectKind kind() {
  return {
      .key = "feed_axis",
      .title = "feed axis: a ball screw in sections, with the heat of its nut where the nut is",
      .law =
          "c A dT/dt = k A d2T/ds2 - pi d (film + film_growth h_turning) (T - T_surrounding) + share P p(s), h_turning of a "
          "turning cylinder (Becker 1963) at the screw's speed, P as of ball_screw, p(s): the nut's length spread over the "
          "stroke about its position, or over the travel. It makes the nodes SCREW_1, SCREW_2, ... from the fixed bearing "
          "on; a displacement with `screw` reads the axis' error int alpha (T - T_reference) ds (docs/how-to/feed_axis.md). "
          "Of a stretched screw: less the growth of the whole, in proportion to compliance up to s",
      .places = {Place::kRegion, Place::kNode},
      .parameters =
          {{"travel", "mm", 1.0, 20e3, {}, "length of the travel"},
           {"lowest", "mm", -1e5, 1e5, 0.0, "position of the axis at the lower end of its travel"},
           {"fixed_gap",
            "mm",
            0.0,
            2000.0,
            {},
            "from the fixed bearing to the middle of the nut at the nearest end of the travel"},
           {"far_gap", "mm", 0.0, 2000.0, {}, "from the middle of the nut at the other end of the travel to the far end"},
           {"section_length", "mm", 2.0, 2000.0, 40.0, "longest section; 200 sections at most"},
           {"diameter", "mm", 4.0, 500.0, {}, "of the screw; of a thread: between root and outer diameter"},
           {"bore", "mm", 0.0, 400.0, 0.0, "of a hollow screw"},
           {"lead", "mm", 0.1, 1000.0, {}, "travel per turn"},
           {"nut_length", "mm", 1.0, 2000.0, {}, "over which the nut heats the screw"},
           {"torque", "N m", 0.0, 1e4, {}, "drag torque of the preloaded nut", 0.1, "feed_axis", Doubted::kFactor},
           {"thrust", "N", 0.0, 1e7, 0.0, "mean axial load"},
           {"efficiency", "1", 0.1, 1.0, 0.9, "from torque to thrust"},
           {"share", "1", 0.0, 1.0, 0.5, "part of the nut's heat that enters the screw; the place has the rest"},
           {"nut_conductance", "W/K", 0.0, 1e4, 0.0, "between the place and the screw, where the nut is"},
           {"film", "W/(m^2 K)", 0.0, 1e4, 6.0,
            "at rest; 10 K warmer than its surrounding, 40 mm: 4.5 by natural_convection, the rest by radiation", 0.1,
            "convection", Doubted::kFactor},
           {"film_growth", "1", 0.0, 100.0, 1.0, "on the film of the turning screw", 0.1, "forced_convection"},
           {"conductivity", "W/(m K)", 0.1, 500.0, 42.0, "of the screw; here and below: bearing_steel of the library"},
           {"heat_capacity", "J/(m^3 K)", 1e5, 1e7, 7810.0 * 470.0, "per volume"},
           {"expansion", "1/K", 0.0, 1e-4, 11.9e-6, "of the screw"},
           {"youngs_modulus", "GPa", 1.0, 1000.0, 208.0, "of a stretched screw"},
           {"fixed_conductance", "W/K", 1e-3, 1e6, 5.0,
            "from the screw's end to `fixed_bearing`; estimate for a pair of balls"},
           {"far_conductance", "W/K", 1e-3, 1e6, 5.0, "from the other end to `far_bearing`"},
           {"fixed_stiffness", "N/um", 1e-3, 1e6, kNotGiven, "of a stretched screw: bearing and seat; left out: rigid"},
           {"far_stiffness", "N/um", 1e-3, 1e6, kNotGiven, "and of the far bearing"},
           {"stretch", "um", 0.0, 1e4, kNotGiven,
            "elongation when mounted, for a far bearing that only pulls; left out: it holds in both directions"},
           {"flow", "L/min", 0.0, 1e4, 0.0, "coolant through the bore, from the fixed bearing on"},
           {"passage_conductance", "W/K", 0.0, 1e6, 0.0, "film times area of the bore"},
           {"medium_heat_capacity", "J/(L K)", 100.0, 1e4, 3800.0, "of the coolant, as of `coolant`"},
           {"set_point", "degC", 230.0, 400.0, kZeroCelsius_K + 20.0, "of the coolant where it enters"}},
      .contribute = contribute,
      .change_drive = change_drive,
      .change_readings = change_readings,
      .references = {surrounding_reference(),
                     {"fixed_bearing",
                      {BodyKind::kNode, BodyKind::kRegion},
                      "",
                      "body of the fixed bearing; left out: no heat passes there"},
                     {"far_bearing", {BodyKind::kNode, BodyKind::kRegion}, "", "body of the bearing at the far end"}},
      .choices = {axis_choice(),
                  {"mounting",
                   {"fixed_free", "fixed_supported", "stretched"},
                   {},
                   "of the ends; fixed_supported: the far bearing carries, but does not hold along the axis"},
                  {"fixed_end", {"low", "high"}, "low", "end of the travel at which the fixed bearing is"}},
      .check = check,
      .mentions = {{"screw", Mention::Of::kOwn, true, "name of the screw; its sections become nodes with it"},
                   {"position", Mention::Of::kColumn, false,
                    "recorded position of the axis in mm (`position_x`); left out: the heat is spread over the travel",
                    "mm"},
                   {"stroke", Mention::Of::kColumn, false,
                    "recorded way in mm over which the nut moves about it, within a row; left out: none", "mm"}},
      .reads = reads};
}

}  // namespace feed_axis

ScrewRod screw_rod(const Effect& e) {
  const bool is_low = e.words.at("fixed_end") == "low";
  return {.length_m = 1e-3 * feed_axis::length_mm(e),
          .n_sections = static_cast<int>(std::min(feed_axis::kMostSections, feed_axis::sections_of(e))),
          .nut_length_m = 1e-3 * e["nut_length"],
          .expansion_1_K = e["expansion"],
          .lowest_m = 1e-3 * e["lowest"],
          .travel_m = 1e-3 * e["travel"],
          .nearest_m = 1e-3 * e["fixed_gap"],
          .sense = is_low ? 1.0 : -1.0,
          .is_held_at_both_ends = feed_axis::is_stretched(e),
          .stiffness_N = 1e9 * e["youngs_modulus"] * feed_axis::area_m2(e),
          .fixed_compliance_m_N = feed_axis::compliance_m_N(e, "fixed_stiffness"),
          .far_compliance_m_N = feed_axis::compliance_m_N(e, "far_stiffness"),
          .stretch_m = e.has("stretch") ? 1e-6 * e["stretch"] : -1.0};
}

std::vector<Body> screw_sections(const Effect& e) {
  std::vector<Body> sections;
  for (int i = 1; i <= screw_rod(e).n_sections; ++i) sections.push_back(node(fmt::format("{}_{}", e.words.at("screw"), i)));
  return sections;
}

Effect* feed_axis_of(std::vector<Effect>& effects, const std::string& screw) {
  const auto found = std::find_if(effects.begin(), effects.end(), [&](const Effect& e) {
    return e.kind->key == "feed_axis" && e.words.at("screw") == screw;
  });
  return found == effects.end() ? nullptr : &*found;
}

std::vector<std::string> screw_names(const std::vector<Effect>& effects) {
  std::vector<std::string> names;
  for (const Effect& e : effects) {
    if (e.kind->key == "feed_axis") names.push_back(e.words.at("screw"));
  }
  return names;
}

std::vector<std::pair<Body, double>> axis_error_at(const Effect& e, double position_m) {
  const double low_mm = e["lowest"], high_mm = low_mm + e["travel"], at_mm = 1e3 * position_m;
  if (!(at_mm >= low_mm - feed_axis::kRounding_mm && at_mm <= high_mm + feed_axis::kRounding_mm))
    throw RangeError(fmt::format("{:g} mm lies outside the travel of {:g} mm to {:g} mm of screw '{}'", at_mm, low_mm,
                                 high_mm, e.words.at("screw")));
  if (e.has("stretch"))
    throw RangeError(
        fmt::format("screw '{}' has a `stretch`, and grows freely once it is used up: no sum over temperatures holds then. "
                    "Leave out `at`, so that the error at the nut is read, or `stretch`, so that both bearings always hold",
                    e.words.at("screw")));
  const std::vector<double> weights_m_K = axis_error_m_K(screw_rod(e), position_m);
  const std::vector<Body> sections = screw_sections(e);
  std::vector<std::pair<Body, double>> terms;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (weights_m_K[i] != 0.0) terms.emplace_back(sections[i], weights_m_K[i]);
  }
  return terms;
}

bool is_within_travel(const Effect& e, double middle_mm, double stroke_mm) {
  const double low_mm = e["lowest"], high_mm = low_mm + e["travel"], half_mm = 0.5 * stroke_mm;
  return half_mm >= 0.0 && middle_mm - half_mm >= low_mm - feed_axis::kRounding_mm &&
         middle_mm + half_mm <= high_mm + feed_axis::kRounding_mm;
}

bool follows_positions(const Effect& e) {
  return e.kind->key == "feed_axis" || e.kind->key == "linear_scale";
}

std::optional<ErrorAlong> error_along(const Effect& e) {
  if (!follows_positions(e)) return std::nullopt;
  if (e.kind->key == "linear_scale") {
    const std::string& position = e.words.at("position");
    const auto weights = [per_mm = 1e-3 * e["expansion"], fixed_mm = e["fixed_at"]](double mm) {
      return std::vector<double>{per_mm * (mm - fixed_mm)};
    };
    if (!position.empty()) return ErrorAlong{e.place, position, {e.references.at("body")}, {}, weights};
    return ErrorAlong{
        e.place, "", {e.references.at("body")}, {}, [weights, at_mm = e["at"]](double) { return weights(at_mm); }};
  }
  const auto displacement = e.words.find(feed_axis::kAtNut);
  if (displacement == e.words.end()) return std::nullopt;
  if (e.has("stretch"))
    throw RangeError(fmt::format("screw '{}' has a `stretch`, and grows freely once it is used up", e.words.at("screw")));
  const ScrewRod rod = screw_rod(e);
  const double low_mm = e["lowest"], high_mm = low_mm + e["travel"];
  std::vector<double> ends_mm = {low_mm, high_mm};
  for (int i = 1; i < rod.n_sections; ++i) {
    const double from_near_mm = 1e3 * (i * rod.section_m() - rod.nearest_m),
                 face_mm = rod.sense > 0.0 ? low_mm + from_near_mm : high_mm - from_near_mm;
    if (face_mm > low_mm + feed_axis::kRounding_mm && face_mm < high_mm - feed_axis::kRounding_mm)
      ends_mm.push_back(face_mm);
  }
  std::sort(ends_mm.begin(), ends_mm.end());
  return ErrorAlong{displacement->second, e.words.at("position"), screw_sections(e), std::move(ends_mm),
                    [rod](double mm) { return axis_error_m_K(rod, 1e-3 * mm); }};
}

void read_out_at_nut(Effect& e, const std::string& displacement) {
  if (e.words.at("position").empty())
    throw RangeError(
        fmt::format("where is the nut of screw '{}'? Name the recorded `position` at its effect, or write places "
                    "of the travel with `at`",
                    e.words.at("screw")));
  if (!e.words.emplace(feed_axis::kAtNut, displacement).second)
    throw RangeError(fmt::format("'{}' follows the nut of screw '{}' already; one displacement a screw does",
                                 e.words.at(feed_axis::kAtNut), e.words.at("screw")));
}

std::string read_at_nut(const Effect& e) {
  const auto displacement = e.words.find(feed_axis::kAtNut);
  return displacement == e.words.end() ? "" : displacement->second;
}

}  // namespace driftwright::effects
