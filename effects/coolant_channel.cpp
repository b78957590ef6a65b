#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "base/quantity.hpp"
#include "effects/channel_formulas.hpp"
#include "effects/coolant_tank.hpp"
#include "effects/flow_path.hpp"
#include "effects/lasting.hpp"
#include "effects/law_steps.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::effects::coolant_channel {

constexpr double kPer_L_min = 1e-3 / 60.0;  // m^3/s
/// Where `along` is given without `sections`. In a wall of one temperature any number is exact, since the liquid follows it
/// exponentially. What remains is where in a section its heat passes: a section has its mean film everywhere, and in a
/// laminar entrance the film falls as x^(-1/3), so a share of n^(-2/3) of the heat is within the first section and too far
/// downstream. This share depends neither on the flow nor on the length. Conduction along the wall evens it out, and the
/// error falls as n^(-1.3): 0.05 K for a wall 22 K warmer than its liquid with 40 (tests/solver/coolant_channel_test.cpp).
constexpr double kSections = 40.0;
constexpr double kUsual_K = kZeroCelsius_K + 20.0;
constexpr double kSetPoint_K = 2.0;   // 1 sigma of a changed set point, as of a coolant
constexpr double kSameLength = 1e-6;  // relative: rounding of a perimeter that the user computed
constexpr double kJ_m3_per_J_L = 1e3;
constexpr double kMm = 1e-3, kMm2 = 1e-6;

/// Temperature at which the liquid's properties are taken [K].
double properties_at_K(const Effect& e) {
  return e.has("properties_at") ? e["properties_at"] : e.has("set_point") ? e["set_point"] : kUsual_K;
}

/// @throws RangeError  where the table of the medium ends
Liquid liquid_of(const Effect& e) {
  const std::string& medium = e.words.at("medium");
  const bool is_given = e.has("medium_heat_capacity") && e.has("medium_conductivity") && e.has("medium_viscosity");
  Liquid liquid;
  if (medium == "oil" || is_given) {
    liquid = mineral_oil(1e-6 * e["medium_viscosity"]);
  } else {
    liquid = medium == "water" ? water_at(properties_at_K(e)) : glycol_30_at(properties_at_K(e));
  }
  if (e.has("medium_heat_capacity")) liquid.heat_capacity_J_m3K = kJ_m3_per_J_L * e["medium_heat_capacity"];
  if (e.has("medium_conductivity")) liquid.conductivity_W_mK = e["medium_conductivity"];
  if (e.has("medium_viscosity")) liquid.viscosity_m2_s = 1e-6 * e["medium_viscosity"];
  return liquid;
}

Channel channel_of(const Effect& e) {
  Channel c{.hydraulic_diameter_m = kMm * e["diameter"], .length_m = kMm * e["length"]};
  c.cross_section_m2 = e.has("cross_section") ? kMm2 * e["cross_section"]
                                              : 0.25 * std::numbers::pi * c.hydraulic_diameter_m * c.hydraulic_diameter_m;
  c.heated_perimeter_m = e.has("perimeter") ? kMm * e["perimeter"] : 4.0 * c.cross_section_m2 / c.hydraulic_diameter_m;
  return c;
}

/// The parts of the wall in the order of flow.
std::vector<Body> walls_of(const Effect& e) {
  std::vector<Body> walls;
  if (!e.words.at("along").empty()) {
    const int n = static_cast<int>(e.has("sections") ? e["sections"] : kSections);
    for (int i = 0; i < n; ++i) walls.push_back(surface(section_name(e.place, i, n)));
    return walls;
  }
  walls.push_back(e.body());
  for (const std::string& name : names_of_text(e.words.at("then"))) walls.push_back({e.body().kind, name});
  return walls;
}

std::string exchange_name(const Effect& e, std::size_t section) {
  return section == 0 ? e.name() : fmt::format("{} {}", e.name(), section + 1);
}

