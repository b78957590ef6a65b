#pragma once
// An identified network as a scenario.

#include "identification/identify.hpp"

namespace driftwright::identification {

/// Bodies of 1 MJ/K, which is a scale: heat over conductance, and time constants, are what records tell. A thermometer is a node of 1 J/K that hangs on the bodies it is a
/// mean of, and does not load them (below 0.1 %). Shares below 1e-4 are left out.
/// @param name    of the scenario
/// @param records  files beside it that hold drive and ambient as run_record() makes them; the scenario's cyclogram and ambient are those of the first, for a scenario has one ambient
/// @param head     comment lines
[[nodiscard]] std::string network_scenario(const Identified& network, const std::string& name,
                                           const std::vector<std::string>& records, const std::vector<std::string>& head);

/// A record as the scenario's verbs read it: its speed is called `speed` (0 without one), and missing values of drives and ambient hold the last one.
[[nodiscard]] Record run_record(const Record& record, const RecordRoles& roles);

}  // namespace driftwright::identification
