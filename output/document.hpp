#pragma once
// One document of results: what a study found, said once, as plain data. The terminal's text, JSON, CSV and HTML are renderings of it
// (document_text, document_json, document_csv, document_html), so that the same numbers stand in all four.
//
// What carries a key is for programs too; what has none (explanations, pictures) is for people alone. A `detail` stands in files, not on the
// terminal, unless details are asked for. Numbers stand in the unit that they are shown in.

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "output/plot.hpp"
#include "output/provenance.hpp"

namespace driftwright::output {

/// How people see a number; programs get six significant digits of it in JSON, seven in CSV as in records.
struct Digits {
  enum class Kind {
    kDecimals,     ///< n behind the point
    kSignificant,  ///< n in all, as short as they can be written
    kScientific,   ///< n behind the point, with an exponent
    kPercent,      ///< of a share: its hundredfold with n decimals
  };
  int n = 1;
  Kind kind = Kind::kDecimals;
  bool has_sign = false;  ///< "+" before what is above 0
};
[[nodiscard]] constexpr Digits decimals(int n) {
  return {.n = n};
}
[[nodiscard]] constexpr Digits signed_decimals(int n) {
  return {.n = n, .has_sign = true};
}
[[nodiscard]] constexpr Digits significant(int n) {
  return {.n = n, .kind = Digits::Kind::kSignificant};
}
[[nodiscard]] constexpr Digits scientific(int n) {
  return {.n = n, .kind = Digits::Kind::kScientific};
}
[[nodiscard]] constexpr Digits percent(int n) {
  return {.n = n, .kind = Digits::Kind::kPercent};
}

/// Nothing, yes or no, a count, a number (NaN: none), words, or a list.
struct Datum {
  using Held = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::string>,
                            std::vector<double>, std::vector<std::vector<double>>, std::vector<std::int64_t>>;
  Held held = {};
  std::optional<Digits> digits = {};  ///< in place of its column's

  Datum();
  Datum(const Datum& other);
  Datum(Datum&& other) noexcept;
  Datum& operator=(const Datum& other);
  Datum& operator=(Datum&& other) noexcept;
  ~Datum();  // these in document.cpp: tables of rows in braces would else be most of what is compiled
  Datum(std::same_as<bool> auto yes) : held(yes) {}
  template <std::integral T>
  requires(!std::same_as<T, bool>) Datum(T count) : held(static_cast<std::int64_t>(count)) {}
  Datum(double number) : held(number) {}
  Datum(double number, Digits how) : held(number), digits(how) {}
  Datum(const std::optional<double>& number) {
    if (number) held = *number;
  }
  Datum(std::string words) : held(std::move(words)) {}
  Datum(const char* words) : held(std::string(words)) {}
  Datum(std::vector<std::string> words) : held(std::move(words)) {}
  Datum(std::vector<double> numbers) : held(std::move(numbers)) {}
  Datum(std::vector<std::vector<double>> rows) : held(std::move(rows)) {}
  Datum(std::vector<std::int64_t> counts) : held(std::move(counts)) {}
};

/// A key of several words, "before.peak_um", is a JSON object within an object.
struct Value {
  std::string key = {};  ///< with its unit: "duration_min"
  std::string words = {};
  Datum datum = {};
  std::string unit = {};  ///< "": none
  Digits digits = {};
  bool detail = false;
};

struct Column {
  std::string key = {};    ///< as a value's
  std::string title = {};  ///< without the unit; "": for programs alone
  std::string unit = {};   ///< "": none
  Digits digits = {};
};
/// A JSON list of objects; a CSV.
struct Table {
  std::string key = {};
  std::string title = {};    ///< a few words; "": the section's title does
  std::string caption = {};  ///< sentences that explain it, on the page
  std::vector<Column> columns = {};
  std::vector<std::vector<Datum>> rows = {};  ///< each as long as columns
  bool detail = false;
  std::string file = {};  ///< of its CSV; "": tables/<keys>.csv
};

/// What the reader should take home.
struct Verdict {
  enum class Kind { kGood, kBad, kNeutral };
  std::string key = "verdict";
  Kind kind = Kind::kNeutral;
  std::string title = {};  ///< a few words: "Safe to use"
  std::string text = {};   ///< a sentence or two, may be empty
};

/// Sentences.
struct Text {
  std::string words = {};
  std::string key = {};
  bool detail = false;
};
/// Remarks of one sort, a sentence each without its full stop.
struct Notes {
  std::string key = {};   ///< "warnings"
  std::string sort = {};  ///< "warning", which stands before each; "": nothing does
  std::vector<std::string> lines = {};
};
/// Text whose line breaks and blanks count.
struct Preformatted {
  std::string title = {};
  std::string text = {};
};

/// A drawing that is made already, for the page.
struct Picture {
  std::string title = {};
  std::string svg = {};  ///< an <svg> element with a viewBox, as draw_machine() makes it
};

using Block = std::variant<Value, Table, Verdict, Text, Notes, Preformatted, Plot, Bars, Picture>;

/// One of several alike, such as the results of one cyclogram: an element of the JSON list of its section's key, and the first cell of each
/// row of its tables in CSV, under the item's key.
struct Item {
  std::string key = {};   ///< "cyclogram"
  std::string name = {};  ///< "warm_up"
};

struct Section {
  std::string key = {};    ///< "": its content belongs to the section around it
  std::string title = {};  ///< "": no heading
  std::optional<Item> item = {};
  std::vector<Block> blocks = {};
  std::vector<Section> sections = {};  ///< behind the blocks
  bool detail = false;                 ///< all of it
};

struct Document {
  Provenance made_by = {};
  std::string title = {};
  std::string subtitle = {};  ///< what is worth knowing before all numbers; may be empty
  Section body = {};
};

/// Makes adding to a section short: `add(s, Value{...})`.
inline void add(Section& section, Block block) {
  section.blocks.push_back(std::move(block));
}

/// A datum as people see it: "12.3", "yes", "a, b"; "-" for nothing.
[[nodiscard]] std::string shown(const Datum& datum, const Digits& digits);
/// As programs read it in CSV: seven significant digits; "" for nothing.
[[nodiscard]] std::string written(const Datum& datum);
/// A unit as people see it: µm for um, °C for degC.
[[nodiscard]] std::string shown_unit(const std::string& unit);
/// A column's title with its unit: "peak [µm]".
[[nodiscard]] std::string heading_of(const Column& column);

}  // namespace driftwright::output
