#include "compensation/predictors/blended_formula.hpp"

#include <algorithm>

namespace driftwright::compensation {

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
      const auto same = std::find_if(mean.terms.begin(), mean.terms.end(), [&](const DriftModel::Term& known) {
        return known.input == term.input && known.power == term.power && known.lag_s == term.lag_s &&
               known.is_running == term.is_running;
      });
      if (same == mean.terms.end())
        mean.terms.push_back(std::move(term));
      else
        same->coefficient += term.coefficient;
    }
  }
  return mean;
}

}  // namespace driftwright::compensation
