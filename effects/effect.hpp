#pragma once
// One physical effect: what it is (EffectKind, a constant) and one use of it in a machine (Effect, data).
// An effect's file defines its EffectKind and nothing else is touched; see README.md in this folder.

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/config_map.hpp"
#include "effects/drive_change.hpp"
#include "effects/heat_balance.hpp"
#include "effects/known_to.hpp"
#include "effects/material_factor.hpp"
#include "effects/reading_chain.hpp"

namespace driftwright::effects {

/// What an effect's place is the name of; its YAML key is place_key(). The ambient, the clock and the spindle have no name and no key.
/// A law is named as in heat_flows.csv: the heat or exchange of another effect.
enum class Place { kRegion, kSurface, kJoint, kNode, kAmbient, kSensor, kDisplacement, kClock, kSpindle, kLaw };
[[nodiscard]] const char* place_key(Place place);

/// How well heat capacity, conductivity and expansion of a body are known where a scenario does not say it.
inline constexpr double kBodyScatter = 0.10;

/// How one number of an effect that is written may be wrong beyond its scatter, where not the law as a whole is doubted.
enum class Doubted { kNo, kFactor, kShift };

/// A number of an effect: how it is written, what is allowed, what it means.
struct Parameter {
  std::string name;
  std::string unit;  ///< UDUNITS syntax; Effect holds the value in this unit. "degC": a temperature, held in K
  double low = 0.0;  ///< inclusive; in K for a temperature
  double high = 0.0;
  std::optional<double> fallback;  ///< value when the key is missing; compulsory without one; kNotGiven: may be left out
  std::string meaning;
  /// How well a user knows it: standard deviation of its logarithm. 0: a condition or a dimension, taken as it is.
  double scatter = 0.0;
  std::string finding = {};  ///< key of the effect that a value far outside its scatter is called
  Doubted doubted = Doubted::kNo;
  double shift_sd = 0.0;    ///< 1 sigma of a doubted shift, in `unit`
  bool is_of_body = false;  ///< calibrated by a factor on the heat capacity of its place, which is known to kBodyScatter
};
/// Value of a parameter that was left out; Effect::has() asks for it.
inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// Another body that an effect names: `surrounding: air_nose`, or `inner: {region: spindle}` for another kind than the first.
struct Reference {
  std::string name;
  std::vector<BodyKind> kinds;          ///< allowed; a bare name means the first. "ambient" is a node
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

/// Another sensor, a displacement or a recorded column that an effect names; `Effect::words` holds it, "" where it is left out.
struct Mention {
  enum class Of {
    kSensor,
    kDisplacement,
    kColumn,  ///< of the cyclogram (Cyclogram::column()), with or without its unit
  };
  std::string name;
  Of of = Of::kSensor;
  bool compulsory = false;
  std::string meaning;
};

/// Whether an effect may act for a part of the time alone.
enum class Timing {
  kAlways,    ///< it is part of the machine
  kInRecord,  ///< `in: CYCLOGRAM`, during that one alone
  kInTime,    ///< and `from` and `until`: a draught, a lamp, an oven that is switched off
};
inline constexpr double kNever_s = std::numeric_limits<double>::infinity();
inline constexpr double kStepsAPeriod = 16.0;  ///< of constant power that a wave is cut into: its amplitude is met to 0.6 %

struct DoubtScene;
struct Doubt;
struct Effect;

struct EffectKind {
  std::string key;    ///< YAML and diagnosis.json
  std::string title;  ///< in words
  std::string law;    ///< formula and source, one line
  std::vector<Place> places;
  std::vector<Parameter> parameters;
  Timing timing = Timing::kAlways;
  bool keeps_time_itself = false;  ///< its laws look at `in` themselves: something goes on outside of it as well
  /// Adds what the effect does to heat, as if it acted at all times. The Effect outlives no call: copy what a Law needs.
  void (*contribute)(const Effect&, HeatBalance&) = nullptr;
  /// Or changes where the exchanges of all others lead.
  void (*change_paths)(const Effect&, HeatBalance&) = nullptr;
  /// Or what all others do to heat, once laws and paths are there.
  void (*change_laws)(const Effect&, HeatBalance&) = nullptr;
  // Or to the drive and the ambient that are recorded, to what instruments say, to a material. Null: nothing.
  void (*change_drive)(const Effect&, DriveChange&) = nullptr;
  void (*change_readings)(const Effect&, ReadingChain&) = nullptr;
  void (*change_material)(const Effect&, MaterialFactor&) = nullptr;
  std::vector<Reference> references = {};
  std::vector<Choice> choices = {};
  std::vector<Table> tables = {};
  /// What no single range says (this or that, not both). Called when all is read; fails at the key with ConfigMap::fail().
  void (*check)(const Effect&, const ConfigMap&) = nullptr;
  std::vector<Mention> mentions = {};
  /// In which ways a machine may be wrong by such an effect, at every place of it where it can be (doubt.hpp). Null: none is looked for.
  std::vector<Doubt> (*doubts)(const DoubtScene&) = nullptr;
  std::string exchange_finding =
      {};  ///< key of the effect that another factor on its exchanges is called; "": they are not doubted as a whole

