#pragma once
// One document of results: the findings of a study as plain data. The terminal's text, JSON, CSV and HTML are renderings
// of it (document_text, document_json, document_csv, document_html), so that all four show the same numbers.
//
// Content with a key is also for programs; content without one (explanations, pictures) is for people only. A `detail`
// appears in files, and on the terminal only on request; a table or a titled section that is one is folded on the page:
// only its title is shown until the reader opens it. Numbers are kept in the unit that they are shown in.
//
// A report is read from the top: the answer (a Verdict), the picture that shows it, what to do next, the numbers, and
// folded what only an expert needs.

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "output/plot.hpp"
#include "output/provenance.hpp"

namespace driftwright::output {

/// How a number is shown to people; programs get six significant digits of it in JSON, and seven in CSV, as in records.
struct Digits {
  enum class Kind {
    kDecimals,     ///< n after the point
    kSignificant,  ///< n in all, without trailing zeros
    kScientific,   ///< n after the point, with an exponent
    kPercent,      ///< of a share: a hundred times its value, with n decimals
  };
  int n = 1;
  Kind kind = Kind::kDecimals;
  bool has_sign = false;  ///< "+" before positive numbers
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
  std::optional<Digits> digits = {};  ///< instead of its column's

  Datum();
  Datum(const Datum& other);
  Datum(Datum&& other) noexcept;
  Datum& operator=(const Datum& other);
  Datum& operator=(Datum&& other) noexcept;
  ~Datum();  // defined in document.cpp: inline, tables of rows in braces would take most of the compile time
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

/// A single number, word or list. A key of several words, "before.peak_um", becomes a JSON object within an object.
struct Value {
  std::string key = {};  ///< includes the unit: "duration_min"
  std::string words = {};
  Datum datum = {};
  std::string unit = {};  ///< "": none
  Digits digits = {};
  bool detail = false;
};

struct Column {
  std::string key = {};    ///< as of a Value
  std::string title = {};  ///< without the unit; "": the column is for programs only
  std::string unit = {};   ///< "": none
  Digits digits = {};
};
/// A table: a list of objects in JSON, a file in CSV.
struct Table {
  std::string key = {};
  std::string title = {};    ///< a few words; "": the section's title is enough
  std::string caption = {};  ///< sentences that explain it, on the page
  std::vector<Column> columns = {};
  std::vector<std::vector<Datum>> rows = {};  ///< each row as long as `columns`
  bool detail = false;
  std::string file = {};  ///< name of its CSV; "": tables/<keys>.csv
};

/// The answer: the main conclusion for the reader.
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
  std::string sort = {};  ///< "warning", written before each line; "": nothing
  std::vector<std::string> lines = {};
};
/// Text whose line breaks and blanks are kept.
struct Preformatted {
  std::string title = {};
  std::string text = {};
};

/// A finished drawing, for the page.
struct Picture {
  std::string title = {};
  std::string svg = {};  ///< an <svg> element with a viewBox, as draw_machine() makes it
};

using Block = std::variant<Value, Table, Verdict, Text, Notes, Preformatted, Plot, Bars, Picture>;

/// Marks a section as one of several of the same kind, such as the results of one cyclogram. In JSON the section is an
/// element of the list of its key; in CSV the item's name is the first cell of each row, under the item's key.
struct Item {
  std::string key = {};   ///< "cyclogram"
  std::string name = {};  ///< "warm_up"
};

struct Section {
  std::string key = {};    ///< "": its content belongs to the section around it
  std::string title = {};  ///< "": no heading
  std::optional<Item> item = {};
  std::vector<Block> blocks = {};
  std::vector<Section> sections = {};  ///< after the blocks
  bool detail = false;                 ///< the whole section: off the terminal, folded on the page if it has a title
};

struct Document {
  Provenance made_by = {};
  std::string title = {};
  std::string subtitle = {};  ///< what to know before all numbers; may be empty
  Section body = {};
};

/// What the reader should do: sentences under the heading "What to do next". No sentences: an empty section.
[[nodiscard]] Section next_section(const std::vector<std::string>& sentences);

/// A short way to add a block to a section: `add(s, Value{...})`.
inline void add(Section& section, Block block) {
  section.blocks.push_back(std::move(block));
}

/// A datum as shown to people: "12.3", "yes", "a, b"; "-" for nothing.
[[nodiscard]] std::string shown(const Datum& datum, const Digits& digits);
/// A datum as written to CSV: seven significant digits; "" for nothing.
[[nodiscard]] std::string written(const Datum& datum);
/// A unit as shown to people: µm for um, °C for degC.
[[nodiscard]] std::string shown_unit(const std::string& unit);
/// A column's title with its unit: "peak [µm]".
[[nodiscard]] std::string heading_of(const Column& column);

}  // namespace driftwright::output
