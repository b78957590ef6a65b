#pragma once
// Fits what a scenario does not explain in measured records, beside its physics, as effects `learned`.

#include "diagnosis/extended_scenario.hpp"
#include "identification/identify.hpp"
#include "studies/written_scenario.hpp"

namespace driftwright::studies {

/// Measured runs and the readings of a state of their twin at the same rows, as records for identification.
struct BesideRecords {
  identification::RecordRoles roles;  ///< channels that all runs have
  std::vector<Record> measured, simulated;
};
/// @param read  for each run, from Twin::read()
/// @throws InputError  if nothing that drives the machine changes, or the runs have no channel in common
[[nodiscard]] BesideRecords beside(const std::vector<diagnosis::MeasuredRun>& runs, const std::vector<Eigen::MatrixXd>& read,
                                   double reference_K);

/// Root mean square of a channel's error over all rows; for displacements and rises from the first reading of each
/// record.
[[nodiscard]] double missed(const BesideRecords& beside, const std::string& channel);

/// A scenario beside records, and what was learned there.
struct LearnedBeside {
  BesideRecords records;
  identification::Identified network;
};
/// What a state of the twin misses of the measured runs, learned beside it; for each channel also the noise of its readings
/// and what a plain regression on drive and ambient misses of the same kept-out rows (diagnosis/plain_regression.hpp). A
/// displacement of a record without any fitted row counts from its first reading.
/// @throws InputError  as beside(); SolveError  as read_of()
[[nodiscard]] LearnedBeside learn_beside(const MeasuredTwin& m, const diagnosis::TwinState& state, const Listener& listener);

/// What could be learned beside the file that a diagnosis wrote: root mean squares on rows that were kept out of it, in K,
/// um or urad.
struct RemainderGain {
  std::string name, unit;
  double rmse_file = 0.0, rmse_with_remainder = 0.0, rmse_regression = 0.0, noise = 0.0;
  bool is_learned = false;  ///< else the scenario stays as it is, and both errors are equal
};
struct Remainder {
  std::vector<RemainderGain> channels;
  std::string why_not;  ///< a sentence; "" if it was learned
};
/// By learn_beside(). Not after a request to end, nor with too few readings.
[[nodiscard]] Remainder remainder_of(const MeasuredTwin& m, const diagnosis::Diagnosis& d, const WrittenScenario& written,
                                     const Listener& listener);

/// One sigma of what an extended channel still misses, without the noise of its readings: the normal number whose 95 %
/// interval is that of a further fold. The error of a fold counts as one normal value about zero, so the interval is
/// Student's of the mean square of n folds: 1.14 times as wide for ten folds, 1.31 times for five.
[[nodiscard]] double remaining_sd(const identification::IdentifiedChannel& channel);

/// The extension of a scenario as effects: one `learned` for each extended channel, the first with what still `misses`.
[[nodiscard]] std::vector<effects::Effect> learned_effects(const identification::Identified& extension);
/// The same effects, each as one change of a twin's state.
[[nodiscard]] std::vector<diagnosis::StatedChange> stated_extension(const identification::Identified& extension);

}  // namespace driftwright::studies
