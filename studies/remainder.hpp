#pragma once
// What a scenario misses of measured records, learned beside its physics and written as effects `learned`.

#include "diagnosis/extended_scenario.hpp"
#include "identification/identify.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::studies {

/// Measured runs and what a state of their twin says of the same rows, as identification has records.
struct BesideRecords {
  identification::RecordRoles roles;  ///< channels that all runs have
  std::vector<Record> measured, simulated;
};
/// @param read  of each run, as Twin::read() gives them
/// @throws InputError  where nothing that drives the machine changes, or runs have no channel in common
[[nodiscard]] BesideRecords beside(const std::vector<diagnosis::MeasuredRun>& runs, const std::vector<Eigen::MatrixXd>& read,
                                   double reference_K);

/// Root mean square of what a channel is missed by over all rows; of displacements and rises from the first reading of each record.
[[nodiscard]] double missed(const BesideRecords& beside, const std::string& channel);

/// The extension of a scenario as effects: `learned` of each channel that is extended.
[[nodiscard]] std::vector<effects::Effect> learned_effects(const identification::Identified& extension);
/// The same as one change of a twin's effects each.
[[nodiscard]] std::vector<diagnosis::StatedChange> stated_extension(const identification::Identified& extension);

}  // namespace driftwright::studies
