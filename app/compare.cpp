#include <fmt/format.h>

#include <filesystem>

#include "app/results.hpp"
#include "findings/comparison_document.hpp"

namespace driftwright::app {
namespace {

bool is_scenario(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending == ".yaml" || ending == ".yml";
}

/// The user gave scenarios, which have no results yet: names the commands that make them.
[[noreturn]] void say_what_to_run(const CompareOptions& options) {
  std::string commands, names;
  for (const std::string& path : {options.first, options.second}) {
    std::string of_results = path;
    if (is_scenario(path)) {
      const scenarios::Scenario scenario = scenarios::read_scenario(path);
      of_results = fmt::format("results/{}", std::filesystem::path(path).stem().string());
      commands += fmt::format("\n  driftwright simulate {} --cyclogram {} -o {}", path,
                              scenario.cyclograms.empty() ? "NAME" : scenario.cyclograms.front().name, of_results);
    }
    names += " " + of_results;
  }
  throw InputError(
      fmt::format("`compare` sets results beside each other, and {} is a scenario. Run{}\n  driftwright compare{}",
                  is_scenario(options.first) ? options.first : options.second, commands, names));
}

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

/// The band beside the record of a folder of results; none for a folder without one, and for a record CSV.
std::optional<RecordBand> read_band(const std::string& path) {
  const std::filesystem::path file = std::filesystem::path(path) / "record_band.csv";
  if (!std::filesystem::exists(file)) return std::nullopt;
  return RecordBand{
      .limits = read_record_csv(file.string()),
      .words = fmt::format("The band of {} is what is known of its scenario: of its numbers (`known_to`) and of what was "
                           "learned beside them (`misses`). It does not contain what the model itself lacks.",
                           path)};
}

}  // namespace

void compare(const CompareOptions& options) {
  if (is_scenario(options.first) || is_scenario(options.second)) say_what_to_run(options);
  const studies::RecordComparison comparison = studies::compare_records(read(options.first), read(options.second),
                                                                        read_band(options.first), read_band(options.second));
  CommonOptions common = options;
  common.scenario = options.first;
  output::ResultsFolder folder = open_results(common, "comparison");
  Progress progress(options.quiet);
  finish(findings::document_of(comparison, folder.made_by()), folder, progress, common);
}

}  // namespace driftwright::app
