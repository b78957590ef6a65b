#pragma once
// One physical effect: what it is (EffectKind, a constant) and one use of it in a machine (Effect, data).
// A new effect is one new file that defines its EffectKind; no other code changes. See README.md in this folder.

#include <limits>
#include <map>
#include <memory>
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

/// What the name in an effect's place refers to; place_key() is its YAML key. The ambient, the clock and the spindle have no
/// name and no key. A law is named as in heat_flows.csv: the heat or exchange of another effect.
enum class Place { kRegion, kSurface, kJoint, kNode, kAmbient, kSensor, kDisplacement, kClock, kSpindle, kLaw };
[[nodiscard]] const char* place_key(Place place);

/// Default uncertainty of heat capacity, conductivity and expansion of a body: standard deviation of the logarithm.
inline constexpr double kBodyScatter = 0.10;

/// How a diagnosis may change one number of a written effect beyond its scatter, where it does not doubt the law as a whole.
enum class Doubted { kNo, kFactor, kShift };

/// A number of an effect: name, unit, allowed range, default, meaning, and how well it is known.
struct Parameter {
  std::string name;
  std::string unit;  ///< UDUNITS syntax; Effect holds the value in this unit. "degC": a temperature, held in K
  double low = 0.0;  ///< inclusive; in K for a temperature
  double high = 0.0;
  /// Value when the key is missing; none: the key is compulsory; kNotGiven: may be left out.
  std::optional<double> fallback;
  std::string meaning;
  /// How well a user knows it: standard deviation of its logarithm. 0: a condition or a dimension, which is not fitted.
  double scatter = 0.0;
  std::string finding = {};  ///< key of the effect that a diagnosis reports if the value is far outside its scatter
  Doubted doubted = Doubted::kNo;
  double shift_sd = 0.0;    ///< 1 sigma of a doubted shift, in `unit`
  bool is_of_body = false;  ///< calibrated by a factor on the heat capacity of its place, whose scatter is kBodyScatter
};
/// Value of a parameter that was left out; Effect::has() tests for it.
inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// Another body that an effect refers to: `surrounding: air_nose`, or `inner: {region: spindle}` for a kind other than the
/// first.
struct Reference {
  std::string name;
  std::vector<BodyKind> kinds;          ///< allowed kinds; a bare name means the first. "ambient" is a node
  std::optional<std::string> fallback;  ///< name when the key is missing, "" for none; no value: the key is compulsory
  std::string meaning;
};

/// One of several words.
struct Choice {
  std::string name;
  std::vector<std::string> options;
  std::optional<std::string> fallback;
  std::string meaning;
};

/// Rows of two quantities, the first increasing. A single quantity is also allowed; it becomes the second one of a single
/// row at zero.
struct Table {
  std::string name;
  std::string argument_unit, value_unit;  ///< "degC" columns are held in K
  double low = 0.0, high = 0.0;           ///< of the values
  bool compulsory = true;
  std::string meaning;
};

/// Another sensor, displacement or recorded column that an effect refers to, a formula, a file, a list of bodies or points,
/// or a name that the effect gives; `Effect::words` holds its name or text, "" if left out.
struct Mention {
  enum class Of {
    kSensor,
    kDisplacement,
    kColumn,   ///< of the cyclogram (Cyclogram::column()), with or without its unit
    kFormula,  ///< no name: a formula, whose entry declares the names in it (formula.hpp)
    kBodies,   ///< a list of bodies of the place's kind; words as text_of() writes it (flow_path.hpp)
    kPoints,   ///< a list of points [mm]; likewise
    kFile,     ///< a file; scenarios/reader/film_files reads it
    kText,     ///< a name in that file
    kOwn,      ///< a name for what comes about here: the lumped nodes of a screw
  };
  std::string name;
  Of of = Of::kSensor;
  bool compulsory = false;
  std::string meaning;
  std::string unit = {};  ///< that a column must have, as in a record; "": any
};

