#include "output/document_csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "base/csv_row.hpp"
#include "base/delimited_text.hpp"
#include "base/file_name.hpp"

namespace driftwright::output {
namespace {

std::string line_of(const std::vector<std::string>& cells) {
  std::vector<std::string> quoted;
  for (const std::string& cell : cells) quoted.push_back(csv_cell(cell));
  return fmt::format("{}\n", fmt::join(quoted, ","));
}

/// The position of a table or value in the document.
struct Place {
  std::string keys;         ///< "cyclograms_iso_230_3"
  std::vector<Item> items;  ///< outermost first
};

struct Sheet {
  std::string path, header, rows;
};

class Sheets {
 public:
  void add_section(const Section& section, const Place& at) {
    for (const Block& block : section.blocks) {
      if (const auto* table = std::get_if<Table>(&block)) add_table(*table, at);
      if (const auto* value = std::get_if<Value>(&block)) add_value(*value, at);
    }
    for (const Section& part : section.sections) {
      Place inner = at;
      if (!part.key.empty()) inner.keys += (inner.keys.empty() ? "" : "_") + part.key;
      if (part.item) inner.items.push_back(*part.item);
      add_section(part, inner);
    }
  }
  [[nodiscard]] const std::vector<Sheet>& all() const { return sheets_; }

 private:
  Sheet& sheet(const std::string& path, const std::string& header) {
    auto found = std::find_if(sheets_.begin(), sheets_.end(), [&](const Sheet& s) { return s.path == path; });
    if (found == sheets_.end()) return sheets_.emplace_back(Sheet{path, header, ""});
    if (found->header != header) throw std::logic_error(fmt::format("tables of {} with other columns", path));
    return *found;
  }

  void add_table(const Table& table, const Place& at) {
    if (table.key.empty()) return;
    std::vector<std::string> headers, items;
    for (const Item& item : at.items) {
      const bool is_new = std::find(headers.begin(), headers.end(), item.key) == headers.end();
      headers.push_back(is_new ? item.key : "inner_" + item.key);
      items.push_back(item.name);
    }
    for (const Column& column : table.columns) {
      if (!column.key.empty()) headers.push_back(column.key);
    }
    const std::string name = at.keys + (at.keys.empty() ? "" : "_") + table.key;
    Sheet& s = sheet(table.file.empty() ? "tables/" + file_name(name, ".csv") : table.file, line_of(headers));
    for (const std::vector<Datum>& row : table.rows) {
      std::vector<std::string> cells = items;
      for (std::size_t c = 0; c < row.size(); ++c) {
        if (!table.columns.at(c).key.empty()) cells.push_back(written(row[c]));
      }
      s.rows += line_of(cells);
    }
  }

  void add_value(const Value& value, const Place& at) {
    if (value.key.empty()) return;
    std::string of;
    for (const Item& item : at.items) of += (of.empty() ? "" : ", ") + item.name;
    const std::string key = at.keys + (at.keys.empty() ? "" : ".") + value.key;
    sheet("tables/values.csv", "of,key,value,unit,words\n").rows +=
        line_of({of, key, written(value.datum), value.unit, value.words});
  }

  std::vector<Sheet> sheets_;
};

}  // namespace

std::string table_csv(const Table& table, const Provenance& made_by) {
  return document_csv({.made_by = made_by, .title = table.title, .body = {.blocks = {table}}}).at(0).text;
}

std::vector<CsvFile> document_csv(const Document& document) {
  Sheets sheets;
  sheets.add_section(document.body, {});
  std::vector<CsvFile> files;
  for (const Sheet& s : sheets.all()) {
    files.push_back({s.path, utf8_text(fmt::format("# {}; Driftwright {}, scenario {}\n{}{}", clean_name(document.title),
                                                   document.made_by.version, document.made_by.scenario, s.header, s.rows))});
  }
  return files;
}

}  // namespace driftwright::output
