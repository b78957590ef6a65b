#pragma once
// Corrections planned ahead: the paper's notation, which operation has which. schedule_policy.hpp makes them of a predicted drift.

#include <span>
#include <string>
#include <vector>

namespace driftwright::compensation {

/// One pair (t, delta) of the notation: the correction changes by delta_um and is then held for interval_s.
struct Correction {
  double interval_s = 0.0;
  double delta_um = 0.0;  ///< 0 in an operation's first interval where nothing changes
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
  double worst_remaining_um = 0.0;  ///< largest |drift - correction| of the prediction, between samples as well
  /// False where no correction keeps the tolerance from one permitted time to the next: then the nearest one was taken, and
  /// worst_remaining_um says how far it is off.
  bool inside_band = true;
};

/// @param time_s        strictly increasing, two samples at least
/// @param drift_um      same length, no missing value
/// @param boundaries_s  starts of the operations and the end of the last, strictly increasing, inside time_s
/// @throws InputError   when the series or boundaries are not as said
void check_drift(std::span<const double> time_s, std::span<const double> drift_um, std::span<const double> boundaries_s);

/// Correction c [um] that holds at time t [s]: 0 before the first operation; an increment counts from its own
/// time on; after the end the last correction stays.
[[nodiscard]] double correction_at(const Schedule& schedule, double t_s);

/// The paper's notation, one line per operation, intervals in min (four decimals at most), increments in um:
/// "3-{18,27,15}-{0,10,10}".
[[nodiscard]] std::string to_text(const Schedule& schedule);

}  // namespace driftwright::compensation