/// Whether an effect may be limited to a part of the time.
enum class Timing {
  kAlways,    ///< it is part of the machine
  kInRecord,  ///< `in: CYCLOGRAM` limits it to that cyclogram
  kInTime,    ///< and `from` and `until` limit it further: a draught, a lamp, an oven that is switched off
};
inline constexpr double kNever_s = std::numeric_limits<double>::infinity();  ///< default of `until`
/// Number of steps of constant power per period of a wave: its amplitude is met to 0.6 %.
inline constexpr double kStepsAPeriod = 16.0;

struct DoubtScene;
struct Doubt;
struct Effect;

/// Everything that the program knows about one kind of effect.
struct EffectKind {
  std::string key;    ///< type in YAML and diagnosis.json
  std::string title;  ///< in words
  std::string law;    ///< formula and source, one line
  std::vector<Place> places;
  std::vector<Parameter> parameters;
  Timing timing = Timing::kAlways;
  bool keeps_time_itself = false;  ///< its laws check `in` themselves, because something continues outside of it
  /// Adds the effect's heats and exchanges, as if it acted at all times. The Effect lives only during the call: copy what a
  /// Law needs.
  void (*contribute)(const Effect&, HeatBalance&) = nullptr;
  /// Changes which bodies the exchanges of all other effects join.
  void (*change_paths)(const Effect&, HeatBalance&) = nullptr;
  /// Changes the laws of all other effects, after contribute and change_paths of all effects.
  void (*change_laws)(const Effect&, HeatBalance&) = nullptr;
  // Changes of the recorded drive and ambient, of what instruments read, of a material. Null: none.
  void (*change_drive)(const Effect&, DriveChange&) = nullptr;
  void (*change_readings)(const Effect&, ReadingChain&) = nullptr;
  void (*change_material)(const Effect&, MaterialFactor&) = nullptr;
  std::vector<Reference> references = {};
  std::vector<Choice> choices = {};
  std::vector<Table> tables = {};
  /// Checks what the range of a single key cannot express (this or that, not both). Called after all is read; reports with
  /// ConfigMap::fail().
  void (*check)(const Effect&, const ConfigMap&) = nullptr;
  std::vector<Mention> mentions = {};
  /// Lists the doubts of this kind: how a machine may differ from its scenario by this effect, for every possible place
  /// (doubt.hpp). Null: none.
  std::vector<Doubt> (*doubts)(const DoubtScene&) = nullptr;
  /// Key of the effect that a diagnosis reports for a factor on its exchanges; "": the factor is not searched for.
  std::string exchange_finding = {};
  /// Lists the bodies whose mean temperatures change_readings uses. Null: all references.
  std::vector<Body> (*reads)(const Effect&) = nullptr;

  /// Names of the numbers that a diagnosis calibrates.
  [[nodiscard]] std::vector<std::string> known_roughly() const;
  /// True if it adds or changes heat.
  [[nodiscard]] bool acts_on_heat() const { return contribute || change_paths || change_laws; }
  /// True if it changes readings only: the machine itself is not affected.
  [[nodiscard]] bool is_of_readings() const { return change_readings && !acts_on_heat() && !change_drive; }
};

/// The reference `surrounding` of films: a lumped node, "ambient" by default.
[[nodiscard]] Reference surrounding_reference();

/// One effect of a scenario: its kind, its place and its values.
struct Effect {
  const EffectKind* kind = nullptr;  ///< in catalogue(), or declared by an entry (formula.hpp); lives as long as the program
  Place place_kind = Place::kRegion;
  std::string place = {};           ///< name of the place; for the ambient, the clock and the spindle equal to place_key()
  std::vector<double> values = {};  ///< in the order of kind->parameters
  std::map<std::string, Body> references = {};  ///< those that are given or have a default
  /// Positions of the references and mentions that the scenario contains.
  std::map<std::string, Where> reference_where = {};
  std::map<std::string, std::string> words = {};
  std::map<std::string, TimeSeries> tables = {};  ///< those given; `time_s` holds the argument in its own unit
  double from_s = 0.0, until_s = kNever_s;        ///< when it acts, `until` excluded; for Timing::kInTime
  std::string in = {};                            ///< the cyclogram in which it acts; "": in all
  KnownTo known_to = {};                          ///< how well its values are known, where the scenario says so
  /// Values of its file, once scenarios/reader/film_files has read it. Shared, because effects are copied often.
  std::shared_ptr<const SurfaceField> field = {};
  Where where = {};  ///< position in the scenario, for errors that are found only once the mesh exists