/// The liquid on its way, at any flow.
struct Stream {
  Channel channel;
  Liquid liquid;
  double flow_m3_s = 0.0;  ///< per unit of the column where there is one
  double film_factor = 1.0;
  int n = 1;
  bool with_spindle = false;
  std::function<std::optional<double>(const Drive&)> column;
  std::vector<Passage> constant;  ///< without a column

  [[nodiscard]] double flow_at(const Inputs& u) const {
    if (with_spindle && !(u.drive.speed_rpm > 0.0)) return 0.0;
    return column ? flow_m3_s * std::max(0.0, column(u.drive).value_or(0.0)) : flow_m3_s;
  }
  /// @param own  holds what is computed for this call
  [[nodiscard]] const std::vector<Passage>& at(const Inputs& u, std::vector<Passage>& own) const {
    const double flow = flow_at(u);
    if (!column && flow > 0.0) return constant;
    own = passages(channel, liquid, flow, film_factor, n);
    return own;
  }
};

Stream stream_of(const Effect& e) {
  Stream s{.channel = channel_of(e),
           .liquid = liquid_of(e),
           .flow_m3_s = kPer_L_min * e["flow"],
           .film_factor = e["film_factor"],
           .n = static_cast<int>(walls_of(e).size()),
           .with_spindle = e.words.at("runs") == "while_spindle_turns",
           .column = {},
           .constant = {}};
  if (const std::string& column = e.words.at("column"); !column.empty()) {
    s.column = signal_of(column, 0.0);
  } else {
    s.constant = passages(s.channel, s.liquid, s.flow_m3_s, s.film_factor, s.n);
  }
  return s;
}

/// How much warmer than at the inlet the liquid is after the first sections.
/// @param probe_K  at first_wall + i: the temperature of section i
double rise_K(const std::vector<Passage>& passages, std::size_t n_sections, const std::vector<double>& probe_K,
              std::size_t first_wall, double inlet_K) {
  double rise = 0.0;
  for (std::size_t i = 0; i < n_sections; ++i) rise += passages[i].share * (probe_K[first_wall + i] - inlet_K - rise);
  return rise;
}

/// The heats of contribute() as formulas. They are linear in the temperatures of the sections before: what the liquid has
/// taken up by section i is the sum over j < i of share_j (T_j - inlet), each less what the sections between took from
/// it.
struct HeatFormula {
  std::shared_ptr<const Stream> stream;
  bool has_tank = false;
  double set_point_K = 0.0;

  /// @param weight_W_K  of the rise at each section
  [[nodiscard]] std::vector<Expression::Step> steps(const std::vector<double>& weight_W_K, std::size_t n_probes) const {
    const std::size_t first_wall = has_tank ? 1 : 0;
    const std::vector<Passage>& p = stream->constant;
    std::vector<Expression::Step> steps;
    const auto number = [&](double value) { steps.push_back({.op = Op::kNumber, .number = value}); };
    const auto probe = [&](std::size_t i) { steps.push_back({.op = Op::kName, .name = kDriveNames + i}); };
    const auto apply = [&](std::initializer_list<Op> ops) {
      for (const Op op : ops) steps.push_back({.op = op});
    };
    if (stream->with_spindle) {  // if(n > 0, sum, 0)
      steps.push_back({.op = Op::kName, .name = 0});
      number(0.0);
      apply({Op::kGreater});
    }
    number(0.0);
    for (std::size_t j = 0; j + first_wall < n_probes; ++j) {
      double heat_W_K = 0.0, left = p[j].share;
      for (std::size_t i = j + 1; i < weight_W_K.size(); ++i) {
        heat_W_K += weight_W_K[i] * left;
        left *= 1.0 - p[i].share;
      }
      number(heat_W_K);
      probe(j + first_wall);
      if (has_tank) {
        probe(0);
      } else {
        number(set_point_K);
      }
      apply({Op::kSubtract, Op::kMultiply, Op::kAdd});
    }
    if (stream->with_spindle) {
      number(0.0);
      apply({Op::kIf});
    }
    return steps;
  }
};

