#pragma once
// Corrections planned ahead, in the paper's notation: the corrections of each operation. schedule_policy.hpp makes them from
// a predicted drift.

#include <span>
#include <string>
#include <vector>

namespace driftwright::compensation {

/// One pair (t, delta) of the notation: the correction changes by delta_um and is then held for interval_s.
struct Correction {
  double interval_s = 0.0;
  double delta_um = 0.0;  ///< 0 in an operation's first interval if nothing changes
};

/// One operation R = n-{t_1..t_n}-{delta_1..delta_n}.
struct Operation {
  double start_s = 0.0;
  double end_s = 0.0;
  std::vector<Correction> corrections;  ///< their intervals add up to end_s - start_s
};

struct Schedule {
  std::vector<Operation> operations;  ///< each starts where the one before ends
  double tolerance_um = 0.0;
  double worst_remaining_um = 0.0;  ///< largest |drift - correction| of the prediction, also between samples
  /// False if no correction keeps the tolerance from one permitted time to the next: then the nearest one is used, and
  /// worst_remaining_um shows the error.
  bool inside_band = true;
};

/// Checks the arguments of the planning functions. @param time_s        strictly increasing, at least two samples
/// @param drift_um      same length, no missing value
/// @param boundaries_s  starts of the operations and the end of the last, strictly increasing, inside time_s
/// @throws InputError   when the series or boundaries do not meet these conditions
void check_drift(std::span<const double> time_s, std::span<const double> drift_um, std::span<const double> boundaries_s);

/// Correction c [um] in force at time t [s]: 0 before the first operation; an increment applies from its
/// time on; after the end the last correction stays.
[[nodiscard]] double correction_at(const Schedule& schedule, double t_s);

/// The paper's notation, one line per operation, intervals in min (four decimals at most), increments in um:
/// "3-{18,27,15}-{0,10,10}".
[[nodiscard]] std::string to_text(const Schedule& schedule);

}  // namespace driftwright::compensation
