#include "app/results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/delimited_text.hpp"
#include "base/quantity.hpp"
#include "base/version.hpp"
#include "findings/plausibility.hpp"
#include "machine/as_recorded.hpp"
#include "machine/heat_flow_record.hpp"
#include "output/document_csv.hpp"
#include "output/document_html.hpp"
#include "output/document_json.hpp"
#include "output/document_text.hpp"
#include "output/json_text.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/unusual.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/stress.hpp"

namespace driftwright::app {

namespace {

void refuse_unusual(const std::string& path, const std::vector<std::string>& warnings) {
  if (warnings.empty()) return;
  throw InputError(
      fmt::format("{}: --strict refuses implausible values\n  {}", clean_name(path), fmt::join(warnings, "\n  ")));
}

}  // namespace

scenarios::Scenario read_scenario(const CommonOptions& options, Told told) {
  scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  const std::vector<std::string> unusual = scenarios::unusual_numbers(scenario);
  if (options.strict) refuse_unusual(options.scenario, unusual);
  if (told == Told::kAtOnce && !options.quiet) {
    for (const std::string& sentence : unusual) fmt::print(stderr, "warning: {}\n", sentence);
  }
  return scenario;
}

void refuse_implausible(const std::string& scenario_path, const output::Document& document) {
  refuse_unusual(scenario_path, findings::implausible(document));
}

output::ResultsFolder open_results(const CommonOptions& options, const std::string& scenario_name) {
  const std::string target = options.out.empty() ? "results/" + scenario_name : options.out;
  std::string shown = clean_name(target);
  while (shown.size() > 1 && shown.ends_with('/')) shown.pop_back();
  return {target, options.force, output::Provenance{kVersion, clean_name(options.scenario), shown}};
}

std::filesystem::path checked_results(const CommonOptions& options, const std::string& scenario_name) {
  return output::check_results_folder(options.out.empty() ? "results/" + scenario_name : options.out, options.force);
}

namespace {

/// "fields.pvd, record.csv, report.html, tables/": files, then folders.
std::string contents(const output::ResultsFolder& folder) {
  std::vector<std::string> files;
  std::set<std::string> folders;
  for (const std::string& file : folder.files()) {
    const std::size_t slash = file.find('/');
    if (slash != std::string::npos)
      folders.insert(file.substr(0, slash + 1));
    else if (file != output::kManifestName)
      files.push_back(file);
  }
  files.insert(files.end(), folders.begin(), folders.end());
  return fmt::format("{}", fmt::join(files, ", "));
}

}  // namespace

void show(const output::Document& document, const CommonOptions& options) {
  if (options.quiet) return;
  fmt::print("{}", options.json ? output::json_text(output::document_json(document))
                                : utf8_text(output::document_text(document, {.details = options.details})));
}

void finish(const output::Document& document, output::ResultsFolder& folder, Progress& progress,
            const CommonOptions& options, const std::string& also, const std::string& json_file) {
  if (options.strict) refuse_implausible(options.scenario, document);
  progress.begin("writing");
  const std::string json = output::json_text(output::document_json(document));
  folder.write_text("summary.json", json);  // the same name for every verb
  if (json_file != "summary.json") folder.write_text(json_file, json);
  for (const output::CsvFile& csv : output::document_csv(document)) folder.write_text(csv.path, csv.text);
  const output::html::Rendered rendered = output::document_html(document);
  folder.write_text("report.html", utf8_text(rendered.page));
  for (const output::html::Figure& figure : rendered.figures)
    folder.write_text("figures/" + figure.name + ".svg", utf8_text(figure.svg));
  folder.commit();
  progress.end();
  show(document, options);
  if (!options.quiet && !options.json)
    fmt::print("{}results in {}: {}\n", also, shown_path(folder.target()), contents(folder));
}

void write_whole(const std::filesystem::path& target, const std::function<void(const std::filesystem::path&)>& write) {
  const std::filesystem::path partial = target.string() + fmt::format(".partial-{}", getpid());
  try {
    write(partial);
    std::filesystem::rename(partial, target);
  } catch (const std::exception& e) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw InputError(fmt::format("-o '{}' cannot be written: {}", target.string(), e.what()));
  }
}

std::vector<std::string> provenance_lines(const output::Provenance& made_by, const std::string& what) {
  return {fmt::format("{}; Driftwright {}, scenario {}", clean_name(what), made_by.version, made_by.scenario)};
}

std::string heat_flows_csv(const solver::Trajectory& run, const std::string& cyclogram, const output::Provenance& made_by) {
  return record_csv(scenarios::heat_flow_record(run, cyclogram),
                    provenance_lines(made_by,
                                     "mean heat flow since the row before; > 0 into the machine, within_...: > 0 out of "
                                     "the body; cyclogram " +
                                         cyclogram));
}

std::string band_csv(const RecordBand& band, const output::Provenance& made_by) {
  return record_csv(band.limits, provenance_lines(made_by, band.words));
}

std::string shown_path(const std::filesystem::path& path) {
  const std::string relative = std::filesystem::relative(path).string();
  return clean_name(relative.starts_with("..") ? path.string() : relative);
}

std::string fields_note(const output::FieldSeries& fields) {
  constexpr std::size_t kManyTimes = 100;
  if (fields.format() != FieldsFormat::kVtu || fields.n_times() <= kManyTimes) return "";
  return fmt::format(
      "note: fields at {} times, each file with the mesh; `solver: {{fields_format: xdmf}}` would hold the mesh once\n",
      fields.n_times());
}

scenarios::FieldSink sink_of(output::FieldSeries* fields, findings::WorstMoment& worst) {
  if (!fields) return {};
  return {.cyclogram = 0, .take = [fields, &worst](const scenarios::WholeFields& whole) {
            worst.take(whole);
            fields->write(whole.time_s, whole.temperature_degC, whole.displacement_um,
                          whole.stress ? &*whole.stress : nullptr);
          }};
}

}  // namespace driftwright::app
