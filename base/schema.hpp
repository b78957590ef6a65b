#pragma once
// What the maps of a YAML file may hold, as plain data: a reader describes its keys once, and ConfigMap reads by that, `driftwright schema` prints
// it, docs/reference/scenario.md has it as tables. A key that stands in no description cannot be read, and one that nobody reads cannot stand there.

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace driftwright {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

namespace schema {

/// Of absolute temperatures [K].
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
    kAnything,  ///< whatever stands in another file at that place
  };
  Kind kind = Kind::kText;
  std::vector<std::string> options = {};
  std::string unit = {};                    ///< UDUNITS syntax; "": any
  double low = -kNoLimit, high = kNoLimit;  ///< inclusive
  bool or_zero = false;                     ///< of a quantity: 0 is allowed beside low to high
  std::size_t least = 0;                    ///< entries of a list
  std::vector<Value> items = {};
  std::vector<Map> maps = {};  ///< the first whose condition holds; one without a condition always does
};

/// A key of a map.
struct Key {
  std::string name;
  std::vector<Value> values;  ///< one or more ways to write it
  std::string meaning;
  bool is_compulsory = false;
  std::optional<double> number =
      {};  ///< what holds when it is left out: of a quantity in its unit (K for degC), of an integer
  std::optional<std::string> word = {};  ///< the same of texts and choices
  std::string said = {};                 ///< the same in words, where the reader knows it from elsewhere

  /// The way of a kind, or nullptr.
  [[nodiscard]] const Value* way(Value::Kind kind) const;
};

/// Keys that depend on each other.
struct Group {
  enum class Rule {
    kExactlyOne,
    kAtLeastOne,
    kAtMostOne,
    kAllOrNone,
    kWantFirst,  ///< each of them wants the first beside it
  };
  Rule rule;
  std::vector<std::string> keys;
  std::string message;  ///< what is required, for errors
};

/// Keys of a map. Where several maps may stand in one place, `when` says which it is: the one that has that key, with that word.
struct Map {
  std::string name;  ///< heading of its table, unlike all others
  std::vector<Key> keys = {};
  std::vector<Group> groups = {};
  std::vector<Key> others =
      {};  ///< at most one: of every key that is not among `keys`; its name says of what they are names
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
/// One at least, each such a row.
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
/// @param otherwise  what holds when it is left out
[[nodiscard]] Key optional(std::string name, Value value, double otherwise, std::string meaning);
[[nodiscard]] Key optional(std::string name, Value value, const char* otherwise, std::string meaning);
/// @param otherwise  the same in words: the reader knows it from elsewhere
struct Said {
  std::string words;
};
[[nodiscard]] Key optional(std::string name, Value value, Said otherwise, std::string meaning);
[[nodiscard]] Key optional(std::string name, Ways ways, Said otherwise, std::string meaning);

/// What holds when a key is left out, as it would be written, or in words; "" where nothing does.
[[nodiscard]] std::string otherwise(const Key& key);
/// A number of a quantity in its unit, as error messages have it: "0.0005 m"; of "degC" in K: "20 degC".
[[nodiscard]] std::string written(double number, const std::string& unit);
/// What a quantity or integer may be: "0 to 1 m", "1 N or more"; "" where anything is allowed.
[[nodiscard]] std::string range(const Value& value);
/// A number in the unit that suits it: "0.5 mm".
[[nodiscard]] std::string readable(double number, const std::string& unit);

}  // namespace schema
}  // namespace driftwright