/// Each section exchanges with the temperature of the inlet, which is symmetric; what it took up before comes back as
/// heat, a law of the sections before. So the liquid has no unknowns, and is quasi-steady: it passes in seconds.
void contribute(const Effect& e, HeatBalance& balance) {
  const std::vector<Body> walls = walls_of(e);
  const auto stream = std::make_shared<const Stream>(stream_of(e));
  const bool has_tank = e.references.contains("tank");
  const Body tank = has_tank ? node(e.references.at("tank").name) : Body{};
  const std::size_t first_wall = has_tank ? 1 : 0;  // among the probes
  const double set_point_K = has_tank ? 0.0 : e["set_point"];
  const auto inlet_K = [=](const Inputs& u) { return has_tank ? u.probe_K[0] : set_point_K; };
  const auto looks_at = [&](std::size_t n_sections) {
    std::vector<Body> probes(walls.begin(), walls.begin() + static_cast<std::ptrdiff_t>(n_sections));
    if (has_tank) probes.insert(probes.begin(), tank);
    return probes;
  };
  const HeatFormula formula{stream, has_tank, set_point_K};
  /// A law whose heat is what the rise at each section, times its conductance and a sign, brings or takes.
  const auto with_formula = [&](Law law, std::size_t first, std::size_t last, double sign) {
    if (stream->column) return law;
    law.steps = [=, n_probes = law.probes.size()] {
      std::vector<double> weight_W_K(last + 1, 0.0);
      for (std::size_t i = first; i <= last; ++i) weight_W_K[i] = sign * stream->constant[i].conductance_W_K;
      return formula.steps(weight_W_K, n_probes);
    };
    return law;
  };
  for (std::size_t i = 0; i < walls.size(); ++i) {
    Exchange passage{.name = exchange_name(e, i),
                     .body = walls[i],
                     .coefficient =
                         [=](const Inputs& u) {
                           std::vector<Passage> own;
                           return stream->at(u, own)[i].conductance_W_K;
                         },
                     .per = Per::kTotal};
    if (has_tank) {
      passage.surrounding = tank.name;
    } else {
      passage.medium_K = set_point_K;
    }
    balance.exchanges.push_back(std::move(passage));
    if (i == 0) continue;
    balance.heats.push_back({"medium of " + exchange_name(e, i), walls[i],
                             with_formula(Law(
                                              [=](const Inputs& u) {
                                                std::vector<Passage> own;
                                                const std::vector<Passage>& p = stream->at(u, own);
                                                return p[i].conductance_W_K *
                                                       rise_K(p, i, u.probe_K, first_wall, inlet_K(u));
                                              },
                                              looks_at(i)),
                                          i, i, 1.0)});
  }
  if (!has_tank) return;
  if (walls.size() > 1) {  // what came back to the walls has not reached the tank
    const std::size_t before_last = walls.size() - 1;
    balance.heats.push_back({"medium of " + exchange_name(e, 0), tank,
                             with_formula(Law(
                                              [=](const Inputs& u) {
                                                std::vector<Passage> own;
                                                const std::vector<Passage>& p = stream->at(u, own);
                                                double kept_W = 0.0, rise = 0.0;
                                                for (std::size_t i = 0; i < p.size(); ++i) {
                                                  kept_W += p[i].conductance_W_K * rise;
                                                  if (i < before_last) {
                                                    rise += p[i].share * (u.probe_K[first_wall + i] - inlet_K(u) - rise);
                                                  }
                                                }
                                                return -kept_W;
                                              },
                                              looks_at(before_last)),
                                          0, before_last, -1.0)});
  }
  if (e.has("volume")) {
    add_tank(
        e, stream->liquid.heat_capacity_J_m3K / kJ_m3_per_J_L,
        [=](const Inputs& u) { return stream->flow_at(u) > 0.0 ? 1.0 : 0.0; }, balance);
  }
}

