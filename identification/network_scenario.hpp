#pragma once
// Writes an identified network as a scenario.

#include "identification/identify.hpp"

namespace driftwright::identification {

/// Bodies have 1 MJ/K, an arbitrary scale: records determine only heat over conductance, and time constants. A thermometer
/// is a node of 1 J/K, linked to the bodies whose mean it is; its load on them is negligible (below 0.1 %). Shares below
/// 1e-4 are left out.
/// @param name    of the scenario
/// @param records  files beside it with drive and ambient as run_record() makes them; cyclogram and ambient are those of the
///                 first, because a scenario has only one ambient
/// @param head     comment lines
[[nodiscard]] std::string network_scenario(const Identified& network, const std::string& name,
                                           const std::vector<std::string>& records, const std::vector<std::string>& head);

/// A record in the form that the scenario's verbs read: its speed is called `speed` (0 without one), and a missing value of
/// a drive or the ambient is replaced by the last one.
[[nodiscard]] Record run_record(const Record& record, const RecordRoles& roles);

}  // namespace driftwright::identification
