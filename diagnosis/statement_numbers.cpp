// Of effects of the scenario that follow the recorded position of an axis: another value of one of their numbers, by the
// twin itself. Such an effect acts at many places at once, at shares that go with the axis; no course at one place says
// that.

#include <fmt/format.h>

#include <cmath>

#include "diagnosis/naming.hpp"
#include "diagnosis/statement_builder.hpp"
#include "effects/feed_axis.hpp"

namespace driftwright::diagnosis {

void StatementBuilder::numbers_at_positions() {
  for (std::size_t i = 0; i < fitter_.twin().n_own_effects(); ++i) {
    const effects::Effect& e = state_[i];
    if (!effects::follows_positions(e)) continue;
    for (std::size_t p = 0; p < e.values.size(); ++p) {
      const effects::Parameter& number = e.kind->parameters[p];
      const std::optional<StatedQuantity> quantity = quantity_of(number.finding);
      const bool is_factor = number.doubted == effects::Doubted::kFactor;
      if (number.doubted == effects::Doubted::kNo || !quantity || std::isnan(e.values[p])) continue;
      if (is_factor && e.values[p] == 0.0) continue;
      Statement says{.quantity = *quantity,
                     .place = {e.place},
                     .follows = *quantity == StatedQuantity::kHeat ? "own heat" : "constant",
                     .law = fmt::format("another {} of {}", number.name, e.kind->key),
                     .unit_size = is_factor ? kUsualLogarithm : number.shift_sd,
                     .unit = is_factor ? "1" : number.unit};
      if (*quantity == StatedQuantity::kExchange) {
        says.place.emplace_back(effects::kAmbientName);
      } else if (const std::string& position = e.words.at("position"); is_factor && !position.empty()) {
        says.law += ", at " + position;  // another reference point is the same everywhere
      }
      if (const auto body = e.references.find("body");
          *quantity == StatedQuantity::kDisplacement && body != e.references.end())
        says.follows = "temperature of " + body->second.name;
      TwinState other = state_;
      const double step = is_factor ? effects::kFactorTrial : number.shift_sd;
      other[i].values[p] = is_factor ? e.values[p] * std::exp(step) : e.values[p] + step;
      add(std::move(says), exactly(other, step));
    }
  }
}

}  // namespace driftwright::diagnosis
