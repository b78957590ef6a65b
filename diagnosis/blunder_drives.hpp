#pragma once
// Blunders that change what drives the machine: the record with another speed, clock or ambient, as it may have been meant.

#include <string>
#include <vector>

#include "diagnosis/measured_run.hpp"

namespace driftwright::diagnosis {

struct OtherDrive {
  MeasuredRun run;                ///< without the blunder
  std::string what, instead;      ///< as in Blunder (blunders.hpp)
  double time_factor = 1.0;       ///< of all times
  std::string ambient_from = {};  ///< the channel that is exchanged with the ambient
  bool is_still_air = false;      ///< its ambient is constant, since the thermometer may be on the machine; without words

  [[nodiscard]] bool is_of_ambient() const { return is_still_air || !ambient_from.empty(); }
};

/// All that are plausible: the speed in 1/s, rad/s or thousands of rpm, or 60 times too much; times a sixtieth, 60 or 3600
/// times as long; drives that come up to two hours earlier or later than the readings; the ambient exchanged with a
/// thermometer, or constant.
/// @param is_met  for each channel, whether the scenario as written meets it; the ambient is not exchanged with such a one
/// @param longest_s  no record is taken to be longer in truth; nor are rows more than 30 min apart
[[nodiscard]] std::vector<OtherDrive> other_drives(const MeasuredRun& run, const std::vector<char>& is_met,
                                                   double longest_s);

/// The run with all its times multiplied by a factor.
[[nodiscard]] MeasuredRun with_clock(MeasuredRun run, double factor);

/// The recorded ambient at the rows of a run, minus the reference [K].
[[nodiscard]] Eigen::VectorXd ambient_rows(const MeasuredRun& run);

}  // namespace driftwright::diagnosis
