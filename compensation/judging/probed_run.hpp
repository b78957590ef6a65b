#pragma once
// What a judged correction leaves of a run in which the axis is probed again and again: by one predictor, or by several
// with weights that move with their losses at probings; with a good probe, and with one that has failed.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compensation/predictors/residual_process.hpp"
#include "compensation/predictors/score.hpp"

namespace driftwright::compensation {

/// What the correction of a predictor leaves per row [um]; NaN where the drift is unknown. The loan lasts for the call.
struct ProbedMember {
  probe_process process;  ///< of its residual; without lag
  std::span<const double> left_um = {};
};

enum class ProbeFault {
  kNone,
  kStuck,   ///< it reads on the corrected axis what it read last
  kBiased,  ///< it reads a constant error more: a wrong ball radius, a chip that stays
};

struct RunProbing {
  double every_s = 3600.0;  ///< > 0
  double noise_um = 1.0;
  std::uint64_t seed = 0;  ///< of the noise
  ProbeFault fault = ProbeFault::kNone;
  double fails_at_s = 0.0;
  double error_um = 0.0;  ///< of a biased probe
  bool keeps_rows = false;
};

struct ProbedRun {
  Score left;  ///< of the axis, which is corrected by predictors and probings
  int n_probings = 0, n_refused = 0;
  /// Number of the probing after the fault that was refused or taken as a jump, from one; none: no one notices it.
  std::optional<int> noticed_at = {};
  std::vector<double> left_um = {};  ///< per row, if RunProbing asks for it
};

/// Probings at the first row after each interval. Each counts from the row after it. With one member it is corrected as
/// `follow` does. With several, each has a filter of its own, and the correction is the mean of theirs with weights that
/// move with their losses, by the C code of controls (control/probe_members.h).
/// @param time_s  of the rows
[[nodiscard]] ProbedRun probed_run(std::span<const ProbedMember> members, std::span<const double> time_s,
                                   const RunProbing& how);

}  // namespace driftwright::compensation
