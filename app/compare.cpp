#include <fmt/format.h>

#include <filesystem>

#include "app/results.hpp"
#include "findings/comparison_document.hpp"

namespace driftwright::app {
namespace {

/// A record CSV, or the record of a folder of results.
Record read(const std::string& path) {
  const std::filesystem::path folder = path;
  if (!std::filesystem::is_directory(folder)) return read_record_csv(path);
  if (!std::filesystem::exists(folder / "record.csv"))
    throw InputError(fmt::format("{}: the folder holds no record.csv; name a record of it, such as {}", path,
                                 (folder / "records/NAME.csv").string()));
  Record record = read_record_csv((folder / "record.csv").string());
  record.source = path;
  return record;
}

}  // namespace

void compare(const CompareOptions& options) {
  const studies::RecordComparison comparison = studies::compare_records(read(options.first), read(options.second));
  CommonOptions common = options;
  common.scenario = options.first;
  output::ResultsFolder folder = open_results(common, "comparison");
  Progress progress(options.quiet);
  finish(findings::document_of(comparison, folder.made_by()), folder, progress, common);
}

}  // namespace driftwright::app
