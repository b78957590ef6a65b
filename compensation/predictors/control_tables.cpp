#include "compensation/predictors/control_tables.hpp"

#include <algorithm>
#include <stdexcept>

namespace driftwright::compensation {

FailSafeTable fail_safe_table(const FailSafe& safe) {
  FailSafeTable table;
  for (const FailSafe::Guard& g : safe.guards) {
    table.guards.push_back({.is_rise = safe.from_start && !is_drive(g.unit),
                            .low = g.low,
                            .high = g.high,
                            .most_jump = g.most_jump,
                            .others_intercept = g.others_intercept,
                            .others_coefficient = g.others_coefficient.empty() ? nullptr : g.others_coefficient.data(),
                            .most_apart = g.most_apart,
                            .start_offset = g.start_offset,
                            .start_weight = g.start_weight});
  }
  table.safe = {.n_inputs = static_cast<int>(table.guards.size()),
                .guards = table.guards.data(),
                .most_replaced = most_replaced(table.guards.size()),
                .period_s = safe.period_s,
                .stale_s = safe.stale_s,
                .fade_s = safe.fade_s,
                .back_after_s = kBackAfter * safe.fade_s,
                .back_within = kBackWithin,
                .most_start = safe.most_start,
                .start_s = safe.start_s,
                .lowest_um = safe.lowest_um,
                .highest_um = safe.highest_um,
                .most_rate_um_s = safe.most_rate_um_s};
  return table;
}

FormulaTable formula_table(const DriftModel& model, const std::vector<std::string>& inputs) {
  FormulaTable table;
  for (const DriftModel::Term& t : model.terms) {
    const auto at = std::find(inputs.begin(), inputs.end(), t.input);
    if (at == inputs.end()) throw std::logic_error("a term of a model reads no input");
    table.terms.push_back({.input = static_cast<int>(at - inputs.begin()),
                           .is_rise = model.from_start && !is_drive(t.unit),
                           .holds = is_drive(t.unit),
                           .is_running = t.is_running,
                           .power = t.power,
                           .coefficient = t.coefficient,
                           .lag_s = t.lag_s});
  }
  table.formula = {
      .intercept_um = model.intercept, .n_terms = static_cast<int>(table.terms.size()), .terms = table.terms.data()};
  return table;
}

}  // namespace driftwright::compensation
