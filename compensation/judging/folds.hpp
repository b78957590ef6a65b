#pragma once
// What is hidden from a fit in turn, so that it shows what it is worth on what it has not seen: whole runs, whole speeds, the end of the runs, their
// beginning, the warmest of their rows and the coldest.

#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

struct Fold {
  std::string kind;                       ///< "run", "block", "speed", "end", "beginning", "warm" or "cold"
  std::string name;                       ///< "run 2.csv", "speed 3000 rpm"
  std::vector<std::vector<bool>> hidden;  ///< of each run and row, whether its target is hidden
};

/// What folds are made by.
struct FoldSettings {
  std::string target;
  bool from_start = false;  ///< drift and temperatures count from the first row of each run
  std::vector<std::string> thermometers;
  std::string speed;  ///< channel in rpm, or ""
};

/// Folds of several kinds, for a strategy meets more than one thing that it was not fitted on:
/// - run: each run in turn; of a single one each eighth of its rows (in_blocks()), called "block";
/// - speed: each speed in turn that a twentieth of the rows or more have, where there are two such speeds; a spindle at rest is no speed;
/// - end, beginning: the last, the first third of the rows of each run, of all runs at once;
/// - warm, cold: the third of all rows that is warmest, and coldest, by the first principal component of the thermometers.
///
/// Only targets are hidden, never readings. The first target of a run stays, because its drift may count from it, except where the whole run is hidden. A fold hides ten rows at
/// least, and leaves ten.
/// @param runs  each of a record of its own (joined_histories())
/// Source: leaving out groups that are alike: Roberts et al., Ecography 40 (2017) 913.
[[nodiscard]] std::vector<Fold> folds_of(std::span<const ObservedRun> runs, const FoldSettings& settings);

/// The runs as a fit may see them; without those of which nothing is left.
[[nodiscard]] std::vector<ObservedRun> without(std::span<const ObservedRun> runs, const Fold& fold,
                                               const std::string& target);

/// Training runs with what is left out of them in turn.
struct FoldedRuns {
  std::vector<ObservedRun> runs;  ///< one a history
  std::vector<Fold> folds;
  std::vector<std::vector<ObservedRun>> rest;    ///< of each fold: what is fitted to
  std::vector<std::vector<double>> measured_um;  ///< of each fold: the hidden targets, in the order of runs and rows

  /// What a predictor says of the hidden rows of a fold, in their order; 0 for what it says nothing of.
  [[nodiscard]] std::vector<double> predicted_um(const Predictor& predictor, std::size_t fold) const;
};
[[nodiscard]] FoldedRuns folded(std::span<const ObservedRun> training, const FoldSettings& settings);

}  // namespace driftwright::compensation
