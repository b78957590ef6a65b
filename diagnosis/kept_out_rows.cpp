#include "diagnosis/kept_out_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

constexpr double kFitted = 2.0 / 3.0;  // of a single run
constexpr int kBlocks = 6;             // of a run, every other one kept out

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

/// Whether a claim changes any reading of a run.
std::vector<char> runs_of(const Fitter& fitter, const SearchResult& result, std::size_t claim, Twin::Workspace& workspace) {
  const Remainder rest = without_claims(result.hypothesis, {claim}, fitter.n_nuisance());
  const Prediction without = fitter.predict(rest.hypothesis, result.fit.x(rest.x), workspace);
  std::vector<char> acts;
  for (std::size_t r = 0; r < without.size(); ++r) acts.push_back(!without[r].isApprox(result.fit.prediction[r], 1e-12));
  return acts;
}

}  // namespace

bool has_time(const Claim& claim) {
  return claim.happens || std::any_of(claim.knobs.begin(), claim.knobs.end(), [](const Knob& k) { return k.is_time; });
}

Fold ahead_of(const std::vector<MeasuredRun>& runs) {
  const double from_s = kFitted * runs[0].time_s.back();
  Fold fold = fold_of(runs, [&](std::size_t, double t_s) { return t_s > from_s; });
  fold.is_ahead = true;
  return fold;
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
    std::vector<char> happened(runs.size(), 0);  // something in this run alone
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
        folds.list.back().run = out;
      }
    }
    folds.how = fmt::format("each of the {} records in turn, predicted with numbers fitted to the others{}", runs.size(),
                            std::count(happened.begin(), happened.end(), 1) > 0
                                ? "; of a record in which alone something happened, sixths, every other one kept out"
                                : "");
  }
  return folds;
}

}  // namespace driftwright::diagnosis
