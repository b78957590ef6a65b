#include <fmt/format.h>

#include <filesystem>

#include "app/results.hpp"
#include "base/delimited_text.hpp"
#include "base/file_name.hpp"
#include "findings/import_document.hpp"

namespace driftwright::app {

void import_file(const ImportOptions& options) {
  const studies::LoggerImport import =
      studies::import_logger(options.scenario, options.by,
                             {options.zone, options.interval, options.every, studies::units_of_columns(options.units)});
  const std::string stem = clean_name(std::filesystem::path(options.scenario).stem().string());
  output::ResultsFolder folder = open_results(options, file_name(stem, ""));
  Progress progress(options.quiet);
  // Named after the logger's file, so that several imports can be distinguished by their file names.
  folder.write_text(file_name(stem, ".csv"), record_csv(import.read.record, provenance_lines(folder.made_by(), "import")));
  folder.write_text(
      "columns.yaml",
      fmt::format(
          "# How {} was read; the same key in a scenario makes every verb read such files (docs/reference/record.md).\n{}",
          stem, yaml_text(import.map)));
  finish(findings::document_of(import, folder.made_by()), folder, progress, options);
}

}  // namespace driftwright::app
