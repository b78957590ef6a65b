#include "diagnosis/kept_out_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace driftwright::diagnosis {
namespace {

constexpr double kFitted = 2.0 / 3.0;  // share of a single run that numbers are fitted to
constexpr int kThirds = 3;             // parts of a single run
constexpr int kBlocks = 6;             // of a run; every other one is kept out
// Share of the greatest speed: mean difference of speeds with the same rank, up to which two runs have the same cycle.
// Days of one lathe with the same cycle differ by 0.00 to 0.11 (one of them stopped for five hours of twenty-four), days
// with two cycles by 0.30 to 0.60, and runs with random speeds by 0.08 to 0.28.
constexpr double kOneCycle = 0.2;
constexpr int kShares = 200;  // parts of a run's time; speeds are compared at their middles

Fold fold_of(const std::vector<MeasuredRun>& runs, const std::function<bool(std::size_t run, double t_s)>& is_kept_out) {
  Fold fold{runs, runs};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (std::size_t i = 0; i < runs[r].time_s.size(); ++i) {
      std::vector<MeasuredRun>& without = is_kept_out(r, runs[r].time_s[i]) ? fold.fitted : fold.kept_out;
      for (MeasuredChannel& c : without[r].channels) c.value[static_cast<Eigen::Index>(i)] = std::nan("");
    }
  }
  return fold;
}

/// Marks the runs in which a claim changes a reading.
std::vector<char> runs_of(const Fitter& fitter, const SearchResult& result, std::size_t claim, Twin::Workspace& workspace) {
  const Remainder rest = without_claims(result.hypothesis, {claim}, fitter.n_nuisance());
  const Prediction without = fitter.predict(rest.hypothesis, result.fit.x(rest.x), workspace);
  std::vector<char> acts;
  for (std::size_t r = 0; r < without.size(); ++r) acts.push_back(!without[r].isApprox(result.fit.prediction[r], 1e-12));
  return acts;
}

/// Sorted speeds, at the middles of equal parts of a run's time.
Eigen::ArrayXd speeds_by_rank_rpm(const MeasuredRun& run) {
  std::map<double, double> time_s;  // by speed
  double total_s = 0.0;
  for (const auto& section : run.cyclogram.sections) {
    time_s[section.drive.speed_rpm] += section.duration_s;
    total_s += section.duration_s;
  }
  Eigen::ArrayXd rpm = Eigen::ArrayXd::Zero(kShares);
  int i = 0;
  double until_s = 0.0;
  for (const auto& [speed_rpm, held_s] : time_s) {
    until_s += held_s;
    for (; i < kShares && (i + 0.5) / kShares * total_s <= until_s; ++i) rpm[i] = speed_rpm;
  }
  for (; i < kShares && !time_s.empty(); ++i) rpm[i] = time_s.rbegin()->first;
  return rpm;
}

}  // namespace

bool has_time(const Claim& claim) {
  return claim.happens || std::any_of(claim.knobs.begin(), claim.knobs.end(), [](const Knob& k) { return k.is_time; });
}

Fold ahead_of(const std::vector<MeasuredRun>& runs) {
  const double from_s = kFitted * runs[0].time_s.back();
  return fold_of(runs, [&](std::size_t, double t_s) { return t_s > from_s; });
}