void change_drive(const Effect& e, DriveChange& change) {
  const std::string column = e.words.at("column");
  if (column.empty() || is_drive_channel(column)) return;
  change.drive.push_back([=](const Cyclogram& recorded) { return with_signal(recorded, column, 0.0); });
}

void check(const Effect& e, const ConfigMap& in) {
  check_tank(e, in, true);
  const bool is_cut = in.has("along");
  if (is_cut && e.place_kind != Place::kSurface)
    in.fail("along", "`along` cuts a `surface` of a mesh into sections; bodies in the order of flow are listed in `then`");
  if (is_cut && in.has("then"))
    in.fail("then", "`along` cuts one surface into sections; for several surfaces leave it out, each is then one section");
  if (in.has("sections") && !is_cut) in.fail("sections", "this key requires `along`, the line that orders the sections");
  if (e.has("sections") && e["sections"] != std::floor(e["sections"])) in.fail("sections", "this must be a whole number");
  if (is_cut) {
    const std::vector<Point_mm> points = points_of_text(e.words.at("along"));
    if (std::adjacent_find(points.begin(), points.end()) != points.end() || points.size() < 2)
      in.fail("along", "this must be two points or more, from the inlet to the outlet, each other than the one before");
  }
  const Channel channel = channel_of(e);
  const double wetted_m = 4.0 * channel.cross_section_m2 / channel.hydraulic_diameter_m;
  if (channel.heated_perimeter_m > (1.0 + kSameLength) * wetted_m) {
    in.fail("perimeter", fmt::format("the part that exchanges heat is longer than the whole wetted perimeter, "
                                     "4 cross_section / diameter = {:.4g} mm",
                                     wetted_m / kMm));
  }
  if (e.words.at("medium") == "oil" && !e.has("medium_viscosity"))
    in.fail("medium_viscosity", "`medium: oil` requires its viscosity at the temperature at which it runs");
  try {
    (void)liquid_of(e);
  } catch (const RangeError& error) {
    in.fail(in.has("properties_at") ? "properties_at"
            : in.has("set_point")   ? "set_point"
                                    : "medium",
            fmt::format("{}; the table of `medium: {}` ends there. Give `properties_at` within it, or "
                        "`medium_heat_capacity`, `medium_conductivity` and `medium_viscosity`",
                        error.what(), e.words.at("medium")));
  }
  if (!e.words.at("column").empty()) return;  // its flows are known in a run
  try {
    (void)stream_of(e);
  } catch (const RangeError& error) {
    in.fail("flow", fmt::format("no law of channels holds for this flow: {}", error.what()));
  }
}

/// A channel in the scenario with another film, or with another set point, in some records or from a time on.
std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const Effect& channel : s.own) {
    if (channel.kind->key != "coolant_channel" || !channel.words.at("column").empty()) continue;
    const std::vector<Passage> passages = stream_of(channel).constant;
    Doubt other{.finding = "coolant",
                .where = where_of(channel),
                .law = "another film along the channel",
                .added = {},
                .numbers = {doubted_factor()}};
    std::vector<double> left;  // of a warmer inlet, at the inlet of each section
    for (std::size_t i = 0; i < passages.size(); ++i) {
      other.added.push_back(make_effect("changed_law", Place::kLaw, exchange_name(channel, i)));
      left.push_back(i == 0 ? 1.0 : left.back() * (1.0 - passages[i - 1].share));
    }
    add_changes(s, other, list);
    if (channel.references.contains("tank")) continue;
    const double written_C = channel["set_point"] - kZeroCelsius_K;
    DoubtedNumber set_point = doubted("set_point", "degC", kSetPoint_K, 0.1 * kSetPoint_K, written_C);
    set_point.set = [=](std::span<Effect> added, double value) {
      for (std::size_t i = 0; i < added.size(); ++i) added[i].set("warmer", left[i] * (value - written_C));
    };
    other.law = "another set point";
    other.numbers = {set_point};
    other.trial = 0.25 * kSetPoint_K;
    add_changes(s, other, list);
  }
  return list;
}

