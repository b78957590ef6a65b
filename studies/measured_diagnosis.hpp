#pragma once
// What `diagnose` and `calibrate` compute from a measured twin: the diagnosis, and the scenario with its findings.

#include <filesystem>

#include "studies/written_scenario.hpp"

namespace driftwright::studies {

struct DiagnosisRequest {
  std::vector<std::string> without = {};         ///< keys of effects that are not searched for
  bool causes_only = false;                      ///< leave the scenario's own numbers in the written scenario as they are
  std::filesystem::path file = "extended.yaml";  ///< path that the scenario will be written to, as in written_scenario()
};

struct MeasuredDiagnosis {
  /// If the written scenario can be read back, with its prediction of all rows: Diagnosis::extended, and for each channel
  /// ChannelGain::rmse_all_before and rmse_written.
  diagnosis::Diagnosis found;
  WrittenScenario written;
};

/// Searches for causes and writes what was found into the scenario. After a request to end it returns what is known so far,
/// with Diagnosis::ended_at.
/// @throws InputError  for a key in `without` that no candidate has, and as written_scenario()
/// @throws SolveError  if the written scenario has no solution
[[nodiscard]] MeasuredDiagnosis diagnose(const MeasuredTwin& m, const DiagnosisRequest& request, const Listener& listener);

/// Fits the scenario's own numbers and writes them into the scenario; no cause is searched for.
/// @param file  as in written_scenario() @throws InputError, SolveError  as diagnose()
[[nodiscard]] MeasuredDiagnosis calibrate(const MeasuredTwin& m, const std::filesystem::path& file,
                                          const Listener& listener);

}  // namespace driftwright::studies
