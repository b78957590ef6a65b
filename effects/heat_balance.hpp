#pragma once
// What effects say about heat, in words of the machine (regions, surfaces, joints, lumped nodes), before any mesh or matrix.
// The solver turns each entry into a matrix or a load.

#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::effects {

enum class BodyKind { kRegion, kSurface, kNode };

/// What heat enters, leaves, or is looked at: a region, a surface or a lumped node.
struct Body {
  BodyKind kind = BodyKind::kRegion;
  std::string name;
  bool operator==(const Body&) const = default;
};
[[nodiscard]] inline Body region(std::string name) {
  return {BodyKind::kRegion, std::move(name)};
}
[[nodiscard]] inline Body surface(std::string name) {
  return {BodyKind::kSurface, std::move(name)};
}
/// A lumped node; "hall" is the air of the hall.
[[nodiscard]] inline Body node(std::string name) {
  return {BodyKind::kNode, std::move(name)};
}
inline constexpr const char* kHallName = "hall";

/// What a law may look at.
struct Inputs {
  Drive drive;
  double hall_K = 0.0;               ///< hall temperature minus the reference temperature
  double time_s = 0.0;               ///< within the stretch of time at hand; see HeatBalance::change_times_s
  std::vector<double> probe_K = {};  ///< temperatures [K] of the law's probes, absolute, in their order
};

/// A coefficient or a power that follows the drive and, if it has probes, mean temperatures of the machine.
struct Law {
  std::function<double(const Inputs&)> value;
  std::vector<Body> probes;  ///< whose mean temperature the law looks at
  std::string thermostat;    ///< zero while this thermostat is off; "" for none

  Law() = default;
  template <class F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, Law> && std::is_invocable_r_v<double, F, const Inputs&>)
      Law(F function, std::vector<Body> looks_at = {}, std::string switched_by = {})  // NOLINT: a lambda is a law
      : value(std::move(function)), probes(std::move(looks_at)), thermostat(std::move(switched_by)) {}
  double operator()(const Inputs& u) const { return value(u); }
};

/// Heat released evenly over the volume of a region, the area of a surface, or in a node. power_W > 0 heats.
struct HeatInput {
  std::string name;
  Body body;
  Law power_W;
};

/// Film on a surface: heat out of the body q = htc (T_surface - T_surrounding) per area.
struct Film {
  std::string name;
  std::string surface;
  Law htc_W_m2K;
  std::string surrounding = kHallName;  ///< "hall" or the name of a lumped node
};

/// Conductance between a body and one temperature: Q = conductance (T_body - T_surrounding), spread evenly over the body.
struct Link {
  std::string name;
  Body body;
  Law conductance_W_K;
  std::string surrounding = kHallName;
};

/// Grey radiation to a surrounding that encloses the body: q = emissivity σ (T^4 - T_surrounding^4) per area, T local.
struct Radiation {
  std::string name;
  std::string surface;
  double emissivity = 0.0;
  std::string surrounding = kHallName;
};

/// Contact across a joint: q = conductance (T_a - T_b) per area.
struct Contact {
  std::string name;
  std::string joint;
  Law conductance_W_m2K;
};

/// A body with one temperature, such as the air near the nose, an oil tank or a rotor.
struct LumpedNode {
  std::string name;
  double capacity_J_K = 0.0;
};

/// A surface or a node whose temperature is prescribed. Where two surfaces meet, the first of the list rules.
struct FixedTemperature {
  std::string name;
  Body body;
  TimeSeries temperature_K;   ///< absolute; a single knot for a constant
  bool follows_hall = false;  ///< then temperature_K is not looked at
};

/// Hall air that is warmer above than below: T(z) = T_hall + gradient (z - level), for every film and radiation to the hall.
struct Stratification {
  double gradient_K_m = 0.0;
  double level_m = 0.0;  ///< height of the hall's thermometer; Z is up
};

/// A switch with hysteresis: on when the probe rises above on_above_K, off when it falls below off_below_K.
struct Thermostat {
  std::string name;
  Body probe;
  double on_above_K = 0.0;   ///< absolute
  double off_below_K = 0.0;  ///< < on_above_K; it starts off unless the probe starts above on_above_K
};

struct HeatBalance {
  std::vector<HeatInput> heats;
  std::vector<Film> films;
  std::vector<Link> links;
  std::vector<Radiation> radiations;
  std::vector<Contact> contacts;
  std::vector<LumpedNode> nodes;
  std::vector<FixedTemperature> fixed;
  std::vector<Stratification> stratifications;
  std::vector<Thermostat> thermostats;
  /// Times [s] at which laws may jump by themselves (a draught begins). Between two of them a law does not change with time.
  std::vector<double> change_times_s;
};

}  // namespace driftwright::effects