Folds folds_of(const Fitter& fitter, const SearchResult& result, Twin::Workspace& workspace) {
  const std::vector<MeasuredRun>& runs = fitter.runs();
  Folds folds;
  const auto by_blocks = [&](std::size_t run) {
    const double block_s = runs[run].time_s.back() / kBlocks;
    for (int odd : {0, 1})
      folds.list.push_back(
          fold_of(runs, [&](std::size_t r, double t_s) { return r == run && static_cast<int>(t_s / block_s) % 2 == odd; }));
  };
  if (runs.size() == 1) {
    folds.list.push_back(ahead_of(runs));
    folds.how = kAheadWords;
    if (std::any_of(result.hypothesis.begin(), result.hypothesis.end(), has_time)) {
      by_blocks(0);
      folds.how += "; and sixths of it, every other one kept out, for something happened in it";
    }
  } else {
    std::vector<char> happened(runs.size(), 0);  // marks runs with an event of their own
    for (std::size_t c = 0; c < result.hypothesis.size(); ++c) {
      const std::vector<char> acts = runs_of(fitter, result, c, workspace);
      if (std::count(acts.begin(), acts.end(), 1) == 1)
        happened[static_cast<std::size_t>(std::find(acts.begin(), acts.end(), 1) - acts.begin())] = 1;
    }
    for (std::size_t out = 0; out < runs.size(); ++out) {
      if (happened[out]) {
        by_blocks(out);
      } else {
        folds.list.push_back(fold_of(runs, [&](std::size_t r, double) { return r == out; }));
        folds.list.back().whole = {out};
      }
    }
    folds.how = fmt::format("each of the {} records in turn, predicted with numbers fitted to the others{}", runs.size(),
                            std::count(happened.begin(), happened.end(), 1) > 0
                                ? "; of a record in which alone something happened, sixths, every other one kept out"
                                : "");
  }
  return folds;
}

Folds folds_of_numbers(const std::vector<MeasuredRun>& runs) {
  Folds folds;
  for (int third = 0; third < kThirds; ++third)
    folds.list.push_back(fold_of(runs, [&](std::size_t r, double t_s) {
      return std::min(static_cast<int>(kThirds * t_s / runs[r].time_s.back()), kThirds - 1) == third;
    }));
  if (runs.size() == 1) {
    folds.how = "each third of the only record in turn, predicted with numbers fitted to the other two";
    return folds;
  }
  for (std::size_t out = 0; out < runs.size(); ++out) {
    folds.list.push_back(fold_of(runs, [&](std::size_t r, double) { return r == out; }));
    folds.list.back().whole = {out};
  }
  folds.how =
      fmt::format("each third of all records in turn, and each of the {} records, predicted with numbers fitted to the rest",
                  runs.size());
  return folds;
}

std::vector<std::vector<std::size_t>> duty_cycles(const std::vector<MeasuredRun>& runs) {
  std::vector<std::vector<std::size_t>> cycles;
  std::vector<Eigen::ArrayXd> rpm;
  for (const MeasuredRun& run : runs) rpm.push_back(speeds_by_rank_rpm(run));
  const auto is_alike = [&](std::size_t a, std::size_t b) {
    return (rpm[a] - rpm[b]).abs().mean() <= kOneCycle * std::max(rpm[a].maxCoeff(), rpm[b].maxCoeff());
  };
  for (std::size_t r = 0; r < runs.size(); ++r) {
    std::vector<std::size_t> joined;  // all cycles that resemble the run are merged
    std::erase_if(cycles, [&](const std::vector<std::size_t>& cycle) {
      if (std::none_of(cycle.begin(), cycle.end(), [&](std::size_t other) { return is_alike(r, other); })) return false;
      joined.insert(joined.end(), cycle.begin(), cycle.end());
      return true;
    });
    joined.push_back(r);
    std::sort(joined.begin(), joined.end());
    cycles.push_back(joined);
  }
  std::sort(cycles.begin(), cycles.end());
  return cycles;
}

std::vector<Fold> folds_of_cycles(const std::vector<MeasuredRun>& runs) {
  const std::vector<std::vector<std::size_t>> cycles = duty_cycles(runs);
  if (cycles.size() == 1 || cycles.size() == runs.size()) return {};
  std::vector<Fold> folds;
  for (const std::vector<std::size_t>& cycle : cycles) {
    folds.push_back(
        fold_of(runs, [&](std::size_t r, double) { return std::find(cycle.begin(), cycle.end(), r) != cycle.end(); }));
    folds.back().whole = cycle;
  }
  return folds;
}

}  // namespace driftwright::diagnosis
