#include "compensation/predictors/memory_regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/errors.hpp"
#include "compensation/predictors/term_columns.hpp"

namespace driftwright::compensation {
namespace {

// On the record fl_thermal (docs/measured.md) finer and coarser lags leave the same on data left out, within its scatter.
constexpr double kTemperatureLags_min[] = {20, 60, 180};
constexpr double kDriveLags_min[] = {2, 5, 10, 20, 40, 80, 160};
// The least keeps levels that were never tried from being made up out of differences of columns that are nearly alike.
constexpr double kPenalties[] = {5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05,
                                 0.1,  0.2,  0.5,  1.0,  2.0,  5.0,  10.0, 30.0, 100.0};
// Times the penalty of a thermometer's reading: what is read goes before what is remembered.
constexpr double kOfMemories = 3.0;
constexpr std::size_t kParts = 24;        // of a single record
constexpr std::size_t kPartsLeftOut = 3;  // neighbours, so that what is predicted is not beside what was fitted

std::vector<DriftModel::Term> terms_of(const std::vector<std::string>& sensors, const std::string& drive,
                                       const std::string& ambient) {
  std::vector<std::string> temperatures = sensors;
  if (!ambient.empty() && std::find(sensors.begin(), sensors.end(), ambient) == sensors.end())
    temperatures.push_back(ambient);
  std::vector<DriftModel::Term> terms;
  for (const std::string& t : temperatures) {
    terms.push_back({.input = t, .unit = {}});
    for (double lag_min : kTemperatureLags_min) terms.push_back({.input = t, .unit = {}, .lag_s = 60.0 * lag_min});
  }
  if (drive.empty()) return terms;
  std::vector<double> lags_min = {0.0};
  lags_min.insert(lags_min.end(), std::begin(kDriveLags_min), std::end(kDriveLags_min));
  for (double lag_min : lags_min) {
    for (int power : {1, 2}) terms.push_back({.input = drive, .unit = {}, .power = power, .lag_s = 60.0 * lag_min});
    terms.push_back({.input = drive, .unit = {}, .lag_s = 60.0 * lag_min, .is_running = true});
  }
  return terms;
}

/// Rows [from, to) of a record.
Record rows_of(const Record& record, std::size_t from, std::size_t to) {
  const auto part = [&](const std::vector<double>& x) {
    return std::vector<double>(x.begin() + static_cast<std::ptrdiff_t>(from), x.begin() + static_cast<std::ptrdiff_t>(to));
  };
  Record r{.source = record.source, .time_s = part(record.time_s), .channels = {}};
  for (const Channel& c : record.channels) r.channels.push_back({c.name, c.unit, part(c.values)});
  return r;
}

/// The rows in which nothing is missing.
Record complete(const Record& record) {
  Record r{.source = record.source, .time_s = {}, .channels = {}};
  for (const Channel& c : record.channels) r.channels.push_back({c.name, c.unit, {}});
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    if (std::any_of(record.channels.begin(), record.channels.end(),
                    [&](const Channel& c) { return !std::isfinite(c.values[i]); }))
      continue;
    r.time_s.push_back(record.time_s[i]);
    for (std::size_t c = 0; c < r.channels.size(); ++c) r.channels[c].values.push_back(record.channels[c].values[i]);
  }
  return r;
}

std::vector<Record> parts_of(const Record& whole) {
  const Record record = complete(whole);
  if (record.n_samples() < 2 * kParts)
    throw InputError(
        fmt::format("{} has {} rows in which no input is missing; to leave out parts of a single record {} are wanted",
                    record.source, record.n_samples(), 2 * kParts));
  std::vector<Record> parts;
  for (std::size_t p = 0; p < kParts; ++p)
    parts.push_back(rows_of(record, record.n_samples() * p / kParts, record.n_samples() * (p + 1) / kParts));
  return parts;
}

/// Divides columns of the sums, so that one penalty weighs more on them; their deviations are as much larger.
void weigh(ProductSums& sums, const std::vector<DriftModel::Term>& terms) {
  for (std::size_t j = 0; j < terms.size(); ++j) {
    if (terms[j].lag_s == 0.0 && !is_drive(terms[j].unit)) continue;
    const auto column = static_cast<Eigen::Index>(j);
    const double by = std::sqrt(kOfMemories);
    sums.deviation(column) *= by;
    for (Eigen::MatrixXd& s : sums.by_record) {
      s.row(column + 1) /= by;
      s.col(column + 1) /= by;
    }
  }
}

/// Sums of what is left out together.
std::vector<Eigen::MatrixXd> folds_of(const ProductSums& sums, std::size_t n_together) {
  std::vector<Eigen::MatrixXd> parts, folds;
  for (const Eigen::MatrixXd& part : sums.by_record) {
    if (part(0, 0) > 0.0) parts.push_back(part);
  }
  if (parts.size() < 2)
    throw InputError("of the records given only one has rows in which no input is missing; give that one alone");
  for (std::size_t first = 0; first + n_together <= parts.size(); ++first) {
    Eigen::MatrixXd fold = parts[first];
    for (std::size_t i = 1; i < n_together; ++i) fold += parts[first + i];
    folds.push_back(std::move(fold));
  }
  return folds;
}

}  // namespace

FittedFormula fit_with_memories(std::span<const Record> records, const std::vector<std::string>& sensors,
                                const std::string& drive, const std::string& ambient, const std::string& target) {
  const TermColumns columns = term_columns(records, terms_of(sensors, drive, ambient), target);
  if (columns.terms.empty())
    throw InputError(fmt::format("the regression of '{}' was given no thermometer and no drive", target));
  const bool is_single = records.size() == 1;
  ProductSums sums = product_sums(is_single ? parts_of(columns.records.front()) : columns.records, columns.names, target);
  weigh(sums, columns.terms);
  std::vector<int> all(columns.terms.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<Eigen::MatrixXd> folds = folds_of(sums, is_single ? kPartsLeftOut : 1);
  const Eigen::MatrixXd total = sums.total();
  double chosen = 0.0, least = std::numeric_limits<double>::infinity();
  for (double penalty : kPenalties) {
    double error = 0.0;
    for (const Eigen::MatrixXd& fold : folds)
      error += std::sqrt(residual_squares(fold, all, fit_columns(total - fold, all, penalty)) / fold(0, 0));
    error *= sums.deviation(sums.n_inputs()) / static_cast<double>(folds.size());
    if (error < least) {
      least = error;
      chosen = penalty;
    }
  }
  FittedFormula f{model_of(sums, all, fit_columns(total, all, chosen), columns.terms, "thermometers and memories"),
                  fmt::format("{} readings and lags, ridge penalty {:g}: RMS error {:.3g} {} on {} left out", all.size(),
                              chosen, least, sums.target_unit, is_single ? "eighths of the record" : "runs"),
                  least};
  std::erase_if(f.model.terms, [](const DriftModel::Term& t) { return t.coefficient == 0.0; });  // of what never moved
  return f;
}

}  // namespace driftwright::compensation
