#pragma once
// Units of an MTConnect agent's data items: by its probe, or by the standard for a type.

#include <string>

namespace driftwright::follow {

/// A data item as an agent's probe describes it.
struct DataItem {
  std::string id;
  std::string type, sub_type;  ///< "AXIS_FEEDRATE", "ACTUAL"
  std::string units;           ///< of its numbers, such as "MILLIMETER/SECOND"; "" where the probe does not say
};

/// A unit of MTConnect as UDUNITS reads it: the standard's names in small letters, as "MILLIMETER/SECOND^2" and
/// "NEWTON_METER", are names that UDUNITS knows. @throws RangeError  for one that it does not know, and for those of three
/// numbers (MILLIMETER_3D)
[[nodiscard]] std::string unit_of_mtconnect(const std::string& units);

/// The standard's unit of that type; "" where it has none. @param type  "AXIS_FEEDRATE", or "AxisFeedrate" as observations
/// are named.
/// Source: MTConnect Standard 2.2, Part 2, Device Information Model, "DataItem Types"; subtype OVERRIDE by version 1.1.
[[nodiscard]] std::string standard_units(const std::string& type, const std::string& sub_type);

}  // namespace driftwright::follow
