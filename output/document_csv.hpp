#pragma once
// A document for spreadsheets and data frames: each table a CSV, all single values one more.

#include <string>
#include <vector>

#include "output/document.hpp"

namespace driftwright::output {

struct CsvFile {
  std::string path = {};  ///< within the folder of results
  std::string text = {};
};

/// Headers are the keys, as in JSON; numbers have seven significant digits. Tables of one key in sections of items are one file, with the items'
/// names in front. `tables/values.csv` holds the values: key, value, unit, words. All begin with a comment that says who made them.
/// @throws std::logic_error  where tables of one file have other columns
[[nodiscard]] std::vector<CsvFile> document_csv(const Document& document);

/// One table as such a file, for those too long for a document.
[[nodiscard]] std::string table_csv(const Table& table, const Provenance& made_by);

}  // namespace driftwright::output
