#pragma once
// Tabulates a law of the catalogue for a page, over the drive and the temperatures that it depends on.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "effects/heat_balance.hpp"
#include "output/fmu/drive_law.hpp"

namespace driftwright::output {

/// The range of absolute temperatures in which laws are tabulated [K], and the value of the others while one varies.
struct TemperatureRange {
  double low_K = 0.0, high_K = 0.0, usual_K = 0.0;
};

/// The variable of a table: the temperature of one of the law's probes, or its difference to another probe.
struct TwinAxis {
  int probe = 0;                     ///< index in the law's list of probes
  int minus = -1;                    ///< index of the other probe; -1: none
  std::vector<double> nodes_K = {};  ///< increasing; the law is linear between them
};
/// A law over one or two of its probes, with the others at their usual temperature.
struct TwinTable {
  std::vector<TwinAxis> axes = {};  ///< one or two
  std::vector<DriveLaw> at = {};    ///< one per node, the last axis fastest
};

/// The law's value at usual temperatures over the drive, plus tables, each of which adds its difference to that.
struct TwinLaw {
  DriveLaw drive = {};
  std::vector<TwinTable> tables = {};
};

/// Tabulates a law of drive and temperatures: exact in the drive to rounding, and in temperature with nodes so close that
/// linear interpolation errs by less than a thousandth. Probes that act together share a table.
/// @param law       function of a drive and the temperatures of its probes
/// @returns nothing if more than two probes or two variables of the drive act together, or if a number is not finite
[[nodiscard]] std::optional<TwinLaw> twin_law(
    const std::function<double(const Drive&, const std::vector<double>& probe_K)>& law, int n_probes,
    const std::vector<DriveRange>& ranges, const TemperatureRange& range);

}  // namespace driftwright::output
