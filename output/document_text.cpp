#include "output/document_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "base/characters.hpp"

namespace driftwright::output {
namespace {

std::string padded(const std::string& text, std::size_t width, bool to_the_right) {
  const std::string blanks(width - std::min(width, n_characters(text)), ' ');
  return to_the_right ? blanks + text : text + blanks;
}

/// The words of a heading in lines of at most that width, unless a word is longer.
std::vector<std::string> lines_of(const std::string& heading, std::size_t width) {
  std::vector<std::string> lines;
  std::istringstream words(heading);
  for (std::string word; words >> word;) {
    if (!lines.empty() && n_characters(lines.back()) + 1 + n_characters(word) <= width)
      lines.back() += " " + word;
    else
      lines.push_back(word);
  }
  return lines;
}

bool is_number(const Datum& datum) {
  return std::holds_alternative<double>(datum.held) || std::holds_alternative<std::int64_t>(datum.held);
}

/// A column as it is printed.
struct Printed {
  std::vector<std::string> heading, cells;
  std::size_t width = 0;
  bool to_the_right = false;
};

Printed printed(const Table& table, std::size_t c) {
  const Column& column = table.columns[c];
  Printed p;
  for (const std::vector<Datum>& row : table.rows) {
    const std::string cell = shown(row.at(c), column.digits);
    p.cells.push_back(column.key == "unit" ? shown_unit(cell) : cell);
    p.width = std::max(p.width, n_characters(p.cells.back()));
    p.to_the_right = p.to_the_right || is_number(row[c]);
  }
  constexpr std::size_t kLeast = 10;  // narrower columns would stack the words of their headings
  p.heading = lines_of(heading_of(column), std::max(p.width, kLeast));
  for (const std::string& line : p.heading) p.width = std::max(p.width, n_characters(line));
  return p;
}

class TextWriter {
 public:
  explicit TextWriter(const TextOptions& options) : options_(options) {}

  /// @returns  whether there was anything to show
  bool add_section(const Section& section, std::size_t indent) {
    if (hides(section.detail)) return false;
    const std::size_t before = text_.size();
    const bool has_title = !section.title.empty();
    if (has_title) text_ += std::string(indent, ' ') + section.title + "\n";
    indent_ = indent + (has_title ? 2 : 0);
    const std::size_t inner = indent_, heading_end = text_.size();
    std::vector<const Value*> values;
    for (const Block& block : section.blocks) {
      const auto* value = std::get_if<Value>(&block);
      if (value && (value->words.empty() || hides(value->detail))) continue;
      if (value) {
        values.push_back(value);
        continue;
      }
      flush(values);
      std::visit([&](const auto& b) { add(b); }, block);
    }
    flush(values);
    bool any = text_.size() > heading_end;
    for (const Section& part : section.sections) {
      any = add_section(part, inner) || any;
      indent_ = inner;
    }
    if (!any) text_.resize(before);
    return any;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  [[nodiscard]] bool hides(bool detail) const { return detail && !options_.details; }
  void line(const std::string& words) { text_ += std::string(indent_, ' ') + words + "\n"; }

  void flush(std::vector<const Value*>& values) {
    std::size_t width = 0;
    for (const Value* v : values) width = std::max(width, n_characters(v->words));
    for (const Value* v : values) {
      const std::string unit = v->unit.empty() && v->digits.kind == Digits::Kind::kPercent ? "%" : shown_unit(v->unit);
      line(padded(v->words, width, false) + "  " + shown(v->datum, v->digits) + (unit.empty() ? "" : " " + unit));
    }
    values.clear();
  }

  void add(const Table& table) {
    if (hides(table.detail) || table.rows.empty()) return;
    std::vector<Printed> columns;
    std::size_t n_heading = 0;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (table.columns[c].title.empty()) continue;
      columns.push_back(printed(table, c));
      n_heading = std::max(n_heading, columns.back().heading.size());
    }
    if (columns.empty()) return;
    if (!table.title.empty()) line(table.title);
    if (options_.details && !table.caption.empty()) line(table.caption);
    const auto row = [&](const auto& cell_of) {
      std::string cells;
      for (const Printed& p : columns) cells += (cells.empty() ? "" : "  ") + padded(cell_of(p), p.width, p.to_the_right);
      cells.erase(cells.find_last_not_of(' ') + 1);
      line((table.title.empty() ? "" : "  ") + cells);
    };
    for (std::size_t k = 0; k < n_heading; ++k) {  // headings end on the same line
      row([&](const Printed& p) {
        const std::size_t above = n_heading - p.heading.size();
        return k < above ? std::string() : p.heading[k - above];
      });
    }
    constexpr std::size_t kMostRows = 30;
    const std::size_t n_shown = options_.details ? table.rows.size() : std::min(kMostRows, table.rows.size());
    for (std::size_t r = 0; r < n_shown; ++r) row([&](const Printed& p) { return p.cells[r]; });
    if (n_shown < table.rows.size()) line(fmt::format("  and {} more; --details shows all", table.rows.size() - n_shown));
  }
  void add(const Verdict& verdict) { line(verdict.title + (verdict.text.empty() ? "" : ": " + verdict.text)); }
  void add(const Text& text) {
    if (!hides(text.detail)) line(text.words);
  }
  void add(const Notes& notes) {
    for (const std::string& words : notes.lines) line(notes.sort.empty() ? words : notes.sort + ": " + words);
  }
  void add(const Preformatted& text) {
    if (!options_.details) return;
    if (!text.title.empty()) line(text.title);
    text_ += text.text;
    if (!text.text.ends_with('\n')) text_ += '\n';
  }
  void add(const Value&) {}  // printed by flush()
  void add(const Plot&) {}   // pictures cannot be shown as text
  void add(const Bars&) {}
  void add(const Picture&) {}

  TextOptions options_;
  std::string text_;
  std::size_t indent_ = 0;
};

}  // namespace

std::string section_text(const Section& section, const TextOptions& options) {
  TextWriter writer(options);
  writer.add_section(section, 2);
  return writer.text();
}

std::string document_text(const Document& document, const TextOptions& options) {
  return document.title + "\n" + (document.subtitle.empty() ? "" : "  " + document.subtitle + "\n") +
         section_text(document.body, options);
}

}  // namespace driftwright::output
