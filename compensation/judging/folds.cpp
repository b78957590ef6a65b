#include "compensation/judging/folds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "base/errors.hpp"
#include "base/median.hpp"
#include "base/record_channel.hpp"
#include "compensation/predictors/scored_rows.hpp"
#include "compensation/sensors/blocks.hpp"
#include "compensation/sensors/principal_components.hpp"

namespace driftwright::compensation {
namespace {

constexpr std::size_t kLeastRows = 10;
constexpr double kLeastShareOfSpeed = 0.05;
constexpr double kSpeedStep = 0.01;  // of the largest: closer speeds count as one

/// Rows of a run that belong to it and have a target.
std::vector<std::size_t> own_targets(const MachineRun& run, const std::string& target) {
  const std::vector<double>& drift = run.readings.at(target).values;
  std::vector<std::size_t> rows;
  for (std::size_t i = run.n_before; i < drift.size(); ++i) {
    if (std::isfinite(drift[i])) rows.push_back(i);
  }
  return rows;
}

/// The first principal component of the thermometers per run and row, with the sign of a temperature; NaN if one is missing.
/// Empty if none changes.
std::vector<std::vector<double>> warmth(std::span<const MachineRun> runs, const FoldSettings& s) {
  if (s.thermometers.empty()) return {};
  std::vector<Record> records;
  for (const MachineRun& run : runs) records.push_back(scored_readings(run, s.target, false));
  try {
    const PrincipalComponents common = principal_components(records, s.thermometers, s.target, 1);
    std::vector<std::vector<double>> result;
    for (const Record& record : records) result.push_back(common.values(record, 0));
    return result;
  } catch (const InputError&) {  // no row in which all thermometers have a reading
    return {};
  }
}

/// Makes the folds of some runs, one by one.
class FoldMaker {
 public:
  FoldMaker(std::span<const MachineRun> runs, const std::string& target) : runs_(runs) {
    for (const MachineRun& run : runs) own_.push_back(own_targets(run, target));
  }
  [[nodiscard]] const std::vector<std::vector<std::size_t>>& own() const { return own_; }

  /// Adds the fold of the rows for which `is_hidden` (run, index among its own targets, row) is true, unless it would be
  /// empty. The first target of a run, from which its drift counts, is hidden only if all others are.
  void add(const std::string& kind, const std::string& name,
           const std::function<bool(std::size_t run, std::size_t place, std::size_t row)>& is_hidden) {
    Fold fold{kind, name, {}};
    std::size_t n_hidden = 0, n_left = 0;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      fold.hidden.emplace_back(runs_[r].readings.n_samples(), false);
      std::size_t n = 0;
      for (std::size_t k = 0; k < own_[r].size(); ++k) {
        const bool is = is_hidden(r, k, own_[r][k]);
        fold.hidden[r][own_[r][k]] = is;
        n += is ? 1 : 0;
      }
      if (n > 0 && n < own_[r].size() && fold.hidden[r][own_[r].front()]) {
        fold.hidden[r][own_[r].front()] = false;
        --n;
      }
      n_hidden += n;
      n_left += own_[r].size() - n;
    }
    if (n_hidden >= kLeastRows && n_left >= kLeastRows) folds.push_back(std::move(fold));
  }

  std::vector<Fold> folds;

 private:
  std::span<const MachineRun> runs_;
  std::vector<std::vector<std::size_t>> own_;
};

void add_speeds(FoldMaker& make, std::span<const MachineRun> runs, const std::string& speed) {
  double largest = 0.0;
  const auto each = [&](const auto& visit) {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const Channel* channel = runs[r].readings.find(speed);
      for (std::size_t row : make.own()[r]) {
        if (channel && std::isfinite(channel->values[row])) visit(std::abs(channel->values[row]));
      }
    }
  };
  each([&](double rpm) { largest = std::max(largest, rpm); });
  if (!(largest > 0.0)) return;
  const auto level = [&](double rpm) { return std::lround(std::abs(rpm) / (kSpeedStep * largest)); };
  std::map<long, std::size_t> n_of;
  std::size_t n = 0;
  each([&](double rpm) {
    ++n_of[level(rpm)];
    ++n;
  });
  n_of.erase(0);
  std::erase_if(n_of,
                [&](const auto& e) { return static_cast<double>(e.second) < kLeastShareOfSpeed * static_cast<double>(n); });
  if (n_of.size() < 2) return;
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(kSpeedStep * largest))));
  for (const auto& [at, count] : n_of) {
    make.add("speed", fmt::format("speed {:.{}f} rpm", static_cast<double>(at) * kSpeedStep * largest, decimals),
             [&, at = at](std::size_t r, std::size_t, std::size_t row) {
               const Channel* channel = runs[r].readings.find(speed);
               return channel && std::isfinite(channel->values[row]) && level(channel->values[row]) == at;
             });
  }
}

}  // namespace

