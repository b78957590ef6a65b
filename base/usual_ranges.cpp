#include "base/usual_ranges.hpp"

#include <fmt/format.h>

namespace driftwright {

const std::vector<UsualRange>& usual_ranges() {
  static const std::vector<UsualRange> ranges = {
      {Usual::kHeat, "heat of one source or cooler", "kW", 1e3, -30.0, 30.0,
       "a fifth of the power of the largest main drives (150 kW), and chillers, in makers' catalogues"},
      {Usual::kFilm, "film coefficient", "W/(m^2 K)", 1.0, 0.0, 1e4,
       "Incropera et al., Fundamentals of Heat and Mass Transfer, table 1.1: gases up to 250, liquids up to 2e4, the upper "
       "half of which no cooling jacket reaches"},
      {Usual::kContact, "contact conductance of a joint", "W/(m^2 K)", 1.0, 0.0, 1e5,
       "Incropera et al., table 3.1: bare metal at 100 bar up to 1e5"},
      {Usual::kLink, "conductance between two bodies", "W/K", 1.0, 0.0, 5e3,
       "half a square metre of joint at 1e4 W/(m^2 K), or 70 l/min of water"},
      {Usual::kCapacity, "heat capacity of a lumped body", "J/K", 1.0, 0.1, 1e9,
       "a fifth of a gram of steel at 460 J/(kg K) to 1000 t of concrete at 1 kJ/(kg K)"},
      {Usual::kFeed, "velocity of an axis", "m/min", 1.0 / 60.0, 0.0, 240.0, "linear motors, in makers' catalogues"},
      {Usual::kAmbient, "ambient temperature", "degC", 1.0, -30.0, 60.0,
       "IEC 60204-1, 4.4.3: machines are made for 5 to 40 degC; with outdoor air"},
      {Usual::kTemperature, "temperature of a machine", "degC", 1.0, -40.0, 200.0,
       "IEC 60085: windings of class 200 end at 200 degC, those of class F at 155; bearings and their grease earlier"},
      {Usual::kDrift, "drift", "um", 1e-6, -1000.0, 1000.0,
       "Mayr et al., Thermal issues in machine tools, CIRP Annals 61 (2012) 771-791: some to some hundreds of um"},
      {Usual::kTilt, "tilt", "urad", 1e-6, -2000.0, 2000.0, "the largest drift over half a metre"},
      {Usual::kSensitivity, "displacement by the temperature of a body", "um/K", 1e-6, -100.0, 100.0,
       "8 m of steel at 12 um/(m K)"},
      {Usual::kDensity, "density", "kg/m^3", 1.0, 100.0, 20000.0, "foam to tungsten (Incropera et al., table A.1)"},
      {Usual::kConductivity, "conductivity", "W/(m K)", 1.0, 0.02, 450.0,
       "foam to silver (Incropera et al., tables A.1 and A.3)"},
      {Usual::kHeatCapacity, "heat capacity", "J/(kg K)", 1.0, 120.0, 4300.0,
       "tungsten to water (Incropera et al., tables A.1 and A.6)"},
      {Usual::kYoungsModulus, "Young's modulus", "GPa", 1e9, 0.1, 700.0, "plastics to cemented carbide"},
      {Usual::kExpansion, "thermal expansion", "um/(m K)", 1e-6, -2.0, 200.0, "carbon fibre to plastics"},
      {Usual::kRowInterval, "time from row to row of a record that says a speed", "min", 60.0, 0.0, 30.0,
       "spindles follow their heat within 10 to 60 min (Mayr et al.): what happens between rows farther apart is lost"},
  };
  return ranges;
}

const UsualRange& usual_range(Usual of) {
  return usual_ranges()[static_cast<std::size_t>(of)];
}

std::optional<std::string> beyond_usual(Usual of, double value, const std::string& when) {
  const UsualRange& range = usual_range(of);
  const double shown = value / range.unit_SI;
  if (shown >= range.low && shown <= range.high) return std::nullopt;
  const std::string usual =
      range.low == 0.0 ? fmt::format("up to {:g}", range.high) : fmt::format("{:g} to {:g}", range.low, range.high);
  return fmt::format("{:.4g} {}{}; usual is {} {}", shown, range.unit, when, usual, range.unit);
}

}  // namespace driftwright
