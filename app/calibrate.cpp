#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/diagnosis_files.hpp"
#include "app/diagnosis_json.hpp"
#include "app/diagnosis_report.hpp"
#include "app/diagnosis_summary.hpp"
#include "app/measured_iso230_3.hpp"
#include "app/results.hpp"
#include "output/json_text.hpp"

namespace driftwright::app {

void calibrate(const CalibrateOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  (void)scenarios::require_machine(scenario, "calibrate");
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  studies::MeasuredTwin m = studies::open_measured_twin(scenario, "calibrate", options.measured, progress.listener());
  m.how.most_effects = 0;
  const diagnosis::Diagnosis d =
      diagnosis::diagnose(*m.twin, m.on_other_mesh ? &*m.on_other_mesh : nullptr, m.runs, m.how, progress.listener());
  progress.begin("writing");
  const std::string warning = calibration_warning(d, d.search.candidates);
  std::vector<std::string> head = {
      fmt::format("{} with its numbers as `driftwright calibrate` fitted them", options.scenario)};
  for (const std::string& path : options.measured) head.push_back("  measured: " + path);
  if (!warning.empty()) head.push_back("WARNING: " + warning);
  head.emplace_back("");
  std::string difference;
  const diagnosis::ExtendedScenario calibrated =
      write_scenario("calibrated", m, stated_scatter(d, false), head, folder, &difference);
  nlohmann::ordered_json json = diagnosis_json(d);
  json["iso_230_3"] = iso230_3_json(measured_iso230_3(m));
  json["warning"] = warning;
  json["calibrated_scenario"] = {{"written", calibrated.written}, {"not_written", calibrated.not_written}};
  folder.write_text("calibration.json", output::json_text(json));
  const DiagnosisPage page{m, d, d.search.candidates, calibrated, difference, "calibrated.yaml"};
  folder.write_text("report.html", output::render_html(calibration_report(page, folder.made_by())));
  folder.commit();
  progress.end();
  fmt::print("{}\n", numbers_text(d));
  if (!warning.empty()) fmt::print("warning: {}\n", warning);
  fmt::print("{}{}results in {}: report.html, calibration.json, calibrated.yaml, calibrated.diff\n",
             studies::one_mesh_text(m), not_written_text("calibrated.yaml", calibrated), shown_path(folder.target()));
}

}  // namespace driftwright::app
