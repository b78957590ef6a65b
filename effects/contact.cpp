#include <fmt/format.h>

#include "effects/effect.hpp"

namespace driftwright::effects::contact {

constexpr const char* kTable = "conductance_over_pressure";

void contribute(const Effect& e, HeatBalance& balance) {
  const double conductance_W_m2K = e.tables.contains(kTable) ? e.tables.at(kTable).at(e["pressure"]) : e["conductance"];
  const double factor = e["factor"];
  balance.exchanges.push_back(make_contact(e.name(), e.place, [=](const Inputs&) { return factor * conductance_W_m2K; }));
}

void check(const Effect& e, const ConfigMap& in) {
  const bool has_table = e.tables.contains(kTable);
  if (e.has("conductance") == has_table) {
    in.fail("conductance",
            "exactly one of the two is required: `conductance`, or `conductance_over_pressure` with `pressure`");
  }
  if (e.has("pressure") != has_table)
    in.fail("pressure", "`conductance_over_pressure` and `pressure` must be given together");
  if (!has_table) return;
  const std::vector<double>& pressure_Pa = e.tables.at(kTable).time_s;
  if (!(e["pressure"] >= pressure_Pa.front() && e["pressure"] <= pressure_Pa.back())) {
    in.fail("pressure", fmt::format("{:g} Pa lies outside the table, {:g} Pa to {:g} Pa", e["pressure"], pressure_Pa.front(),
                                    pressure_Pa.back()));
  }
}

EffectKind kind() {
  return {.key = "contact",
          .title = "conductance of a joint, constant or at a pressure",
          .law = "q = conductance (T_a - T_b); from a table: linear between its rows",
          .places = {Place::kJoint},
          .parameters = {{"conductance", "W/(m^2 K)", 0.0, 1e7, kNotGiven,
                          "bolted and scraped: 2000 to 10000; a guideway: 500 to 3000", 0.1, "contact"},
                         {"pressure", "Pa", 0.0, 1e10, kNotGiven, "mean pressure in the joint, where there is a table"},
                         {"factor", "1", 0.0, 1e3, 1.0, "on the conductance, given or from the table"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .tables = {{kTable, "Pa", "W/(m^2 K)", 0.0, 1e7, false, "rows of [pressure, conductance]"}},
          .check = check,
          .exchange_finding = "contact"};
}

}  // namespace driftwright::effects::contact
