#include "studies/logger_import.hpp"

#include <fmt/format.h>

#include "base/config_map.hpp"
#include "scenarios/reader/read_columns.hpp"

namespace driftwright::studies {
namespace {

const schema::Map& holder_of_columns() {
  using namespace schema;
  static const schema::Map description = {
      .name = "columns alone",
      .keys = {compulsory("columns", schema::map(scenarios::columns_schema()), "how a logger writes its files")},
      .others = {schema::optional("key", anything(), "of the whole scenario")}};
  return description;
}

}  // namespace

std::map<std::string, std::string> units_of_columns(const std::vector<std::string>& said) {
  std::map<std::string, std::string> units;
  for (const std::string& text : said) {
    const std::size_t at = text.rfind('=');
    if (at == std::string::npos || at == 0 || at + 1 == text.size())
      throw InputError("--unit " + text +
                       ": a column and its unit are required, such as t1=degC; t1=none leaves the column out");
    const std::string column = text.substr(0, at), unit = text.substr(at + 1);
    if (!units.emplace(column, unit).second)
      throw InputError(fmt::format("--unit {}: '{}' has the unit {} already; one is allowed", text, column, units[column]));
  }
  return units;
}

LoggerImport import_logger(const std::string& path, const std::string& by, const GuessHints& hints) {
  LoggerImport import;
  if (by.empty()) {
    GuessedColumns guessed = guess_columns(path, hints);
    import.map = std::move(guessed.map);
    import.guesses = std::move(guessed.guesses);
    import.without_unit = std::move(guessed.without_unit);
  } else {
    import.read_by = by;
    import.map = scenarios::read_columns(ConfigMap::read_file(by).described_by(holder_of_columns()).map("columns"));
  }
  import.read = read_record(path, import.map);
  return import;
}

}  // namespace driftwright::studies
