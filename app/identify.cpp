#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>

#include "app/identify_beside.hpp"
#include "app/results.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/file_name.hpp"
#include "findings/identification_document.hpp"
#include "identification/network_scenario.hpp"
#include "machine/machine.hpp"
#include "scenarios/reader/scenario.hpp"
#include "studies/logger_import.hpp"

namespace driftwright::app {
namespace {

/// Reads a record CSV, or any logger's file with guessed columns.
/// @param units  of columns of a logger's file  @param n_loggers  counts such files
/// @throws InputError  if a column of such a file has no unit
Record read(const std::string& path, const std::map<std::string, std::string>& units, std::size_t& n_loggers,
            std::vector<std::string>& notes) {
  try {
    return read_record_csv(path);
  } catch (const InputError& no_record) {
    studies::LoggerImport import;
    try {
      import = studies::import_logger(path, "", {.zone = "", .interval = "", .every = "", .units = units});
    } catch (const InputError&) {
      if (!units.empty()) throw;
      throw no_record;
    }
    ++n_loggers;
    if (!import.without_unit.empty())
      throw InputError(
          fmt::format("{}: nothing says the unit of '{}'. Write --unit '{}=degC' for a thermometer, =um for a "
                      "displacement, =1 for a plain number that drives the machine, =none to leave it out",
                      clean_name(path), fmt::join(import.without_unit, "', '"), import.without_unit.front()));
    for (const std::string& guess : import.guesses) notes.push_back(clean_name(path) + ": " + guess);
    for (const std::string& note : import.read.notes) notes.push_back(clean_name(path) + ": " + note);
    return import.read.record;
  }
}

/// A file's stem as the name of a scenario and of a cyclogram: letters, digits, '_' and '-'.
std::string plain_stem(const std::string& path) {
  std::string stem = file_name(clean_name(std::filesystem::path(path).stem().string()), "");
  std::replace_if(
      stem.begin(), stem.end(), [](unsigned char c) { return !std::isalnum(c) && c != '_' && c != '-'; }, '_');
  return stem;
}

}  // namespace

void identify(const IdentifyOptions& asked) {
  if (!asked.prior.empty()) return identify_beside(asked);
  IdentifyOptions options = asked;
  options.scenario = asked.records.front();  // the results are named after the first record
  std::vector<Record> records;
  std::vector<std::string> notes, files;
  std::set<std::string> stems;
  const std::map<std::string, std::string> units = studies::units_of_columns(options.units);
  std::size_t n_loggers = 0;
  for (const std::string& path : options.records) {
    records.push_back(read(path, units, n_loggers, notes));
    records.back().source = clean_name(std::filesystem::path(path).filename().string());
    const std::string stem = plain_stem(path);
    if (!stems.insert(stem).second)
      throw InputError(
          fmt::format("--record {}: two records are called {}; runs go by the names of their files", path, stem));
    files.push_back(file_name(stem, ".csv"));
  }
  if (!units.empty() && n_loggers == 0)
    throw InputError(fmt::format("--unit {}: all records say the units of their columns", units.begin()->first));
  const std::string name = std::filesystem::path(files.front()).stem().string();
  output::ResultsFolder folder = open_results(options, name);
  Progress progress(options.quiet);
  const identification::Identified network =
      identification::identify(records, {options.ambient, options.drives}, progress.listener());
  progress.begin("writing");
  std::vector<std::string> head = {
      fmt::format("{}: a network from records alone, by `driftwright identify` (docs/how-to/identification.md)", name)};
  for (const std::string& path : options.records) head.push_back("  record: " + clean_name(path));
  head.emplace_back(
      "Bodies lie side by side; their names say what warms them, not what they are. Rename them, or put in what you know.");
  head.emplace_back("");
  for (std::size_t i = 0; i < records.size(); ++i)
    folder.write_text(files[i], record_csv(identification::run_record(records[i], network.roles),
                                           provenance_lines(folder.made_by(), "identify")));
  folder.write_text(file_name(name, ".yaml"), identification::network_scenario(network, name, files, head));
  const std::filesystem::path written = folder.path(file_name(name, ".yaml"));
  try {
    const scenarios::Scenario scenario = scenarios::read_scenario(written.string());
    (void)scenarios::build(*scenario.machine, scenarios::place(*scenario.machine));
  } catch (const InputError& e) {
    throw InputError(
        fmt::format("{}: the network could not be written as a scenario that runs: {}", options.records.front(), e.what()));
  }
  finish(findings::document_of({name, records, network, notes}, folder.made_by()), folder, progress, options);
}

}  // namespace driftwright::app
