#include "compensation/predictors/memory_regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/dense.hpp"
#include "base/errors.hpp"
#include "compensation/predictors/term_columns.hpp"
#include "compensation/sensors/blocks.hpp"

namespace driftwright::compensation {
namespace {

// On the record fl_thermal (docs/measured.md) finer and coarser lags leave the same on data left out, within its scatter.
constexpr double kTemperatureLags_min[] = {20, 60, 180};
constexpr double kDriveLags_min[] = {2, 5, 10, 20, 40, 80, 160};
// The least keeps levels that were never tried from being made up out of differences of columns that are nearly alike.
constexpr double kPenalties[] = {1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 10.0, 100.0};

/// Thermometers and modes: what the columns are made of.
struct Readings {
  std::vector<std::string> names;
  std::vector<Record> records;  ///< with a channel of each name, the drive and the target
  Eigen::MatrixXd share;        ///< of kModes: names x modes, 1 / K; else empty
  Eigen::VectorXd mean;         ///< of the names [K]
};

std::string mode_name(Eigen::Index k) {
  return fmt::format("mode_{}", k + 1);
}

/// Principal components of thermometers in the rows that have the target, as further channels of the records.
Readings with_modes(Readings r, const std::string& target, int n_modes) {
  const auto n = static_cast<Eigen::Index>(r.names.size());
  if (n_modes < 1 || n_modes >= n)
    throw InputError(fmt::format("{} common modes need {} thermometers at least; there are {}", n_modes, n_modes + 1, n));
  const ProductSums sums = product_sums(r.records, r.names, target);
  const Eigen::MatrixXd total = sums.total();
  const dense::SymmetricEigen eigen(Eigen::MatrixXd(total.block(1, 1, n, n)));
  r.share = eigen.eigenvectors().rightCols(n_modes).rowwise().reverse();
  r.mean = sums.mean.head(n).transpose();
  for (Eigen::Index j = 0; j < n; ++j) {
    if (sums.is_constant[static_cast<std::size_t>(j)])
      r.share.row(j).setZero();
    else
      r.share.row(j) /= sums.deviation(j);
  }
  for (Record& record : r.records) {
    for (Eigen::Index k = 0; k < n_modes; ++k) {
      Channel mode{.name = mode_name(k), .unit = "K", .values = std::vector<double>(record.n_samples(), 0.0)};
      for (Eigen::Index j = 0; j < n; ++j) {
        if (r.share(j, k) == 0.0) continue;
        const std::vector<double>& read = record.at(r.names[static_cast<std::size_t>(j)]).values;
        for (std::size_t i = 0; i < read.size(); ++i) mode.values[i] += r.share(j, k) * (read[i] - r.mean(j));
      }
      record.channels.push_back(std::move(mode));
    }
  }
  return r;
}

/// A formula of modes as one of thermometers: lags are linear, and a constant goes through them as it is.
DriftModel of_thermometers(const DriftModel& of_modes, const Readings& r, const std::string& unit) {
  DriftModel model = of_modes;
  model.terms.clear();
  for (const DriftModel::Term& t : of_modes.terms) {
    Eigen::Index k = 0;
    while (k < r.share.cols() && t.input != mode_name(k)) ++k;
    if (k == r.share.cols()) {
      model.terms.push_back(t);
      continue;
    }
    for (std::size_t j = 0; j < r.names.size(); ++j) {
      const auto row = static_cast<Eigen::Index>(j);
      const double slope = t.coefficient * r.share(row, k);
      if (slope == 0.0) continue;
      model.intercept -= slope * r.mean(row);
      const auto same = std::find_if(model.terms.begin(), model.terms.end(), [&](const DriftModel::Term& known) {
        return known.input == r.names[j] && known.lag_s == t.lag_s;
      });
      if (same != model.terms.end())
        same->coefficient += slope;
      else
        model.terms.push_back({.input = r.names[j], .unit = unit, .coefficient = slope, .power = 1, .lag_s = t.lag_s});
    }
  }
  return model;
}

std::vector<DriftModel::Term> terms_of(const std::vector<std::string>& temperatures, const std::string& drive,
                                       bool remembers_temperatures, double longest_s) {
  std::vector<DriftModel::Term> terms;
  for (const std::string& t : temperatures) {
    terms.push_back({.input = t, .unit = {}});
    for (double lag_min : kTemperatureLags_min) {
      if (remembers_temperatures && 60.0 * lag_min <= longest_s)
        terms.push_back({.input = t, .unit = {}, .lag_s = 60.0 * lag_min});
    }
  }
  if (drive.empty()) return terms;
  std::vector<double> lags_s = {0.0};
  for (double lag_min : kDriveLags_min) {
    if (60.0 * lag_min <= longest_s) lags_s.push_back(60.0 * lag_min);
  }
  for (double lag_s : lags_s) {
    for (int power : {1, 2}) terms.push_back({.input = drive, .unit = {}, .power = power, .lag_s = lag_s});
    terms.push_back({.input = drive, .unit = {}, .lag_s = lag_s, .is_running = true});
  }
  return terms;
}

struct Penalised {
  ScaledFit fit;
  double penalty = 0.0, error = std::numeric_limits<double>::infinity();  // error in the target's unit
};
/// The penalty with the smallest mean RMS error of what is left out in turn.
Penalised penalised(const ProductSums& sums, std::span<const int> columns) {
  std::vector<Eigen::MatrixXd> folds;
  for (const Eigen::MatrixXd& part : sums.by_record) {
    if (part(0, 0) > 0.0) folds.push_back(part);
  }
  if (folds.size() < 2)
    throw InputError("of the records given only one has rows in which no input is missing; give that one alone");
  const Eigen::MatrixXd total = sums.total();
  Penalised best;
  for (double penalty : kPenalties) {
    double error = 0.0;
    for (const Eigen::MatrixXd& fold : folds)
      error += std::sqrt(residual_squares(fold, columns, fit_columns(total - fold, columns, penalty)) / fold(0, 0));
    error *= sums.deviation(sums.n_inputs()) / static_cast<double>(folds.size());
    if (error < best.error) best = {fit_columns(total, columns, penalty), penalty, error};
  }
  return best;
}

}  // namespace

FittedFormula fit_with_memories(std::span<const Record> given, const std::vector<std::string>& sensors,
                                const std::string& drive, const std::string& ambient, const std::string& target,
                                Columns made_of, int n_modes) {
  if (made_of == Columns::kAndDrive && drive.empty())
    throw InputError("nothing says what drove the machine: the records have no speed that changes");
  Readings r{.names = sensors, .records = {given.begin(), given.end()}, .share = {}, .mean = {}};
  if (!ambient.empty() && std::find(sensors.begin(), sensors.end(), ambient) == sensors.end()) r.names.push_back(ambient);
  const double longest_s = longest_lag_s(r.records, target);
  std::vector<std::string> temperatures = r.names;
  if (made_of == Columns::kModes) {
    r = with_modes(std::move(r), target, n_modes);
    temperatures.clear();
    for (Eigen::Index k = 0; k < n_modes; ++k) temperatures.push_back(mode_name(k));
  }
  const TermColumns columns =
      term_columns(r.records, terms_of(temperatures, drive, made_of != Columns::kAndDrive, longest_s), target);
  if (columns.terms.empty())
    throw InputError(fmt::format("the regression of '{}' was given no thermometer and no drive", target));
  const bool is_single = columns.records.size() == 1;
  const std::vector<Record> parts = in_blocks(columns.records, target);
  if (parts.size() < 2)
    throw InputError(
        fmt::format("{} has fewer than {} values of '{}'; so many are needed to leave out parts of a single record",
                    given.front().source, 2 * kBlocks, target));
  const ProductSums sums = product_sums(parts, columns.names, target);
  std::vector<int> all(columns.terms.size());
  std::iota(all.begin(), all.end(), 0);
  const Penalised best = penalised(sums, all);
  const char* kind = made_of == Columns::kModes      ? "common modes and memories"
                     : made_of == Columns::kAndDrive ? "thermometers and drive"
                                                     : "thermometers and memories";
  FittedFormula f{model_of(sums, all, best.fit, columns.terms, kind),
                  fmt::format("{} readings and lags, ridge penalty {:g}: RMS error {:.3g} {} on {} left out", all.size(),
                              best.penalty, best.error, sums.target_unit, is_single ? "eighths of the record" : "runs"),
                  best.error};
  if (made_of == Columns::kModes) f.model = of_thermometers(f.model, r, given.front().at(r.names.front()).unit);
  std::erase_if(f.model.terms, [](const DriftModel::Term& t) { return t.coefficient == 0.0; });  // of what never moved
  return f;
}

}  // namespace driftwright::compensation
