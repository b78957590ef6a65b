#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.hpp"
#include "effects/lasting.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::effects::recorded_drive {

constexpr double kMedium_K =
    kZeroCelsius_K + 20.0;  // of an exchange with a recorded temperature; a heat provides the difference
constexpr double kLowestExponent = 0.1, kHighestExponent = 4.0;  // of a column, in the search
constexpr double kClearlyFaster = 1.3;   // exponent that differs clearly from proportional; below this it is another gain
constexpr double kOtherMedium_K = 20.0;  // largest difference of a stream from the reference
constexpr int kFewestLevels = 3;         // of a column, to determine an exponent

void contribute(const Effect& e, HeatBalance& balance) {
  const auto signal = signal_of(e.words.at("column"), e["lag"] * 60.0);
  const std::string name = e.name() + " " + e.words.at("column");
  if (e.has("gain")) {
    balance.heats.push_back(
        {name, e.body(), [=, gain = e["gain"], further = e["exponent"] - 1.0, at = e["at"]](const Inputs& u) {
           const double c = signal(u.drive).value_or(0.0);
           if (further == 0.0) return gain * c;
           return c != 0.0 ? gain * std::abs(c) * std::pow(std::abs(c) / at, further) : 0.0;
         }});
    return;
  }
  Exchange exchange{.name = name, .body = e.body(), .coefficient = {}, .per = Per::kTotal};
  if (e.has("opening")) {
    exchange.coefficient = [=, opening = e["opening"]](const Inputs& u) { return opening * signal(u.drive).value_or(0.0); };
    if (e.has("medium")) {
      exchange.medium_K = e["medium"];
    } else {
      exchange.surrounding = e.references.at("surrounding").name;
    }
    balance.exchanges.push_back(exchange);
    return;
  }
  const double conductance_W_K = e["conductance"], medium_C = kMedium_K - kZeroCelsius_K;
  exchange.coefficient = [=](const Inputs& u) { return signal(u.drive) ? conductance_W_K : 0.0; };
  exchange.medium_K = kMedium_K;
  balance.exchanges.push_back(exchange);
  balance.heats.push_back(
      {name, e.body(), [=](const Inputs& u) { return conductance_W_K * (signal(u.drive).value_or(medium_C) - medium_C); }});
}

void change_drive(const Effect& e, DriveChange& change) {
  const std::string column = e.words.at("column");
  if (is_drive_channel(column)) return;
  change.drive.push_back(
      [=, lag_s = e["lag"] * 60.0](const Cyclogram& recorded) { return with_signal(recorded, column, lag_s); });
}

void check(const Effect& e, const ConfigMap& in) {
  const int n_given =
      static_cast<int>(e.has("gain")) + static_cast<int>(e.has("conductance")) + static_cast<int>(e.has("opening"));
  if (n_given != 1) {
    in.fail("gain",
            "exactly one of the three is required: `gain`, W per unit of the column; `conductance`, W/K to a body as warm "
            "as the column "
            "says; `opening`, W/K per unit of the column, to `surrounding` or to a `medium`");
  }
  if (e["exponent"] != 1.0 && !e.has("gain")) in.fail("exponent", "this key requires a `gain`");
  if (e["exponent"] != 1.0 && !e.has("at"))
    in.fail("at", "`exponent` requires the value of the column at which `gain` holds");
  if (e.has("medium") && !e.has("opening")) in.fail("medium", "this key requires an `opening`");
  if (e.has("medium") && in.has("surrounding"))
    in.fail("medium", "exactly one of the two is required: a `surrounding` or a `medium`");
  if (e["lag"] > 0.0 && is_drive_channel(e.words.at("column")))
    in.fail("lag", "feeds and cutting power act at once; a lag is one of further columns");
}

/// Prior in W per unit of a column: an unknown heat at the column's span; for a recorded power the factor 1.
double gain_sd(const DoubtScene& s, const DoubtScene::Column& column) {
  return column.unit == "W" ? 1.0 : s.unknown_heat_W() / column.span;
}

Doubt doubt(const Body& body, const DoubtScene::Column& column, const std::string& law, const std::string& number,
            const std::string& unit, double sd) {
  Doubt d{.finding = "recorded_drive",
          .where = body.name,
          .law = fmt::format(fmt::runtime(law), column.header),
          .added = {make_effect("recorded_drive", body, {{number, 0.0}})},
          .numbers = {doubted(number, unit, sd, 0.1 * sd)},
          .trial = 0.1 * sd};
  d.added[0].words["column"] = column.header;
  d.numbers[0].low = 0.0;
  return d;
}

/// Heat by another power of a column than the first: for a motor current the square, its copper loss.
/// @param heats_it  the scenario has a law with this column, which may grow too fast: the additional heat may then be
///                  negative, and grows clearly faster
Doubt power_of(const Body& body, const DoubtScene& s, const DoubtScene::Column& column, bool heats_it) {
  Doubt d = doubt(body, column, "heat by a power of {}", "gain", "W per " + column.unit, gain_sd(s, column));
  d.law += fmt::format(", its gain stated at {:.6g} {}", column.top, column.unit);
  d.added[0].set("at", column.top);
  d.numbers.push_back(doubted("exponent", "1", 0.5, 0.05, 2.0));
  d.numbers[1].low = heats_it ? kClearlyFaster : kLowestExponent;
  if (heats_it) d.numbers[0].low = -1e300;
  d.numbers[1].high = kHighestExponent;
  d.grid = {{0.0}};
  return d;
}

