#include "follow/item_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/errors.hpp"
#include "base/quantity.hpp"

namespace driftwright::follow {
namespace {

struct UnitsOfType {
  const char* type;
  const char* units;
};
constexpr UnitsOfType kStandardUnits[] = {
    {"ACCELERATION", "MILLIMETER/SECOND^2"},
    {"ACCUMULATED_TIME", "SECOND"},
    {"AMPERAGE", "AMPERE"},
    {"AMPERAGE_AC", "AMPERE"},
    {"AMPERAGE_DC", "AMPERE"},
    {"ANGLE", "DEGREE"},
    {"ANGULAR_ACCELERATION", "DEGREE/SECOND^2"},
    {"ANGULAR_VELOCITY", "DEGREE/SECOND"},
    {"AXIS_FEEDRATE", "MILLIMETER/SECOND"},
    {"AXIS_FEEDRATE_OVERRIDE", "PERCENT"},
    {"BATTERY_CHARGE", "PERCENT"},
    {"CONCENTRATION", "PERCENT"},
    {"CUTTING_SPEED", "MILLIMETER/SECOND"},
    {"DEW_POINT", "CELSIUS"},
    {"DIAMETER", "MILLIMETER"},
    {"DISPLACEMENT", "MILLIMETER"},
    {"DISPLACEMENT_ANGULAR", "DEGREE"},
    {"DISPLACEMENT_LINEAR", "MILLIMETER"},
    {"ELECTRICAL_ENERGY", "WATT_SECOND"},
    {"EQUIPMENT_TIMER", "SECOND"},
    {"FILL_LEVEL", "PERCENT"},
    {"FLOW", "LITER/SECOND"},
    {"FREQUENCY", "HERTZ"},
    {"HUMIDITY_RELATIVE", "PERCENT"},
    {"LENGTH", "MILLIMETER"},
    {"LEVEL", "PERCENT"},
    {"LINEAR_FORCE", "NEWTON"},
    {"LOAD", "PERCENT"},
    {"MASS", "KILOGRAM"},
    {"OPENNESS", "PERCENT"},
    {"ORIENTATION", "DEGREE_3D"},
    {"PART_COUNT", "COUNT"},
    {"PATH_FEEDRATE", "MILLIMETER/SECOND"},
    {"PATH_FEEDRATE_OVERRIDE", "PERCENT"},
    {"PATH_FEEDRATE_PER_REVOLUTION", "MILLIMETER/REVOLUTION"},
    {"PATH_POSITION", "MILLIMETER_3D"},
    {"POSITION", "MILLIMETER"},
    {"POSITION_CARTESIAN", "MILLIMETER_3D"},
    {"POWER_FACTOR", "PERCENT"},
    {"PRESSURE", "PASCAL"},
    {"PROCESS_TIMER", "SECOND"},
    {"RESISTANCE", "OHM"},
    {"ROTARY_VELOCITY", "REVOLUTION/MINUTE"},
    {"ROTARY_VELOCITY_OVERRIDE", "PERCENT"},
    {"SPINDLE_SPEED", "REVOLUTION/MINUTE"},
    {"STRAIN", "PERCENT"},
    {"TEMPERATURE", "CELSIUS"},
    {"TENSION", "NEWTON"},
    {"TILT", "MICRO_RADIAN"},
    {"TORQUE", "NEWTON_METER"},
    {"VELOCITY", "MILLIMETER/SECOND"},
    {"VOLTAGE", "VOLT"},
    {"VOLTAGE_AC", "VOLT"},
    {"VOLTAGE_DC", "VOLT"},
    {"VOLT_AMPERE", "VOLT_AMPERE"},
    {"WATTAGE", "WATT"},
    {"X_DIMENSION", "MILLIMETER"},
    {"Y_DIMENSION", "MILLIMETER"},
    {"Z_DIMENSION", "MILLIMETER"},
};

/// "AXIS_FEEDRATE" and "AxisFeedrate" are one type.
std::string letters_of(const std::string& type) {
  std::string letters;
  for (const char c : type) {
    if (c != '_') letters += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return letters;
}

}  // namespace

std::string unit_of_mtconnect(const std::string& units) {
  if (units.find("_3D") != std::string::npos)
    throw RangeError(fmt::format("'{}' is a unit of three numbers, and a channel has one", units));
  std::string unit;
  for (const char c : units) unit += c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (const std::size_t micro = unit.find("micro "); micro != std::string::npos) unit.erase(micro + 5, 1);  // a prefix
  (void)unit_factor(unit, unit);                                                                            // is it known?
  return unit;
}

std::string standard_units(const std::string& type, const std::string& sub_type) {
  const std::string letters = letters_of(type);
  const auto found = std::find_if(std::begin(kStandardUnits), std::end(kStandardUnits),
                                  [&](const UnitsOfType& u) { return letters_of(u.type) == letters; });
  if (found == std::end(kStandardUnits)) return "";
  return letters_of(sub_type) == "OVERRIDE" ? "PERCENT" : found->units;
}

}  // namespace driftwright::follow
