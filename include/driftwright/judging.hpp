#pragma once
// Correction strategies judged on records that they were not fitted on.

#include <string>
#include <vector>

#include "driftwright/api.hpp"
#include "driftwright/listener.hpp"

namespace driftwright {

/// One strategy on one record, or with one sensor failed.
struct JudgedCase {
  std::string record;
  std::string failed;                                ///< "t05 stuck"; empty: all sensors intact
  double rms_before_um = 0.0, peak_before_um = 0.0;  ///< of the drift without correction
  double rms_left_um = 0.0, peak_left_um = 0.0;      ///< of what remains after the correction
};

/// One strategy with its verdict and all cases that it was judged on.
struct JudgedStrategy {
  std::string name;
  std::string verdict;  ///< safe, within limits, unsafe
  std::string why;      ///< one sentence
  bool is_baseline = false;
  std::vector<JudgedCase> cases;
};

/// Does what `driftwright validate --train ... --test ...` does: judges every strategy that the scenario's `study` allows.
/// @param train, test  record CSVs, or parts of them such as run.csv:0h..20h
/// @throws InputError, SolveError
[[nodiscard]] DRIFTWRIGHT_API std::vector<JudgedStrategy> judge(const std::string& scenario_file,
                                                                const std::vector<std::string>& train,
                                                                const std::vector<std::string>& test,
                                                                const Listener& listener = {});

}  // namespace driftwright
