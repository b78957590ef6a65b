#pragma once
// What the maps of a YAML file may contain, as plain data. A reader describes its keys once; ConfigMap reads by the
// description, `driftwright schema` prints it, and docs/reference/scenario.md shows it as tables. A key without description
// cannot be read, and a described key must be read.

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace driftwright {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

namespace schema {

/// Default limits of absolute temperatures [K].
inline constexpr double kColdest_K = 1.0, kHottest_K = 3000.0;

struct Map;

/// One way in which a value may be written.
struct Value {
  enum class Kind {
    kText,      ///< any word or line
    kName,      ///< may become a channel, a file or a folder: letters, digits, '_' and '-'
    kChoice,    ///< one of `options`
    kInteger,   ///< from `low` to `high`
    kQuantity,  ///< a number with a unit; "degC" is an absolute temperature, `low` and `high` then in K
    kList,      ///< entries, each as items[0]
    kRow,       ///< as many entries as `items`, each as its own
    kMap,       ///< as one of `maps`
    kAnything,  ///< whatever the other file at that place contains
  };
  Kind kind = Kind::kText;
  std::vector<std::string> options = {};
  std::string unit = {};                    ///< UDUNITS syntax; "": any unit
  double low = -kNoLimit, high = kNoLimit;  ///< inclusive
  bool or_zero = false;                     ///< of a quantity: 0 is allowed besides low to high
  std::size_t least = 0;                    ///< smallest number of entries of a list
  std::vector<Value> items = {};
  std::vector<Map> maps = {};  ///< the first whose condition holds applies; a map without a condition always applies
};

/// A key of a map.
struct Key {
  std::string name;
  std::vector<Value> values;  ///< one or more ways to write it
  std::string meaning;
  bool is_compulsory = false;
  std::optional<double> number = {};     ///< the default: of a quantity in its unit (K for degC), of an integer as it is
  std::optional<std::string> word = {};  ///< the default of texts and choices
  std::string said = {};                 ///< the default in words, where the reader gets it from elsewhere

  /// The way with this kind, or nullptr.
  [[nodiscard]] const Value* way(Value::Kind kind) const;
};

/// Keys that depend on each other.
struct Group {
  enum class Rule {
    kExactlyOne,
    kAtLeastOne,
    kAtMostOne,
    kAllOrNone,
    kWantFirst,  ///< each of them requires the first
  };
  Rule rule;
  std::vector<std::string> keys;
  std::string message;  ///< what is required, for errors
};

/// Keys of a map. If one place allows several maps, `when_key` and `when_word` choose: the map applies if it has that key
/// with that word.
struct Map {
  std::string name;  ///< heading of its table; unique
  std::vector<Key> keys = {};
  std::vector<Group> groups = {};
  /// At most one: describes every key that is not among `keys`; its name says what those keys name.
  std::vector<Key> others = {};
  std::string when_key = {};
  std::string when_word = {};  ///< "": any
  std::string about = {};      ///< a sentence before its table

  [[nodiscard]] const Key* find(const std::string& key) const;
  /// Keys by name, for messages.
  [[nodiscard]] std::vector<std::string> names() const;
};

[[nodiscard]] Value text();
[[nodiscard]] Value name();
[[nodiscard]] Value choice(std::vector<std::string> options);
/// true or false.
[[nodiscard]] Value flag();
[[nodiscard]] Value integer(int low, int high);
[[nodiscard]] Value quantity(std::string unit, double low = -kNoLimit, double high = kNoLimit);
/// Within low to high, or 0.
[[nodiscard]] Value quantity_or_zero(std::string unit, double low, double high);
[[nodiscard]] Value temperature(double low_K = kColdest_K, double high_K = kHottest_K);
[[nodiscard]] Value list(Value of, std::size_t least = 0);
[[nodiscard]] Value row(std::vector<Value> items);
/// At least one row, each as described.
[[nodiscard]] Value rows(std::vector<Value> items);
/// Three quantities, along x, y and z.
[[nodiscard]] Value vector3(const std::string& unit, double low = -kNoLimit, double high = kNoLimit);
[[nodiscard]] Value map(Map of);
[[nodiscard]] Value one_of(std::vector<Map> maps);
[[nodiscard]] Value anything();
/// A list of maps.
[[nodiscard]] Value maps(Map of);

using Ways = std::vector<Value>;
[[nodiscard]] Key compulsory(std::string name, Value value, std::string meaning);
[[nodiscard]] Key compulsory(std::string name, Ways ways, std::string meaning);
[[nodiscard]] Key optional(std::string name, Value value, std::string meaning);
[[nodiscard]] Key optional(std::string name, Ways ways, std::string meaning);
/// @param otherwise  the default if the key is left out
[[nodiscard]] Key optional(std::string name, Value value, double otherwise, std::string meaning);
[[nodiscard]] Key optional(std::string name, Value value, const char* otherwise, std::string meaning);
/// @param otherwise  the default in words: the reader gets it from elsewhere
struct Said {
  std::string words;
};
[[nodiscard]] Key optional(std::string name, Value value, Said otherwise, std::string meaning);
[[nodiscard]] Key optional(std::string name, Ways ways, Said otherwise, std::string meaning);

/// The default of a key as it would be written, or in words; "" without a default.
[[nodiscard]] std::string otherwise(const Key& key);
/// A number of a quantity in its unit, for error messages: "0.0005 m"; for "degC" the argument is in K: "20 degC".
[[nodiscard]] std::string written(double number, const std::string& unit);
/// The allowed range of a quantity or integer: "0 to 1 m", "1 N or more"; "" where anything is allowed.
[[nodiscard]] std::string range(const Value& value);
/// A number in a convenient unit: "0.5 mm".
[[nodiscard]] std::string readable(double number, const std::string& unit);

}  // namespace schema
}  // namespace driftwright
