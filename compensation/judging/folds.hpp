#pragma once
// What is hidden from a fit in turn, so that it shows what it is worth on what it has not seen: whole runs, whole speeds, the end of the runs, their
// beginning, the warmest of their rows and the coldest.

#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/observed_run.hpp"

namespace driftwright::compensation {

struct Fold {
  std::string kind;                       ///< "run", "block", "speed", "end", "beginning", "warm" or "cold"
  std::string name;                       ///< "run 2.csv", "speed 3000 rpm"
  std::vector<std::vector<bool>> hidden;  ///< of each run and row, whether its target is hidden
};

/// What folds are made by.
struct FoldSettings {
  std::string target;
  std::vector<std::string> thermometers;
  std::string speed;  ///< channel in rpm, or ""
};

/// Folds of several kinds, for a strategy meets more than one thing that it was not fitted on:
/// - run: each run in turn; of a single one each eighth of its rows (in_blocks()), called "block";
/// - speed: of two speeds or more that a twentieth of the rows have each, each in turn; 0 is none of them;
/// - end, beginning: the last, the first third of the rows of all runs;
/// - warm, cold: the third of all rows that is warmest, and coldest, by the first principal component of the thermometers.
///
/// Hidden are targets, never readings. The first target of a run stays, for a drift may count from it, but where the whole run is hidden. Folds that hide, or leave,
/// fewer than ten rows are no folds.
/// @param runs  each of a record of its own (joined_histories())
/// Source: leaving out groups that are alike: Roberts et al., Ecography 40 (2017) 913.
[[nodiscard]] std::vector<Fold> folds_of(std::span<const ObservedRun> runs, const FoldSettings& settings);

/// The runs as a fit may see them; without those of which nothing is left.
[[nodiscard]] std::vector<ObservedRun> without(std::span<const ObservedRun> runs, const Fold& fold,
                                               const std::string& target);

}  // namespace driftwright::compensation
