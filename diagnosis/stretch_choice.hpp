#pragma once
// In which of the machine's own stretches of work something has acted: heat in every other run of the spindle, an exchange while one axis moved for the third time.
// Their times are those of the recorded drive and are not chosen; what is paid for is which of n stretches: log n for how many, log C(n, k) for which k.

#include "diagnosis/window_evidence.hpp"

namespace driftwright::diagnosis {

/// Stretches of all runs during which something of the drive was at work.
struct WorkStretches {
  Edges edges;                             ///< rows between the cells of each run: where work begins and ends
  std::vector<std::vector<char>> is_work;  ///< of each run, a cell each
  /// Of whatever is recorded of the drive in all runs: its mean in each cell of each run.
  std::vector<std::vector<std::vector<double>>> levels = {};
};

/// Those of the spindle's turning, of each axis, of cutting and of each further column that all runs have and that is no temperature: it rests up to a twentieth of its span over its least value. None of what has
/// too few stretches to choose among, or too many.
[[nodiscard]] std::vector<WorkStretches> stretches_of_work(const std::vector<MeasuredRun>& runs);

/// The choice that brings most, windows from edge to edge of these stretches' cells; neither all of them nor none.
/// @param evidence  of these edges
/// @returns  nothing where all of them bring as much, or sizes that follow how fast or how hard it worked, in any shape, do better: that is a law of the drive
[[nodiscard]] std::optional<FoundWindows> choose_stretches(const WindowEvidence& evidence, const WorkStretches& stretches);

}  // namespace driftwright::diagnosis