  /// Value by parameter name, in the parameter's unit. @throws std::logic_error  if the kind has no such parameter
  [[nodiscard]] double operator[](const std::string& parameter) const;
  /// True if the value is given or has a default.
  [[nodiscard]] bool has(const std::string& parameter) const;
  /// Sets a value, in the parameter's unit. @throws std::logic_error  if the kind has no such parameter
  void set(const std::string& parameter, double value);
  /// True if it acts in the cyclogram of that name.
  [[nodiscard]] bool acts_in(const std::string& run) const { return in.empty() || in == run; }
  [[nodiscard]] std::string name() const { return kind->key + " " + place; }
  /// Its place as a body. @throws std::logic_error  for a place that is not a body, such as a clock
  [[nodiscard]] Body body() const;
};

/// Every effect there is, in the order of the documentation.
[[nodiscard]] const std::vector<EffectKind>& catalogue();
/// @throws std::logic_error  for a key that does not exist
[[nodiscard]] const EffectKind& kind_of(const std::string& key);

/// The kind of place for a kind of body.
[[nodiscard]] Place place_kind(BodyKind kind);

/// An effect with the defaults of its kind and the given values, in their parameters' units.
[[nodiscard]] Effect make_effect(const std::string& key, Place place_kind, const std::string& place,
                                 const std::vector<std::pair<std::string, double>>& values = {});
/// The same at a body.
[[nodiscard]] Effect make_effect(const std::string& key, const Body& body,
                                 const std::vector<std::pair<std::string, double>>& values = {});

/// Reads one entry of the scenario's list `effects`: type, place, parameters.
/// @throws InputError  for an unknown type or key, a wrong unit, a value out of range
[[nodiscard]] Effect read_effect(const ConfigMap& in);
/// Reads the list `effects` of a scenario. Names that a formula uses must be quantities or bodies: nodes of the list or
/// ambient.
/// @throws InputError  as read_effect()
[[nodiscard]] std::vector<Effect> read_effects(const std::vector<ConfigMap>& entries);
/// The entry as one line that read_effect() can read: "{type: convection, surface: nose, film: 8 W/(m^2 K)}". Values equal
/// to their default are left out; numbers are written with enough digits to be read back up to rounding.
[[nodiscard]] std::string yaml_of(const Effect& effect);
/// A number of a parameter with its unit, as yaml_of() writes it.
[[nodiscard]] std::string yaml_of(const Parameter& parameter, double value);

/// The heats and exchanges of a list of effects, in their order; factors on capacities of lumped nodes are applied. Laws of
/// effects with a limited time are zero outside it, and the balance's change_times_s contains the times at which they jump.
[[nodiscard]] HeatBalance heat_balance(const std::vector<Effect>& effects);
/// The changes that the effects make to the recorded drive and ambient during a cyclogram, and to readings. @param run its
/// name; "" for none
[[nodiscard]] DriveChange drive_change(const std::vector<Effect>& effects, const std::string& run);
[[nodiscard]] ReadingChain reading_chain(const std::vector<Effect>& effects, const std::string& run);
/// True if an effect changes the recorded drive or ambient.
[[nodiscard]] bool changes_drive(const Effect& effect);
/// True if an effect changes readings, in the cyclograms in which it acts.
[[nodiscard]] bool changes_readings(const Effect& effect);
/// The bodies whose mean temperatures the effect uses to change readings; with the ambient, if it is one of them.
[[nodiscard]] std::vector<Body> bodies_read(const Effect& effect);
/// True if some effect changes readings, in any cyclogram.
[[nodiscard]] bool has_reading_effects(const std::vector<Effect>& effects);
/// The changes that the effects make to materials.
[[nodiscard]] std::vector<MaterialFactor> material_factors(const std::vector<Effect>& effects);

}  // namespace driftwright::effects