EffectKind kind() {
  EffectKind kind{
      .key = "coolant_channel",
      .title = "coolant or oil along a channel, a bore or a jacket, that becomes warmer on its way",
      .law =
          "q_i = W (1 - exp(-NTU_i)) (T_i - T_in,i), T_in,i+1 = T_in,i + q_i / W, W = flow c: sections of one wall "
          "temperature "
          "each (Incropera & DeWitt, ch. 8.3), in the order of flow; NTU_i by the mean Nusselt number up to its ends: "
          "laminar "
          "up to Re = 2300 with a thermal entrance (VDI Heat Atlas G1: 3.66 far from the inlet), turbulent from 4000 to 5e6 "
          "(Gnielinski, Int. Chem. Eng. 16 (1976) 359), linear between them (Gnielinski, Int. J. Heat Mass Transfer 63 "
          "(2013) "
          "134). A tank as `coolant` has it. The liquid is quasi-steady: it passes within seconds. At rest it exchanges "
          "nothing",
      .places = {Place::kSurface, Place::kRegion, Place::kNode},
      .parameters = {{"flow",
                      "L/min",
                      1e-3,
                      1e5,
                      {},
                      "through the channel; with `column`: per unit of it",
                      0.1,
                      "coolant",
                      Doubted::kFactor},
                     {"diameter", "mm", 0.1, 2000.0, {}, "hydraulic: 4 cross_section / wetted perimeter; of a bore its own"},
                     {"length", "mm", 1.0, 1e6, {}, "of the way of the liquid; of a helix unwound"},
                     {"cross_section", "mm^2", 1e-2, 4e6, kNotGiven, "of the channel; left out: of a round bore"},
                     {"perimeter", "mm", 0.1, 1e5, kNotGiven,
                      "the part of the wetted perimeter that exchanges heat; left out: all, 4 cross_section / diameter"},
                     {"sections", "1", 1.0, 200.0, kNotGiven, "with `along`: into which the surface is cut; left out: 40"},
                     {"film_factor", "1", 0.01, 100.0, 1.0, "on the film: roughness, swirl after a bend, deposits", 0.1,
                      "coolant", Doubted::kFactor},
                     {"properties_at", "degC", 230.0, 450.0, kNotGiven,
                      "temperature of the liquid's properties; left out: the set point, without one 20 degC"},
                     {"medium_heat_capacity", "J/(L K)", 100.0, 1e4, kNotGiven, "in place of that of `medium`, per volume"},
                     {"medium_conductivity", "W/(m K)", 0.01, 10.0, kNotGiven, "in place of that of `medium`"},
                     {"medium_viscosity", "mm^2/s", 0.05, 1e5, kNotGiven, "in place of that of `medium`, kinematic"}},
      .timing = Timing::kInTime,
      .contribute = contribute,
      .change_drive = change_drive,
      .references = {tank_reference(
          "node of the tank, which comes about here with a `volume`, else with another entry; left "
          "out: the inlet is held at the set point")},
      .choices = {runs_choice(),
                  {"medium",
                   {"water", "glycol_30", "oil"},
                   "water",
                   "liquid: water, water with 30 % by mass of ethylene glycol, mineral oil of a given viscosity"}},
      .check = check,
      .mentions = {{"then", Mention::Of::kBodies, false,
                    "further bodies, of the kind of the place, in the order of flow; each is one section of equal length"},
                   {"along", Mention::Of::kPoints, false,
                    "of a surface: points from the inlet to the outlet; each face belongs to the section of the point "
                    "nearest to it"},
                   {"column", Mention::Of::kColumn, false,
                    "recorded column that the flow follows: a flow meter, a pump's speed, a valve"}},
      .doubts = doubts};
  for (Parameter& of_tank : tank_parameters()) kind.parameters.push_back(std::move(of_tank));
  return kind;
}

}  // namespace driftwright::effects::coolant_channel