/// Coolant or blown air from a valve, or together with cutting: it has its own temperature.
Doubt stream_of(const Body& body, const DoubtScene& s, const DoubtScene::Column& column) {
  const double nominal_C = s.reference_K - kZeroCelsius_K;
  Doubt d = doubt(body, column, "stream of a medium that {} opens", "opening", "W/K per " + column.unit,
                  0.2 * s.unknown_heat_W() / column.span);
  d.added[0].set("medium", s.reference_K);
  d.numbers.push_back(doubted("medium", "degC", 5.0, 0.5, nominal_C));
  d.numbers[1].low = nominal_C - kOtherMedium_K;
  d.numbers[1].high = nominal_C + kOtherMedium_K;
  d.numbers[1].set = [](std::span<Effect> added, double value) { added[0].set("medium", value + kZeroCelsius_K); };
  d.grid = {{-5.0}, {5.0}};
  return d;
}

/// An effect of a record has another factor in some records or from a time on: one heater element fails, a lid no longer
/// closes.
void doubt_changes(const DoubtScene& s, const Effect& e, std::vector<Doubt>& list) {
  const HeatBalance of = heat_balance({e});
  Doubt other{.finding = "recorded_drive",
              .where = where_of(e),
              .law = "another factor on what is written",
              .added = {},
              .numbers = {doubted_factor()}};
  const std::string& law = of.exchanges.empty() ? of.heats.front().name : of.exchanges.front().name;
  other.added = {make_effect("changed_law", Place::kLaw, law)};
  add_changes(s, other, list);
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const Effect& e : s.own) {
    if (e.kind->key == "recorded_drive" || e.kind->key == "cutting_heat") doubt_changes(s, e, list);
  }
  for (const DoubtScene::Column& column : s.columns) {
    for (const Body& body : s.bodies) {
      const auto is_one_of = [&](const std::vector<Body>& of) { return std::find(of.begin(), of.end(), body) != of.end(); };
      const bool drives_it = is_one_of(column.drives);
      if (column.unit != "K" && !column.is_temperature() && column.n_levels >= kFewestLevels)
        list.push_back(power_of(body, s, column, is_one_of(column.heats)));
      if (drives_it) continue;  // another gain of a written effect is Doubted::kFactor
      if (column.is_temperature()) {
        list.push_back(
            doubt(body, column, "exchange with a body as warm as {} says", "conductance", "W/K", 0.2 * s.unknown_heat_W()));
        continue;
      }
      list.push_back(doubt(body, column, "heat in proportion to {}", "gain", "W per " + column.unit, gain_sd(s, column)));
      if (column.unit == "K") list.back().numbers[0].low = -1e300;  // a difference may be negative
      if (column.unit == "K" || body.kind != BodyKind::kNode) continue;
      list.push_back(stream_of(body, s, column));
      if (column.unit == "W") continue;
      list.push_back(doubt(body, column, "exchange with the ambient that {} opens", "opening", "W/K per " + column.unit,
                           0.2 * s.unknown_heat_W() / column.span));
    }
  }
  return list;
}

EffectKind kind() {
  return {.key = "recorded_drive",
          .title = "heat or exchange by a recorded column: a heater's power, the sun, a bed, a valve",
          .law =
              "P = gain c, with another exponent P = gain |c| |c / at|^(exponent - 1); or Q = conductance (T - c), c in "
              "degC; or Q = opening c (T - T_surrounding), T_surrounding the medium's where one is stated. c: value of the "
              "column in its unit, from each row on; with a "
              "lag: lag dx/dt = c - x for c, settled at the first row",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters = {{"gain", "1", -1e9, 1e9, kNotGiven, "W per unit of the column", 0.1, "recorded_drive",
                          Doubted::kFactor},
                         {"exponent", "1", 0.1, 4.0, 1.0, "of the column, to which the heat grows: a motor's current, 2"},
                         {"at", "1", 1e-12, 1e12, kNotGiven,
                          "beside an exponent: value of the column, in its unit, at which the gain holds"},
                         {"conductance", "W/K", 0.0, 1e9, kNotGiven, "or: to a body as warm as the column says", 0.1,
                          "recorded_drive", Doubted::kFactor},
                         {"opening", "1", 0.0, 1e9, kNotGiven, "or: W/K per unit of the column, to the surrounding", 0.1,
                          "recorded_drive", Doubted::kFactor},
                         {"medium", "degC", 200.0, 500.0, kNotGiven,
                          "beside an opening, instead of a surrounding: temperature of the air or coolant that it lets in"},
                         {"lag", "min", 0.0, 1e5, 0.0, "first-order lag to the column"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .change_drive = change_drive,
          .references = {surrounding_reference()},
          .check = check,
          .mentions =
              {{"column", Mention::Of::kColumn, true,
                "of the record or cyclogram, with its unit (`heater_W`) or without; cutting_power and feed_x, _y, _z, too"}},
          .doubts = doubts};
}

}  // namespace driftwright::effects::recorded_drive
