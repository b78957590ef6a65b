#include "compensation/drift_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

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
  std::vector<double> result;
  double state = kMissing, before = 0.0, before_s = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i])) {
      result.push_back(kMissing);
      continue;
    }
    const double value = std::pow(x[i], power);
    if (lag_s == 0.0) {
      result.push_back(value);
      continue;
    }
    if (std::isnan(state)) {
      state = is_drive ? 0.0 : value;
    } else {
      const double towards = is_drive ? before : 0.5 * (before + value);
      state += (1.0 - std::exp(-(time_s[i] - before_s) / lag_s)) * (towards - state);
    }
    before = value;
    before_s = time_s[i];
    result.push_back(state);
  }
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
  std::vector<double> predicted(record.n_samples(), intercept);
  for (const Term& t : terms) {
    const Channel& channel = record.at(t.input);
    if (channel.unit != t.unit) {
      throw InputError(fmt::format("channel '{}' of {} is in {}, but the model was fitted in {}", t.input, record.source,
                                   channel.unit, t.unit));
    }
    std::vector<double> x = channel.values;
    if (from_start && !is_drive(t.unit)) {
      const double start = first_value(x);
      for (double& v : x) v -= start;
    }
    const std::vector<double> l = lagged(record.time_s, taken_by(t, std::move(x)), t.power, t.lag_s, is_drive(t.unit));
    for (std::size_t i = 0; i < predicted.size(); ++i) predicted[i] += t.coefficient * l[i];
  }
  return predicted;
}

}  // namespace driftwright::compensation
