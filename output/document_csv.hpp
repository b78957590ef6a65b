#pragma once
// Renders a document for spreadsheets and data frames: one CSV for each table, and one for all single values.

#include <string>
#include <vector>

#include "output/document.hpp"

namespace driftwright::output {

struct CsvFile {
  std::string path = {};  ///< within the folder of results
  std::string text = {};
};

/// Headers are the keys, as in JSON; numbers have seven significant digits. Tables with the same key in sections of items
/// become one file, with the items' names in the first columns. `tables/values.csv` holds the values: key, value, unit,
/// words. All files begin with a comment that says what made them.
/// @throws std::logic_error  if tables of one file have different columns
[[nodiscard]] std::vector<CsvFile> document_csv(const Document& document);

/// One table as such a file, for tables that are too long for a document.
[[nodiscard]] std::string table_csv(const Table& table, const Provenance& made_by);

}  // namespace driftwright::output
