#pragma once
// The hidden effects of a case: kind, place and size, with their own laws for heat, drive, ambient and readings. Keys and
// meanings are the catalogue's, but none of its code is used.

#include <string>
#include <vector>

#include "blind/readings.hpp"
#include "blind/subject.hpp"

namespace driftwright::blind {

/// A kind of effect with its law; several laws may share a key of the catalogue.
enum class Hide {
  kHeatConstant,      ///< size W in a region or node
  kHeatOfSpeed,       ///< size W (n / at_speed)^exponent
  kFrictionExponent,  ///< friction times (n / at_speed)^size
  kFrictionDecay,     ///< friction times exp(-size (T - T_ref)), T of the bearing
  kFilmFactor,        ///< film times exp(size)
  kDraught,           ///< film of size W/(m^2 K) from time_s on
  kForcedFactor,      ///< growth times exp(size)
  kForcedNew,         ///< film size (n / at_speed)^exponent
  kContactFactor,     ///< joint or link times exp(size)
  kAmbientOffset,     ///< true minus recorded ambient: size K
  kAmbientRamp,       ///< size K/h
  kAmbientStep,       ///< size K from time_s on
  kStratification,    ///< size K/m about 1.2 m
  kRadiation,         ///< size W on a surface
  kCoolant,           ///< size W out of a region or node while the spindle turns or not
  kConductivity,      ///< of a region, times exp(size)
  kHeatCapacity,      ///< of a region or node, times exp(size)
  kExpansion,         ///< of a region, times exp(size)
  kSpindleGrowth,     ///< size um n / at_speed with one lag of lag_s
  kCentrifugal,       ///< size um (n / at_speed)^2
  kMountShift,        ///< size um from time_s on
  kSensorBias,        ///< size K
  kSensorLag,         ///< size s
  kSensorDrift,       ///< size K/h
  kSensorDetached,    ///< share size of air from time_s on
  kSensorSwap,        ///< where: "a,b"
  kClockOffset,       ///< size s, > 0: logged late
  kSpeedOverride,     ///< true speed = (1 + size) times the recorded one
  kMissingStop,       ///< from time_s on for size s
  kOscillatingHeat,   ///< size W sin(2π t / lag_s); drawn as if in no catalogue, though the catalogue has it now
  kTravelCreep,       ///< in no catalogue: size um per hour at top speed, with the revolutions made so far
  kAcceleratingHeat,  ///< in no catalogue: size J per rpm of each change of speed, released over a minute
  kContactLater,      ///< link times exp(size) from time_s on
  kProbeLag,          ///< size um more in a displacement, in all records: a probe that triggers late
  kCoolantHeld,       ///< size W/K between a body and a medium lag_s kelvins below the reference temperature
  kDoorOpen,          ///< size W/K between a node and the ambient, from time_s on for lag_s
};

struct Hidden {
  Hide what = Hide::kHeatConstant;
  std::string where = {};
  double size = 0.0;
  double low = 0.0, high = 0.0;  ///< bounds of |size|
  double at_speed_rpm = 0.0, exponent = 0.0, time_s = 0.0, lag_s = 0.0;
  int record = -1;  ///< index of the record it acts in; -1: all, and the holdout
};

/// Key of the catalogue; "" for a law without one.
[[nodiscard]] std::string key_of(Hide what);
/// The law in words, for truth.json.
[[nodiscard]] const char* law_name(Hide what);
/// True where size is a logarithm of a factor.
[[nodiscard]] bool is_factor(Hide what);
/// False for a swap, which has no size.
[[nodiscard]] bool has_size(Hide what);

struct TruthParameter {
  std::string name, unit;
  double value = 0.0;
};
/// The parameters as in truth.json: in the catalogue's units.
[[nodiscard]] std::vector<TruthParameter> parameters_of(const Hidden& hidden);

/// Changes materials, capacities and expansions. Effects that act in one record only are none of these.
void hide_in_values(const Hidden& hidden, const Subject& subject, Values& values);
/// Changes and adds laws of heat.
void hide_in_heat(const Hidden& hidden, const Subject& subject, const Cyclogram& true_drive, effects::HeatBalance& balance);
/// The true drive of a recorded one.
[[nodiscard]] Cyclogram true_drive(const Hidden& hidden, const Cyclogram& drive);
/// True minus recorded ambient temperature [K].
[[nodiscard]] double ambient_error_K(const Hidden& hidden, double time_s);
/// Changes readings. Called in the order of reading_order().
void hide_in_readings(const Hidden& hidden, const Cyclogram& true_drive, double top_speed_rpm, Readings& readings);
/// Displacements first, then detachment, lag, errors, swap, clock.
[[nodiscard]] int reading_order(Hide what);

/// The scatter parameters that a hidden factor changes: they keep their nominal value.
[[nodiscard]] bool stands_on(const Hidden& hidden, const ScatterParameter& parameter);

}  // namespace driftwright::blind
