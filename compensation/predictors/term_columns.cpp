#include "compensation/predictors/term_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "compensation/predictors/scored_rows.hpp"

namespace driftwright::compensation {

TermColumns term_columns(std::span<const Record> records, const std::vector<DriftModel::Term>& terms,
                         const std::string& target) {
  if (records.empty()) throw InputError("no record was given; at least one is required");
  TermColumns result;
  for (std::size_t i = 0; i < terms.size(); ++i) result.names.push_back(fmt::format("column_{}", i));
  for (const Record& record : records) {
    Record r{.source = record.source, .time_s = record.time_s, .channels = {record.at(target)}};
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const Channel& channel = record.at(terms[i].input);
      r.channels.push_back({result.names[i], channel.unit,
                            lagged(record.time_s, taken_by(terms[i], channel.values), terms[i].power, terms[i].lag_s,
                                   is_drive(channel.unit))});
    }
    // the lead-in only sets the lags: fitted rows begin with the first drift
    const std::vector<double>& drift = r.channels.front().values;
    const auto first = std::find_if(drift.begin(), drift.end(), [](double v) { return std::isfinite(v); });
    if (first != drift.end()) r = own_rows(std::move(r), static_cast<std::size_t>(first - drift.begin()));
    result.records.push_back(std::move(r));
  }
  result.terms = terms;
  for (DriftModel::Term& t : result.terms) t.unit = records.front().at(t.input).unit;
  return result;
}

DriftModel model_of(const ProductSums& sums, std::span<const int> columns, const ScaledFit& fit,
                    const std::vector<DriftModel::Term>& terms, std::string kind) {
  const double unit = sums.deviation(sums.n_inputs());
  DriftModel model{.kind = std::move(kind),
                   .target = sums.target,
                   .target_unit = sums.target_unit,
                   .intercept = sums.mean(sums.n_inputs()) + unit * fit.intercept,
                   .terms = {}};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const int j = columns[i];
    DriftModel::Term term = terms[static_cast<std::size_t>(j)];
    term.coefficient = unit * fit.slope(static_cast<Eigen::Index>(i)) / sums.deviation(j);
    model.intercept -= term.coefficient * sums.mean(j);
    model.terms.push_back(std::move(term));
  }
  return model;
}

}  // namespace driftwright::compensation
