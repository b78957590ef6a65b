#include "compensation/predictors/drift_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "compensation/predictors/control_tables.hpp"

namespace driftwright::compensation {
namespace {

double first_value(const std::vector<double>& x) {
  const auto found = std::find_if(x.begin(), x.end(), [](double v) { return std::isfinite(v); });
  return found == x.end() ? 0.0 : *found;
}

}  // namespace

bool is_drive(const std::string& unit) {
  return unit == "rpm" || unit == "mm_min" || unit == "W";
}

std::vector<double> lagged(std::span<const double> time_s, std::span<const double> x, int power, double lag_s,
                           bool is_drive) {
  const drift_term term{
      .input = 0, .is_rise = 0, .holds = is_drive, .is_running = 0, .power = power, .coefficient = 1.0, .lag_s = lag_s};
  drift_term_state state{};
  std::vector<double> result;
  for (std::size_t i = 0; i < x.size(); ++i)
    result.push_back(drift_term_value(&term, &state, x[i], i > 0 ? time_s[i] - time_s[i - 1] : 0.0));
  return result;
}

std::vector<double> taken_by(const DriftModel::Term& term, std::vector<double> x) {
  if (!term.is_running) return x;
  for (double& v : x) {
    if (!std::isnan(v)) v = v != 0.0 ? 1.0 : 0.0;
  }
  return x;
}

Record counted_from_start(Record record, const std::string& target) {
  for (Channel& channel : record.channels) {
    if (channel.name != target && channel.header() != target && channel.unit != "degC" && channel.unit != "K") continue;
    const double start = first_value(channel.values);
    for (double& v : channel.values) v -= start;
  }
  return record;
}

std::vector<std::string> DriftModel::inputs() const {
  std::vector<std::string> names;
  for (const Term& t : terms) {
    if (std::find(names.begin(), names.end(), t.input) == names.end()) names.push_back(t.input);
  }
  return names;
}

std::vector<double> DriftModel::predict(const Record& record) const {
  const std::vector<std::string> names = inputs();
  std::vector<const std::vector<double>*> channels;
  for (const Term& t : terms) {
    const Channel& channel = record.at(t.input);
    if (channel.unit != t.unit) {
      throw InputError(fmt::format("channel '{}' of {} is in {}, but the model was fitted in {}", t.input, record.source,
                                   channel.unit, t.unit));
    }
  }
  for (const std::string& name : names) channels.push_back(&record.at(name).values);
  const FormulaTable table = formula_table(*this, names);
  std::vector<drift_term_state> states(terms.size());
  std::vector<double> readings(names.size()), predicted;
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    for (std::size_t k = 0; k < names.size(); ++k) readings[k] = (*channels[k])[i];
    const double dt_s = i > 0 ? record.time_s[i] - record.time_s[i - 1] : 0.0;
    predicted.push_back(drift_formula_value(&table.formula, states.data(), readings.data(), dt_s));
  }
  return predicted;
}

}  // namespace driftwright::compensation