  /// Names of the numbers that a diagnosis calibrates.
  [[nodiscard]] std::vector<std::string> known_roughly() const;
  [[nodiscard]] bool acts_on_heat() const { return contribute || change_paths || change_laws; }
  /// Whether it acts on instruments alone: the machine itself does not notice.
  [[nodiscard]] bool is_of_readings() const { return change_readings && !acts_on_heat() && !change_drive; }
};

/// The reference `surrounding` that films share: a lumped node, "ambient" by default.
[[nodiscard]] Reference surrounding_reference();

/// An effect at a place with its values.
struct Effect {
  const EffectKind* kind = nullptr;  ///< points into catalogue(), which lives as long as the program
  Place place_kind = Place::kRegion;
  std::string place = {};                             ///< its name; place_key() for the ambient, the clock and the spindle
  std::vector<double> values = {};                    ///< as kind->parameters
  std::map<std::string, Body> references = {};        ///< those given or with a fallback
  std::map<std::string, Where> reference_where = {};  ///< of those that are written, and of mentions
  std::map<std::string, std::string> words = {};
  std::map<std::string, TimeSeries> tables = {};  ///< argument in `time_s` whatever its unit; those given
  double from_s = 0.0, until_s = kNever_s;        ///< when it acts, `until` excluded; of Timing::kInTime
  std::string in = {};                            ///< cyclogram during which; "": in each
  KnownTo known_to = {};                          ///< of its values, where the scenario says it
  Where where = {};                               ///< in the scenario, for errors that show only once the mesh is there

  /// Value by parameter name, in the parameter's unit. @throws std::logic_error  for a name the kind has not
  [[nodiscard]] double operator[](const std::string& parameter) const;
  [[nodiscard]] bool has(const std::string& parameter) const;
  /// Sets a value, in the parameter's unit. @throws std::logic_error  for a name the kind has not
  void set(const std::string& parameter, double value);
  /// During a cyclogram of that name.
  [[nodiscard]] bool acts_in(const std::string& run) const { return in.empty() || in == run; }
  [[nodiscard]] std::string name() const { return kind->key + " " + place; }
  /// Its place as a body. @throws std::logic_error  for a place that is none, such as a joint
  [[nodiscard]] Body body() const;
};

/// Every effect there is, in the order of the documentation.
[[nodiscard]] const std::vector<EffectKind>& catalogue();
/// @throws std::logic_error  for a key that does not exist
[[nodiscard]] const EffectKind& kind_of(const std::string& key);

/// The place that a body is.
[[nodiscard]] Place place_kind(BodyKind kind);

/// An effect with the fallbacks of its kind, and some values given in their parameters' units.
[[nodiscard]] Effect make_effect(const std::string& key, Place place_kind, const std::string& place,
                                 const std::vector<std::pair<std::string, double>>& values = {});
/// The same at a body.
[[nodiscard]] Effect make_effect(const std::string& key, const Body& body,
                                 const std::vector<std::pair<std::string, double>>& values = {});

/// Reads one entry of the scenario's list `effects`: type, place, parameters.
/// @throws InputError  for an unknown type or key, a wrong unit, a value out of range
[[nodiscard]] Effect read_effect(const ConfigMap& in);
/// The entry that read_effect() reads back: one line, "{type: convection, surface: nose, film: 8 W/(m^2 K)}". What stands at its fallback
/// is left out; numbers are written so that they come back to rounding.
[[nodiscard]] std::string yaml_of(const Effect& effect);
/// A number of one of its parameters, with its unit, as yaml_of() writes it.
[[nodiscard]] std::string yaml_of(const Parameter& parameter, double value);

/// What a list of effects does to heat, in their order; capacities of lumped nodes with their factors. Laws of effects that act for a time are
/// zero outside it, and the balance tells when they jump.
[[nodiscard]] HeatBalance heat_balance(const std::vector<Effect>& effects);
/// What it does to the recorded drive and ambient, and to readings, during a cyclogram. @param run  its name; "" for none
[[nodiscard]] DriveChange drive_change(const std::vector<Effect>& effects, const std::string& run);
[[nodiscard]] ReadingChain reading_chain(const std::vector<Effect>& effects, const std::string& run);
/// Whether an effect changes what is recorded of the drive or the ambient.
[[nodiscard]] bool changes_drive(const Effect& effect);
/// Whether some effect changes what instruments say, in any cyclogram.
[[nodiscard]] bool has_reading_effects(const std::vector<Effect>& effects);
/// And to materials (one entry an effect).
[[nodiscard]] std::vector<MaterialFactor> material_factors(const std::vector<Effect>& effects);

}  // namespace driftwright::effects
