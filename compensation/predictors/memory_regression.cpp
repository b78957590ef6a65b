#include "compensation/predictors/memory_regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/errors.hpp"
#include "compensation/predictors/blended_formula.hpp"
#include "compensation/predictors/term_columns.hpp"
#include "compensation/sensors/blocks.hpp"
#include "compensation/sensors/principal_components.hpp"

namespace driftwright::compensation {
namespace {

// On the record fl_thermal (docs/theory/measured_strategies.md) finer and coarser lags give the same error on left-out data,
// within its scatter.
constexpr double kTemperatureLags_min[] = {20, 60, 180};
constexpr double kDriveLags_min[] = {2, 5, 10, 20, 40, 80, 160};
// The smallest penalty prevents levels outside the tests from being computed from differences of nearly equal columns.
constexpr double kPenalties[] = {1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 10.0, 100.0};

std::string mode_name(Eigen::Index k) {
  return fmt::format("mode_{}", k + 1);
}

/// Converts a formula of modes to one of thermometers: lags are linear, and a constant is unchanged by them.
DriftModel of_thermometers(const DriftModel& of_modes, const PrincipalComponents& modes, const std::string& unit) {
  DriftModel model = of_modes;
  model.terms.clear();
  for (const DriftModel::Term& t : of_modes.terms) {
    Eigen::Index k = 0;
    while (k < modes.share.cols() && t.input != mode_name(k)) ++k;
    if (k == modes.share.cols()) {
      model.terms.push_back(t);
      continue;
    }
    for (std::size_t j = 0; j < modes.inputs.size(); ++j) {
      const auto row = static_cast<Eigen::Index>(j);
      const double slope = t.coefficient * modes.share(row, k);
      if (slope == 0.0) continue;
      model.intercept -= slope * modes.mean(row);
      add_term(model, {.input = modes.inputs[j], .unit = unit, .coefficient = slope, .power = 1, .lag_s = t.lag_s});
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
/// The penalty with the smallest mean RMS error on the parts left out in turn.
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
  std::vector<Record> records(given.begin(), given.end());
  std::vector<std::string> thermometers = sensors;
  if (!ambient.empty() && std::find(sensors.begin(), sensors.end(), ambient) == sensors.end())
    thermometers.push_back(ambient);
  PrincipalComponents modes;
  std::vector<std::string> temperatures = thermometers;
  if (made_of == Columns::kModes) {
    if (n_modes < 1 || static_cast<std::size_t>(n_modes) >= thermometers.size())
      throw InputError(fmt::format("{} common modes need {} thermometers at least; there are {}", n_modes, n_modes + 1,
                                   thermometers.size()));
    modes = principal_components(records, thermometers, target, n_modes);
    temperatures.clear();
    for (Eigen::Index k = 0; k < n_modes; ++k) {
      temperatures.push_back(mode_name(k));
      for (Record& record : records) record.channels.push_back({mode_name(k), "K", modes.values(record, k)});
    }
  }
  const TermColumns columns = term_columns(
      records, terms_of(temperatures, drive, made_of != Columns::kAndDrive, longest_lag_s(records, target)), target);
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
  if (made_of == Columns::kModes) f.model = of_thermometers(f.model, modes, given.front().at(thermometers.front()).unit);
  // Columns that never changed.
  std::erase_if(f.model.terms, [](const DriftModel::Term& t) { return t.coefficient == 0.0; });
  return f;
}

}  // namespace driftwright::compensation
