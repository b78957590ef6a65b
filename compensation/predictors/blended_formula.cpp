#include "compensation/predictors/blended_formula.hpp"

#include <algorithm>

namespace driftwright::compensation {

void add_term(DriftModel& model, DriftModel::Term term) {
  const auto same = std::find_if(model.terms.begin(), model.terms.end(), [&](const DriftModel::Term& known) {
    return known.input == term.input && known.power == term.power && known.lag_s == term.lag_s &&
           known.is_running == term.is_running;
  });
  if (same == model.terms.end())
    model.terms.push_back(std::move(term));
  else
    same->coefficient += term.coefficient;
}

DriftModel mean_of(std::span<const DriftModel> models, std::string kind) {
  const double share = 1.0 / static_cast<double>(models.size());
  DriftModel mean{.kind = std::move(kind),
                  .target = models.front().target,
                  .target_unit = models.front().target_unit,
                  .intercept = 0.0,
                  .terms = {},
                  .from_start = models.front().from_start};
  for (const DriftModel& model : models) {
    mean.intercept += share * model.intercept;
    for (DriftModel::Term term : model.terms) {
      term.coefficient *= share;
      add_term(mean, std::move(term));
    }
  }
  return mean;
}

}  // namespace driftwright::compensation
