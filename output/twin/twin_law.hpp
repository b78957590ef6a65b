#pragma once
// A law of the catalogue as numbers that a page can look up: over the drive, and over the temperatures that it looks at.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "effects/heat_balance.hpp"
#include "output/fmu/drive_law.hpp"

namespace driftwright::output {

/// Between which temperatures laws are tabulated [K], absolute, and what other ones are held at while one varies.
struct TemperatureRange {
  double low_K = 0.0, high_K = 0.0, usual_K = 0.0;
};

/// What a table varies over: one of the law's probes, or how much warmer it is than another.
struct TwinAxis {
  int probe = 0;                     ///< index in the law's list of probes
  int minus = -1;                    ///< of the other one; -1: none
  std::vector<double> nodes_K = {};  ///< increasing; a law is linear between them
};
/// A law over one or two of its probes, the others at their usual temperature.
struct TwinTable {
  std::vector<TwinAxis> axes = {};  ///< one or two
  std::vector<DriveLaw> at = {};    ///< at each node, the last axis fastest
};

/// Its value at usual temperatures over the drive, and tables, each of which adds what it differs from that.
struct TwinLaw {
  DriveLaw drive = {};
  std::vector<TwinTable> tables = {};
};

/// Tabulates a law of drive and temperatures: `drive` to rounding, temperatures by nodes so close that what is linear between them misses by less
/// than a thousandth. Probes that act together share a table.
/// @param law       at a drive and temperatures of its probes
/// @returns nothing where more than two probes act together, two variables of the drive do, or a number is not finite
[[nodiscard]] std::optional<TwinLaw> twin_law(
    const std::function<double(const Drive&, const std::vector<double>& probe_K)>& law, int n_probes,
    const std::vector<DriveRange>& ranges, const TemperatureRange& range);

}  // namespace driftwright::output
