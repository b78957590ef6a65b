#pragma once
// Folds: parts of the training runs that are hidden from a fit in turn, to test it on rows it has not seen: whole runs,
// whole speeds, the end and the beginning of runs, the warmest and the coldest rows.

#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

/// One such part.
struct Fold {
  std::string kind;                       ///< "run", "block", "speed", "end", "beginning", "warm" or "cold"
  std::string name;                       ///< "run 2.csv", "speed 3000 rpm"
  std::vector<std::vector<bool>> hidden;  ///< of each run and row: true if its target is hidden
};

/// The data from which folds are made.
struct FoldSettings {
  std::string target;
  bool from_start = false;  ///< drift and temperatures count from the first row of each run
  std::vector<std::string> thermometers;
  std::string speed;  ///< channel in rpm, or ""
};

/// Folds of several kinds, because a strategy will meet several kinds of new conditions:
/// - run: each run in turn; of a single run each eighth of its rows (in_blocks()), called "block";
/// - speed: each speed in turn that at least a twentieth of the rows have, if there are two such speeds; rest is not a
///   speed;
/// - end, beginning: the last and the first third of the rows of each run, of all runs at once;
/// - warm, cold: the warmest and the coldest third of all rows, by the first principal component of the thermometers.
///
/// Only targets are hidden, never readings. The first target of a run is kept, because its drift may count from it, unless
/// the whole run is hidden. A fold hides at least ten rows, and leaves at least ten.
/// @param runs  each from a separate record (joined_histories())
/// Source: leaving out groups of similar data: Roberts et al., Ecography 40 (2017) 913.
[[nodiscard]] std::vector<Fold> folds_of(std::span<const MachineRun> runs, const FoldSettings& settings);

/// The runs without the targets that a fold hides; runs without any target left are dropped.
[[nodiscard]] std::vector<MachineRun> without(std::span<const MachineRun> runs, const Fold& fold, const std::string& target);

/// Training runs with all their folds.
struct FoldedRuns {
  std::vector<MachineRun> runs;  ///< one per history
  std::vector<Fold> folds;
  std::vector<std::vector<MachineRun>> rest;     ///< of each fold: the runs to fit to
  std::vector<std::vector<double>> measured_um;  ///< of each fold: the hidden targets, in the order of runs and rows

  /// A predictor's values for the hidden rows of a fold, in order; 0 where it has none.
  [[nodiscard]] std::vector<double> predicted_um(const Predictor& predictor, std::size_t fold) const;
};
[[nodiscard]] FoldedRuns folded(std::span<const MachineRun> training, const FoldSettings& settings);

/// The folds on which failed sensors are tried: each run as a whole, or the last third of a single run. Each failure then
/// takes one pass over the rows.
[[nodiscard]] std::vector<std::size_t> folds_for_failures(const FoldedRuns& folds);

}  // namespace driftwright::compensation