std::vector<Fold> folds_of(std::span<const MachineRun> runs, const FoldSettings& s) {
  FoldMaker make(runs, s.target);
  const auto& own = make.own();
  if (runs.size() == 1) {
    for (std::size_t b = 0; b < kBlocks; ++b) {
      make.add("block", fmt::format("eighth {}", b + 1), [&](std::size_t r, std::size_t k, std::size_t) {
        return k >= own[r].size() * b / kBlocks && k < own[r].size() * (b + 1) / kBlocks;
      });
    }
  } else {
    for (std::size_t left_out = 0; left_out < runs.size(); ++left_out)
      make.add("run", runs[left_out].readings.source,
               [&](std::size_t r, std::size_t, std::size_t) { return r == left_out; });
  }
  if (!s.speed.empty()) add_speeds(make, runs, s.speed);
  make.add("end", "last third of each run",
           [&](std::size_t r, std::size_t k, std::size_t) { return 3 * k >= 2 * own[r].size(); });
  make.add("beginning", "first third of each run",
           [&](std::size_t r, std::size_t k, std::size_t) { return 3 * k < own[r].size(); });
  const std::vector<std::vector<double>> warm = warmth(runs, s);
  std::vector<double> all;
  for (std::size_t r = 0; r < warm.size(); ++r) {
    for (std::size_t row : own[r]) {
      if (std::isfinite(warm[r][row])) all.push_back(warm[r][row]);
    }
  }
  if (all.size() < 3) return std::move(make.folds);
  const double low = quantile(all, 1.0 / 3.0), high = quantile(all, 2.0 / 3.0);
  make.add("warm", "warmest third", [&](std::size_t r, std::size_t, std::size_t row) { return warm[r][row] > high; });
  make.add("cold", "coldest third", [&](std::size_t r, std::size_t, std::size_t row) { return warm[r][row] < low; });
  return std::move(make.folds);
}

std::vector<MachineRun> without(std::span<const MachineRun> runs, const Fold& fold, const std::string& target) {
  std::vector<MachineRun> rest;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    MachineRun run = runs[r];
    std::vector<double>& drift = changeable_channel(run.readings, target).values;
    for (std::size_t i = 0; i < drift.size(); ++i) {
      if (fold.hidden[r][i]) drift[i] = std::numeric_limits<double>::quiet_NaN();
    }
    if (!own_targets(run, target).empty()) rest.push_back(std::move(run));
  }
  return rest;
}

FoldedRuns folded(std::span<const MachineRun> training, const FoldSettings& s) {
  FoldedRuns f{.runs = joined_histories(training, s.target), .folds = {}, .rest = {}, .measured_um = {}};
  f.folds = folds_of(f.runs, s);
  std::vector<std::vector<double>> targets;
  for (const MachineRun& run : f.runs) targets.push_back(scored_readings(run, s.target, s.from_start).at(s.target).values);
  for (const Fold& fold : f.folds) {
    f.rest.push_back(without(f.runs, fold, s.target));
    std::vector<double>& measured_um = f.measured_um.emplace_back();
    for (std::size_t r = 0; r < f.runs.size(); ++r) {
      for (std::size_t i = 0; i < targets[r].size(); ++i) {
        if (fold.hidden[r][i]) measured_um.push_back(targets[r][i]);
      }
    }
  }
  return f;
}

std::vector<std::size_t> folds_for_failures(const FoldedRuns& folds) {
  std::vector<std::size_t> list;
  for (std::size_t k = 0; k < folds.folds.size(); ++k) {
    if (folds.folds[k].kind == (folds.runs.size() > 1 ? "run" : "end")) list.push_back(k);
  }
  return list;
}

std::vector<double> FoldedRuns::predicted_um(const Predictor& predictor, std::size_t fold) const {
  std::vector<double> result;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::vector<bool>& hidden = folds[fold].hidden[r];
    if (std::find(hidden.begin(), hidden.end(), true) == hidden.end()) continue;
    const std::vector<double> predicted = live(predictor, runs[r]);
    for (std::size_t i = 0; i < predicted.size(); ++i) {
      if (hidden[i]) result.push_back(std::isfinite(predicted[i]) ? predicted[i] : 0.0);
    }
  }
  return result;
}

}  // namespace driftwright::compensation
