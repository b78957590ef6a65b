#pragma once
// One physical effect: what it is (EffectKind, a constant) and one use of it in a machine (Effect, data).
// An effect's file defines its EffectKind and nothing else is touched; see README.md in this folder.

#include <optional>
#include <string>
#include <vector>

#include "base/config_map.hpp"
#include "effects/heat_balance.hpp"

namespace driftwright::effects {

/// What an effect's place is the name of; its YAML key is place_key().
enum class Place { kRegion, kSurface, kJoint, kNode };
[[nodiscard]] const char* place_key(Place place);

/// A number of an effect: how it is written, what is allowed, what it means.
struct Parameter {
  std::string name;
  std::string unit;  ///< UDUNITS syntax; Effect holds the value in this unit
  double low = 0.0;  ///< inclusive
  double high = 0.0;
  std::optional<double> fallback;  ///< value when the key is missing; compulsory without one
  std::string meaning;
};

struct Effect;

struct EffectKind {
  std::string key;    ///< YAML and diagnosis.json
  std::string title;  ///< in words
  std::string law;    ///< formula and source, one line
  Place place = Place::kRegion;
  std::vector<Parameter> parameters;
  /// Adds what the effect does to heat. The Effect outlives no call: copy what a Law needs.
  void (*contribute)(const Effect&, HeatBalance&) = nullptr;
  bool has_surrounding = false;  ///< reads the key `surrounding`, "hall" by default
};

/// An effect at a place with its values.
struct Effect {
  const EffectKind* kind = nullptr;  ///< points into catalogue(), which lives as long as the program
  std::string place;                 ///< region, surface, joint or node
  std::vector<double> values;        ///< as kind->parameters
  std::string surrounding;
  Where where;  ///< in the scenario, for errors that show only once the mesh is there

  /// Value by parameter name, in the parameter's unit. @throws std::logic_error  for a name the kind has not
  [[nodiscard]] double operator[](const std::string& parameter) const;
  [[nodiscard]] std::string name() const { return kind->key + " " + place; }
};

/// Every effect there is, in the order of the documentation.
[[nodiscard]] const std::vector<EffectKind>& catalogue();

/// Reads one entry of the scenario's list `effects`: type, place, parameters.
/// @throws InputError  for an unknown type or key, a wrong unit, a value out of range
[[nodiscard]] Effect read_effect(const ConfigMap& in);

/// What a list of effects does to heat, in their order.
[[nodiscard]] HeatBalance heat_balance(const std::vector<Effect>& effects);

}  // namespace driftwright::effects
