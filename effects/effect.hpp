#pragma once
// One physical effect: what it is (EffectKind, a constant) and one use of it in a machine (Effect, data).
// An effect's file defines its EffectKind and nothing else is touched; see README.md in this folder.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/config_map.hpp"
#include "effects/drive_change.hpp"
#include "effects/heat_balance.hpp"
#include "effects/material_factor.hpp"
#include "effects/reading_chain.hpp"

namespace driftwright::effects {

/// What an effect's place is the name of; its YAML key is place_key(). The hall, the clock and the spindle have no name and no key.
enum class Place { kRegion, kSurface, kJoint, kNode, kHall, kSensor, kDisplacement, kClock, kSpindle };
[[nodiscard]] const char* place_key(Place place);

/// A number of an effect: how it is written, what is allowed, what it means.
struct Parameter {
  std::string name;
  std::string unit;  ///< UDUNITS syntax; Effect holds the value in this unit. "degC": a temperature, held in K
  double low = 0.0;  ///< inclusive; in K for a temperature
  double high = 0.0;
  std::optional<double> fallback;  ///< value when the key is missing; compulsory without one; kNotGiven: may be left out
  std::string meaning;
  /// How well a user knows it: standard deviation of its logarithm. 0: a condition or a dimension, taken as it stands.
  double scatter = 0.0;
  std::string finding = {};  ///< key of the effect that a value far outside its scatter is called
};
/// Value of a parameter that was left out; Effect::has() asks for it.
inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// Another body that an effect names: `surrounding: air_nose`, or `inner: {region: spindle}` for another kind than the first.
struct Reference {
  std::string name;
  std::vector<BodyKind> kinds;          ///< allowed; a bare name means the first. "hall" is a node
  std::optional<std::string> fallback;  ///< name when the key is missing, "" for none; compulsory without one
  std::string meaning;
};

/// One of several words.
struct Choice {
  std::string name;
  std::vector<std::string> options;
  std::optional<std::string> fallback;
  std::string meaning;
};

/// Rows of two quantities, the first increasing; or a single quantity, which is then the second of one row at zero.
struct Table {
  std::string name;
  std::string argument_unit, value_unit;  ///< "degC" columns are held in K
  double low = 0.0, high = 0.0;           ///< of the values
  bool compulsory = true;
  std::string meaning;
};

/// A cyclogram or another sensor that an effect names; `Effect::words` holds it, "" where it is left out.
struct Mention {
  enum class Of { kCyclogram, kSensor };
  std::string name;
  Of of = Of::kCyclogram;
  bool compulsory = false;
  std::string meaning;
};
/// `in`, for what happened during one cyclogram alone.
[[nodiscard]] inline Mention in_cyclogram() {
  return {"in", Mention::Of::kCyclogram, false, "cyclogram during which; left out: in each"};
}

struct Effect;

struct EffectKind {
  std::string key;    ///< YAML and diagnosis.json
  std::string title;  ///< in words
  std::string law;    ///< formula and source, one line
  std::vector<Place> places;
  std::vector<Parameter> parameters;
  /// Adds what the effect does to heat. The Effect outlives no call: copy what a Law needs.
  void (*contribute)(const Effect&, HeatBalance&) = nullptr;
  // Or to the drive and the hall that are recorded, to what instruments say, to a material. Null: nothing.
  void (*change_drive)(const Effect&, DriveChange&) = nullptr;
  void (*change_readings)(const Effect&, ReadingChain&) = nullptr;
  void (*change_material)(const Effect&, MaterialFactor&) = nullptr;
  std::vector<Reference> references = {};
  std::vector<Choice> choices = {};
  std::vector<Table> tables = {};
  /// What no single range says (this or that, not both). Called when all is read; fails at the key with ConfigMap::fail().
  void (*check)(const Effect&, const ConfigMap&) = nullptr;
  std::vector<Mention> mentions = {};
};

/// The reference `surrounding` that films share: a lumped node, "hall" by default.
[[nodiscard]] Reference surrounding_reference();

/// An effect at a place with its values.
struct Effect {
  const EffectKind* kind = nullptr;  ///< points into catalogue(), which lives as long as the program
  Place place_kind = Place::kRegion;
  std::string place = {};                             ///< its name; place_key() for the hall, the clock and the spindle
  std::vector<double> values = {};                    ///< as kind->parameters
  std::map<std::string, Body> references = {};        ///< those given or with a fallback
  std::map<std::string, Where> reference_where = {};  ///< of those that are written, and of mentions
  std::map<std::string, std::string> words = {};
  std::map<std::string, TimeSeries> tables = {};  ///< argument in `time_s` whatever its unit; those given
  Where where = {};                               ///< in the scenario, for errors that show only once the mesh is there

  /// Value by parameter name, in the parameter's unit. @throws std::logic_error  for a name the kind has not
  [[nodiscard]] double operator[](const std::string& parameter) const;
  [[nodiscard]] bool has(const std::string& parameter) const;
  [[nodiscard]] std::string name() const { return kind->key + " " + place; }
  /// Its place as a body. @throws std::logic_error  for a place that is none, such as a joint
  [[nodiscard]] Body body() const;
};

/// Every effect there is, in the order of the documentation.
[[nodiscard]] const std::vector<EffectKind>& catalogue();

/// Reads one entry of the scenario's list `effects`: type, place, parameters.
/// @throws InputError  for an unknown type or key, a wrong unit, a value out of range
[[nodiscard]] Effect read_effect(const ConfigMap& in);

/// What a list of effects does to heat, in their order; capacities of lumped nodes with their factors.
[[nodiscard]] HeatBalance heat_balance(const std::vector<Effect>& effects);
/// What it does to the recorded drive and hall, to readings, and to materials (one entry an effect).
[[nodiscard]] DriveChange drive_change(const std::vector<Effect>& effects);
[[nodiscard]] ReadingChain reading_chain(const std::vector<Effect>& effects);
[[nodiscard]] std::vector<MaterialFactor> material_factors(const std::vector<Effect>& effects);

}  // namespace driftwright::effects
