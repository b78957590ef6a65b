#include "compensation/predictors/score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "compensation/sensors/complete_rows.hpp"
#include "compensation/sensors/interpolate.hpp"

namespace driftwright::compensation {

Score score(std::span<const double> residual) {
  double sum = 0.0;
  double sum_of_squares = 0.0;
  double peak = 0.0;
  int n = 0;
  for (double r : residual) {
    if (std::isnan(r)) continue;
    sum += r;
    sum_of_squares += r * r;
    peak = std::max(peak, std::abs(r));
    ++n;
  }
  if (n == 0) return {};
  return {.rmse = std::sqrt(sum_of_squares / n), .peak_abs = peak, .mean = sum / n, .n = n};
}

std::vector<double> baseline_mean(std::span<const Record> train, const Record& test, const std::string& channel) {
  const CompleteRows rows = complete_rows(train, {channel});
  if (rows.values.rows() == 0) throw InputError(fmt::format("channel '{}' has no value in any training record", channel));
  return std::vector<double>(test.n_samples(), rows.values.mean());
}

std::vector<double> baseline_last(std::span<const Record> train, const Record& test, const std::string& channel) {
  for (auto record = train.rbegin(); record != train.rend(); ++record) {
    const std::vector<double>& values = record->at(channel).values;
    const auto last = std::find_if(values.rbegin(), values.rend(), [](double v) { return std::isfinite(v); });
    if (last != values.rend()) return std::vector<double>(test.n_samples(), *last);
  }
  throw InputError(fmt::format("channel '{}' has no value in any training record", channel));
}

std::vector<double> baseline_same_time(std::span<const Record> train, const Record& test, const std::string& channel) {
  if (train.empty()) throw InputError("no training record was given; at least one is required");
  std::vector<double> predicted;
  for (double t_s : test.time_s) {
    double sum = 0.0;
    int n = 0;
    for (const Record& record : train) {
      const double value = interpolate(record.time_s, record.at(channel).values, t_s);
      if (std::isnan(value)) continue;
      sum += value;
      ++n;
    }
    predicted.push_back(n > 0 ? sum / n : std::numeric_limits<double>::quiet_NaN());
  }
  return predicted;
}

}  // namespace driftwright::compensation
